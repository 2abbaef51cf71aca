// SPDX-License-Identifier: Apache-2.0
// A choice of versions in the side bar, of those that lie beside this one (docs/site/versions.py writes their list).
(() => {
  const root = document.documentElement.dataset.content_root ?? "./", list = document.createElement("script");
  list.src = `${root}../versions.js`;
  list.onload = () => {
    const base = new URL(root, location.href), here = decodeURIComponent(base.pathname.split("/").at(-2));
    const select = document.createElement("select"), label = document.createElement("label");
    for (const name of window.polhodeVersions) select.add(new Option(name, name, name === here, name === here));
    // The page of the same name may not be in another version: its first page is.
    select.onchange = () => { location.href = new URL(`../${encodeURIComponent(select.value)}/index.html`, base).href; };
    label.className = "versions";
    label.append("Version ", select);
    document.querySelector(".sidebar-brand")?.after(label);
  };
  document.head.append(list);
})();
