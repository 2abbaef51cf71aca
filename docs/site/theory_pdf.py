# SPDX-License-Identifier: Apache-2.0
"""The pages of the theory, out of the built site, as one PDF with contents, links and an outline.

    theory_pdf.py FOLDER OUT.pdf    FOLDER holds the built site, with the version and the order of the chapters in its menu; a
                                    Chromium without window prints it ($CHROMIUM, else the one that is installed). Ends with
                                    77 where there is none.
"""

import html
import html.parser
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unicodedata

STYLE = """
@page { size: A4; margin: 20mm 18mm; }
body { font: 10.5pt/1.45 serif; color: #000; }
h1, h2, h3 { font-family: sans-serif; line-height: 1.2; break-after: avoid; }
section.page { break-before: page; }
pre, code { font: 8.5pt/1.35 monospace; } pre { white-space: pre-wrap; border: 1px solid #ccc; padding: 2mm; }
table { border-collapse: collapse; font-size: 8.5pt; overflow-wrap: anywhere; } td, th { border: 1px solid #bbb; padding: 1mm 1.5mm; text-align: left; vertical-align: top; }
td p, th p { margin: 0; } tr { break-inside: avoid; } img { max-width: 100%; } a { color: #1f4f8f; text-decoration: none; } .headerlink { display: none; }
.formula { break-inside: avoid; }
"""


class Article(html.parser.HTMLParser):
    """What stands in the article of a page, with ids and links under the page's name."""

    VOID = {"img", "br", "hr", "input", "meta", "link", "col"}

    def __init__(self, name, folder, known):
        super().__init__(convert_charrefs=False)
        self.name, self.folder, self.known = name, folder, known
        self.parts, self.inside, self.skipped, self.title, self.heading = [], 0, 0, "", False

    def handle_starttag(self, tag, attrs):
        values = {k: v or "" for k, v in attrs}
        if tag == "article":
            self.inside = 1
            return
        if not self.inside:
            return
        if self.skipped or "headerlink" in values.get("class", ""):
            self.skipped += tag not in self.VOID
            return
        self.heading = self.heading or (tag == "h1" and not self.title)
        for key in ("id", "name"):
            if key in values:
                values[key] = f"{self.name}--{values[key]}"
        if tag == "a" and "href" in values:
            page, _, place = values["href"].partition("#")
            page = pathlib.PurePosixPath(page).name.removesuffix(".html") if page else self.name
            local = "/" not in values["href"].partition("#")[0] and page in self.known
            if local:
                values["href"] = f"#{page}--{place}" if place else f"#page-{page}"
            elif not re.match(r"[a-z]+:", values["href"]):
                del values["href"]  # pages of the site that are not in the book, and sources
        if "src" in values:
            values["src"] = (self.folder / values["src"]).resolve().as_uri()
        text = "".join(f' {k}="{v.replace("&", "&amp;").replace(chr(34), "&quot;")}"' for k, v in values.items())
        self.parts.append(f"<{tag}{text}>")

    def handle_endtag(self, tag):
        if tag == "article":
            self.inside = 0
        if self.inside and self.skipped:
            self.skipped -= 1
        elif self.inside:
            self.heading = self.heading and tag != "h1"
            self.parts.append(f"</{tag}>")

    def add(self, text):
        if self.inside and not self.skipped:
            self.parts.append(text)
            if self.heading:
                self.title += text

    def handle_data(self, data):
        self.add(data.replace("&", "&amp;").replace("<", "&lt;"))

    def handle_entityref(self, name):
        self.add(f"&{name};")

    def handle_charref(self, name):
        self.add(f"&#{name};")


def version_and_chapters(site):
    """What the first page of the site says: its version, and the pages of the theory in the order of the menu."""
    text = (site / "index.html").read_text()
    version = re.search(r"<title>Polhode ([^<]*)</title>", text)[1].removesuffix(" documentation")
    names = list(dict.fromkeys(re.findall(r'class="[^"]*reference internal"[^>]* href="theory/(\w+)\.html"', text)))
    lost = {p.stem for p in (site / "theory").glob("*.html")} ^ set(names)
    if lost:
        sys.exit(f"theory_pdf: {sorted(lost)} are not both in the menu and in the folder of the theory")
    return version, names


def book(site):
    """The whole as one page of HTML, its version, and the titles of its chapters."""
    folder = site / "theory"
    version, names = version_and_chapters(site)
    chapters = []
    for name in names:
        article = Article(name, folder, names)
        article.feed((folder / f"{name}.html").read_text())
        chapters.append((name, article.title, "".join(article.parts)))
    contents = "".join(f'<li><a href="#page-{n}">{t}</a></li>' for n, t, _ in chapters)
    pages = "".join(f'<section class="page" id="page-{n}">{text}</section>' for n, _, text in chapters)
    style = STYLE + "".join(line + "\n" for line in (site / "_static/site.css").read_text().splitlines() if line.startswith((".formula", "math")))
    style += ".formula { overflow: visible; justify-content: center; } .formula .label { font-size: 7pt; } math { font-size: 0.95em; }"
    return (f'<!doctype html><html lang="en"><head><meta charset="utf-8"><title>Polhode {version}: theory</title><style>{style}</style></head>'
            f"<body><h1>Polhode {version}: theory</h1><p>Every equation has a label; the last chapter lists them with their code and their tests.</p><ol>{contents}</ol>{pages}</body></html>"), version, [t for _, t, _ in chapters]


def plain(text):
    """The text of a title, without tags, with single blanks and without ligatures."""
    return re.sub(r"\s+", " ", unicodedata.normalize("NFKC", html.unescape(re.sub(r"<[^>]*>", "", text)))).strip()


def check(file, version, titles):
    """The PDF has its version on the first page, the chapters in their order in the outline, and no commands in place of formulas."""
    import pypdf

    reader = pypdf.PdfReader(file)
    text = plain(" ".join(page.extract_text().replace("<", "&lt;") for page in reader.pages))
    outline = [plain(entry.title).replace(" ", "") for entry in reader.outline if not isinstance(entry, list)]  # it breaks long titles without a blank
    wanted = [plain(title).replace(" ", "") for title in (f"Polhode {version}: theory", *titles)]
    faults = [f"the outline is {outline}, not {wanted}"] if outline != wanted else []
    faults += [f"the text lacks '{title}'" for title in (plain(t) for t in titles) if title not in text]
    if not plain(reader.pages[0].extract_text()).startswith(f"Polhode {version}: theory"):
        faults.append(f"the first page does not begin with 'Polhode {version}: theory'")
    if len(reader.pages) < 3 * len(titles) or re.search(r"\\frac|\\begin|[^ ] ?& ?=", text):
        faults.append(f"there are {len(reader.pages)} pages, or formulas are not set")
    if faults:
        sys.exit(f"theory_pdf: {file}: " + "; ".join(faults))
    print(f"{file}: Polhode {version}, {len(titles)} chapters, {len(reader.pages)} pages, {file.stat().st_size / 1e6:.1f} MB")


def main(site, out):
    wanted = [os.environ.get("CHROMIUM"), "chromium", "chromium-browser", "google-chrome"]
    browser = next((found for name in wanted if name and (found := shutil.which(name))), None)
    if browser is None:
        print("There is no Chromium: no PDF of the theory.")
        return 77
    text, version, titles = book(site)
    with tempfile.TemporaryDirectory() as folder:
        page = pathlib.Path(folder) / "theory.html"
        page.write_text(text)
        subprocess.run([browser, "--headless=new", *(["--no-sandbox"] if os.geteuid() == 0 else []), "--disable-gpu", f"--user-data-dir={folder}/profile", "--no-pdf-header-footer",
                        "--generate-pdf-document-outline", f"--print-to-pdf={out}", page.as_uri()], check=True, capture_output=True, timeout=900)
    check(out, version, titles)
    return 0


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()))
