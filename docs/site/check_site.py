# SPDX-License-Identifier: Apache-2.0
"""Every link of the built site leads to a page and a place in it, nothing is fetched from a network, and the text that the
search reads has every page, with places that exist."""

import html.parser
import json
import pathlib
import sys
import urllib.parse


class Page(html.parser.HTMLParser):
    def __init__(self, path):
        super().__init__()
        self.links, self.places, self.fetched = [], set(), []
        self.feed(path.read_text(errors="replace"))

    def handle_starttag(self, tag, attrs):
        values = dict(attrs)
        self.places.update(v for k, v in attrs if k in ("id", "name") and v)
        for key in ("href", "src"):
            if key in values and values[key] is not None:
                external = urllib.parse.urlsplit(values[key]).netloc
                if external and tag in ("script", "img", "iframe", "link", "source"):
                    self.fetched.append(values[key])
                elif not external:
                    self.links.append(values[key])


def check_search(folder, pages):
    """Faults of search_text.js: pages that it lacks, pages and sections that do not exist or have no text."""
    text = (folder / "search_text.js").read_text()
    held = {folder / page: sections for page, _, sections in json.loads(text[text.index("["):text.rindex("]") + 1])}
    wanted = {p for p in pages if p.parent == folder or p.relative_to(folder).parts[0] != "code"} - {folder / f"{n}.html" for n in ("search", "genindex", "py-modindex")}
    faults = [f"search_text.js lacks {p.relative_to(folder)}" for p in sorted(wanted - held.keys())]
    for path, sections in held.items():
        if path not in pages:
            faults.append(f"search_text.js: {path.relative_to(folder)} does not exist")
            continue
        faults += [f"search_text.js: {path.relative_to(folder)} has no place {place}" for place, _, _ in sections if place and place not in pages[path].places]
        if not any(text for _, _, text in sections):
            faults.append(f"search_text.js: {path.relative_to(folder)} has no text")
    return faults


def main(folder):
    folder = pathlib.Path(folder).resolve()
    # Pages of runs hold megabytes of numbers and no links.
    pages = {p: Page(p) for p in sorted(folder.rglob("*.html")) if p.parent != folder / "live"}
    faults, count = [], 0
    for path, page in pages.items():
        faults += [f"{path.relative_to(folder)}: fetches {a}" for a in page.fetched]
        for link in page.links:
            parts = urllib.parse.urlsplit(link)
            if parts.scheme or link == "#":
                continue
            count += 1
            to = (path.parent / urllib.parse.unquote(parts.path)).resolve() if parts.path else path
            if not to.exists():
                faults.append(f"{path.relative_to(folder)}: {link} does not exist")
            elif parts.fragment and to in pages and urllib.parse.unquote(parts.fragment) not in pages[to].places:
                faults.append(f"{path.relative_to(folder)}: {link} leads to no place of that page")
    faults += check_search(folder, pages)
    print("\n".join(faults[:50]) if faults else f"{len(pages)} pages, {count} links, all lead somewhere.")
    return bool(faults)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
