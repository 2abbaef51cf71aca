# SPDX-License-Identifier: Apache-2.0
"""The text of all pages of the built site by section, as a script that the page of the search loads: browsers do not
let a page on a disk fetch others, so that the excerpts of a search come from here.

    search_text.py FOLDER    FOLDER holds the built site; writes FOLDER/search_text.js
"""

import html.parser
import json
import pathlib
import re
import sys

# Pages that have no text of their own.
LEFT_OUT = {"genindex.html", "py-modindex.html", "search.html"}
FOLDERS_LEFT_OUT = {"code", "live", "_static", "_sources", "_images"}
VOID = {"img", "br", "hr", "input", "meta", "link", "col"}
BLOCKS = {"p", "li", "tr", "dt", "dd", "pre", "div", "table", "ul", "ol", "dl", "blockquote"}
# Formulas, signs of headings and frames are not read.
SKIPPED_TAGS = {"math", "script", "style", "iframe"}
SKIPPED_CLASSES = {"headerlink", "toctree-wrapper"}
HEADING = re.compile(r"h[1-6]$")
NAMED_TAGS = {"section", "dt"}


class Sections(html.parser.HTMLParser):
    """[place, heading, text] of each section of the article of a page, in order; the first heading is the page's title.
    A definition of an interface, which has a place of its own, is a section too."""

    def __init__(self, path):
        super().__init__()
        self.sections, self.places, self.skipped, self.inside, self.heading = [], [], 0, False, None
        self.feed(path.read_text(errors="replace"))
        self.close()
        for section in self.sections:
            section[1:] = [re.sub(r"\s+", " ", "".join(part)).strip() for part in section[1:]]

    def handle_starttag(self, tag, attrs):
        values = {k: v or "" for k, v in attrs}
        if tag == "article":
            self.inside = True
        if not self.inside or tag in VOID:
            if self.inside and tag == "br":
                self.add(" ")
            return
        if self.skipped or tag in SKIPPED_TAGS or SKIPPED_CLASSES & set(values.get("class", "").split()):
            self.skipped += 1
            return
        if tag == "section":
            self.places.append(values.get("id", ""))
        elif HEADING.match(tag) or (tag == "dt" and "id" in values):
            place = values["id"] if tag == "dt" else self.places[-1] if self.places else ""
            self.sections.append([place, [], []])
            self.heading = tag
        elif tag in BLOCKS:
            self.add(" ")

    def handle_endtag(self, tag):
        if tag == "article":
            self.inside = False
        if not self.inside or tag in VOID:
            return
        if self.skipped:
            self.skipped -= 1
        elif tag == "section" and self.places:
            self.places.pop()
        elif tag == self.heading:
            self.heading = None
        elif tag in ("td", "th"):
            self.add(" · ")
        elif tag in BLOCKS:
            self.add(" ")

    def handle_data(self, data):
        self.add(data)

    def add(self, text):
        if self.inside and not self.skipped and self.sections:
            self.sections[-1][1 if self.heading else 2].append(text)


def pages(folder):
    """[page, title, sections] of each page of the site."""
    found = []
    for path in sorted(folder.rglob("*.html")):
        name = path.relative_to(folder)
        if name.parts[0] in FOLDERS_LEFT_OUT or str(name) in LEFT_OUT:
            continue
        sections = Sections(path).sections
        if sections:
            for section in sections:
                section[2] = re.sub(r"(?:· )+(?=· )|(?: ·)+$", "", section[2]).strip(" ·")
            found.append([name.as_posix(), sections[0][1], sections])
    return found


def write(folder):
    found = pages(folder)
    text = json.dumps(found, ensure_ascii=False, separators=(",", ":"))
    (folder / "search_text.js").write_text(f"window.polhodeText = {text};\n")
    return found


if __name__ == "__main__":
    written = write(pathlib.Path(sys.argv[1]))
    print(f"{len(written)} pages, {sum(len(sections) for _, _, sections in written)} sections for the search")
