// SPDX-License-Identifier: Apache-2.0
// Full-text search in search_text.js: pages ranked by their best section, each with excerpts. It needs no network, and no server.
(() => {
  const stemmer = new window.Stemmer(), stems = new Map();
  const stem = (word) => {
    if (!stems.has(word)) stems.set(word, stemmer.stemWord(word));
    return stems.get(word);
  };
  // A name such as rotary_motor counts as a whole and by its parts. [stem, start, end] of each.
  const words = (text) => {
    const found = [];
    for (const match of text.toLowerCase().matchAll(/[\p{L}\p{N}_]+/gu)) {
      found.push([stem(match[0]), match.index, match.index + match[0].length]);
      if (match[0].includes("_"))
        for (const part of match[0].matchAll(/[^_]+/g)) found.push([stem(part[0]), match.index + part.index, match.index + part.index + part[0].length]);
    }
    return found;
  };
  // Pages for users come before those about the code.
  const weight = (page) => {
    for (const [start, value] of [["reference/model_file", 0.8], ["reference/numerics", 0.5], ["reference/", 1], ["how_to/add", 0.5], ["how_to/read", 0.5], ["how_to/", 1], ["quick_start/", 1], ["python/", 1],
      ["api/python", 0.6], ["api/", 0.35], ["theory/index", 0.3], ["theory/", 0.7], ["decisions/", 0.4], ["examples/", 0.7], ["tutorials/", 0.7], ["validation", 0.6], ["benchmarks", 0.6], ["architecture", 0.4], ["contributing", 0.4], ["changelog", 0.4]])
      if (page.startsWith(start)) return value;
    return 0.9;
  };

  // Numbers of sections by word, and counts of the word in heading and text of each.
  let sections, index, meanLength;
  const build = () => {
    sections = [], index = new Map();
    let length = 0;
    window.polhodeText.forEach(([page, title, parts], number) => parts.forEach(([place, heading, text]) => {
      const counts = new Map(), count = (word, where) => {
        const entry = counts.get(word) ?? [0, 0, 0];
        entry[where]++;
        counts.set(word, entry);
      };
      const body = words(text);
      for (const [word] of body) count(word, 0);
      for (const [word] of words(heading)) count(word, 1);
      for (const [word] of words(title)) count(word, 2);
      const at = sections.push({ number, page, title, place, heading, text, size: body.length }) - 1;
      length += body.length;
      for (const [word, entry] of counts) {
        if (!index.has(word)) index.set(word, []);
        index.get(word).push([at, entry]);
      }
    }));
    meanLength = length / sections.length;
  };

  // The query's words, without those that say nothing unless there are no others.
  const wanted = (query) => {
    const all = [...new Set((query.toLowerCase().match(/[\p{L}\p{N}_]+/gu) ?? []))], telling = all.filter((word) => !window.stopwords?.has(word));
    return (telling.length ? telling : all).map(stem);
  };

  /** Pages that hold the words, best first: {page, title, score, hits: [{place, heading, text}]}. All words, or as many as any page holds. */
  function search(query) {
    if (!index) build();
    const terms = wanted(query), scores = new Map(), held = new Map();
    terms.forEach((term, which) => {
      // A word that occurs nowhere stands for those that it begins.
      const known = index.has(term) ? [term] : term.length > 2 ? [...index.keys()].filter((word) => word.startsWith(term)) : [];
      const entries = new Map();
      for (const word of known)
        for (const [at, counts] of index.get(word)) entries.set(at, (entries.get(at) ?? [0, 0, 0]).map((value, i) => value + counts[i]));
      const rare = Math.log(1 + (sections.length - entries.size + 0.5) / (entries.size + 0.5));
      for (const [at, [inText, inHeading, inTitle]] of entries) {
        const section = sections[at], frequency = inText / (0.4 + 0.6 * section.size / meanLength) + 4 * inHeading + 2.5 * inTitle;
        scores.set(at, (scores.get(at) ?? 0) + rare * frequency * 2.2 / (frequency + 1.2));
        held.set(section.number, (held.get(section.number) ?? new Set()).add(which));
        section.terms = section.query === query ? section.terms.add(which) : new Set([which]);
        section.query = query;
      }
    });
    const most = Math.max(0, ...[...held.values()].map((set) => set.size)), pages = new Map();
    for (const [at, score] of scores) {
      const section = sections[at];
      if (held.get(section.number).size < most) continue;
      const phrase = terms.length > 1 && near(section, terms) ? 1.4 : 1;
      const named = new Set(words(`${section.title} ${section.heading}`).map(([word]) => word)), told = terms.filter((term) => named.has(term)).length / terms.length;
      const hit = { ...section, score: score * phrase * (1 + 0.8 * told ** 2) * (section.terms.size / most) ** 2 };
      const page = pages.get(section.number) ?? pages.set(section.number, { page: section.page, title: section.title, hits: [] }).get(section.number);
      page.hits.push(hit);
    }
    const found = [...pages.values()];
    for (const page of found) {
      page.hits.sort((a, b) => b.score - a.score);
      page.score = weight(page.page) * (page.hits[0].score + 0.1 * page.hits.slice(1, 4).reduce((sum, hit) => sum + hit.score, 0));
      page.hits = page.hits.filter((hit, i) => i === 0 || hit.score > 0.5 * page.hits[0].score).slice(0, 3);
    }
    return { terms, pages: found.sort((a, b) => b.score - a.score) };
  }

  /** Whether all words stand side by side somewhere, in any order, with the heading read as part of the text. */
  function near(section, terms) {
    const all = words(`${section.title} ${section.heading} ${section.text}`).map(([word]) => word);
    for (let i = 0; i + terms.length <= all.length; i++)
      if (terms.every((term) => all.slice(i, i + terms.length + 1).includes(term))) return true;
    return false;
  }

  const LENGTH = 220;
  /** Parts of a text around its words, [text, whether it is one of them], about LENGTH characters with the most different words. */
  function excerpt(text, terms) {
    const hits = words(text).filter(([word]) => terms.some((term) => word === term || (term.length > 2 && !index.has(term) && word.startsWith(term))));
    let from = 0, best = -1;
    for (const [, start] of hits) {
      const inside = hits.filter(([, s, e]) => s >= start && e <= start + LENGTH), value = 10 * new Set(inside.map(([word]) => word)).size + inside.length;
      if (value > best) [best, from] = [value, start];
    }
    // It begins with a sentence that is not far away, else with a word.
    const before = text.slice(Math.max(0, from - 90), from), sentence = before.search(/(?:^|[.:;·] )(?=[^.:;·]*$)/);
    let start = Math.max(0, from - 90) + (sentence < 0 ? before.indexOf(" ") + 1 : sentence + (/^[.:;·] /.test(before.slice(sentence)) ? 2 : 0));
    if (from === 0 || start > from) start = from;
    if (start <= 3) start = 0;
    let end = Math.min(text.length, start + LENGTH);
    if (end < text.length) end = Math.max(text.lastIndexOf(" ", end), start + 1);
    const parts = [[start > 0 ? "… " : "", false]];
    let at = start;
    for (const [, s, e] of hits) {
      if (s < at || e > end) continue;
      parts.push([text.slice(at, s), false], [text.slice(s, e), true]);
      at = e;
    }
    parts.push([text.slice(at, end) + (end < text.length ? " …" : ""), false]);
    return parts.filter(([part]) => part);
  }

  const SHOWN = 20;
  function show(query, output, status) {
    const { terms, pages } = search(query);
    const link = (page, place, text) => {
      const a = document.createElement("a");
      a.href = `${page}${place ? `#${place}` : ""}`;
      a.textContent = text;
      return a;
    };
    const item = ({ page, title, hits }) => {
      const li = document.createElement("li");
      li.append(link(page, "", title));
      const kind = document.createElement("span");
      kind.className = "where";
      kind.textContent = page.replace(/\.html$/, "").replace(/\/index$/, "");
      li.append(" ", kind);
      for (const hit of hits) {
        const p = document.createElement("p");
        if (hit.heading !== title) p.append(link(page, hit.place, hit.heading), ": ");
        for (const [text, marked] of excerpt(hit.text, terms)) {
          const part = marked ? document.createElement("mark") : document.createTextNode(text);
          if (marked) part.textContent = text;
          p.append(part);
        }
        li.append(p);
      }
      return li;
    };
    output.replaceChildren(...pages.slice(0, SHOWN).map(item));
    status.textContent = !terms.length ? "" : !pages.length ? `No page holds “${query}”.` : pages.length === 1 ? `One page holds “${query}”.` : `${pages.length} pages hold “${query}”.`;
    if (pages.length > SHOWN) {
      const more = document.createElement("button");
      more.textContent = `Show the other ${pages.length - SHOWN}`;
      more.onclick = () => {
        output.append(...pages.slice(SHOWN).map(item));
        more.remove();
      };
      status.append(" The best ", String(SHOWN), " are shown. ", more);
    }
  }

  const output = document.getElementById("search-results"), status = document.getElementById("search-status"), query = new URLSearchParams(location.search).get("q") ?? "";
  const fields = document.querySelectorAll('input[name="q"]');
  for (const field of fields) {
    field.value = query;
    let timer;
    field.addEventListener("input", () => {
      clearTimeout(timer);
      timer = setTimeout(() => show(field.value.trim(), output, status), 150);
    });
  }
  if (query.trim()) show(query.trim(), output, status);
  else status.textContent = "Type one or more words into the field above the menu.";
})();
