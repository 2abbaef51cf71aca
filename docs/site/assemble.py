# SPDX-License-Identifier: Apache-2.0
"""Makes the pages that Sphinx reads out of those of the repository.

The pages of docs/, the README files of the examples and the pages at the top keep their text; links
follow them to their places in the site, paths of source files become links to the source, equation
labels become Sphinx's, and the gallery and the pages about the Python and C++ interfaces are added.
"""

import argparse
import os
import pathlib
import posixpath
import re
import shutil
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import cpp_pages  # noqa: E402
import gallery_topics  # noqa: E402
import python_pages  # noqa: E402
import source_pages  # noqa: E402
import tables  # noqa: E402
from docutils import nodes  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parents[2]
TOP = {"README.md": "overview.md", "ARCHITECTURE.md": "architecture.md", "CONTRIBUTING.md": "contributing.md", "CHANGELOG.md": "changelog.md",
       "docs/README.md": "index.md", "docs/index.md": "index.md", "examples/README.md": "gallery.md"}
FENCE = re.compile(r"^\s*(`{3,}|~{3,}|:{3,})")
LINK = re.compile(r"(!?\[(?:[^\[\]]|\[[^\[\]]*\])*\])\(<?([^)>\s]+)>?((?:\s+\"[^\"]*\")?)\)")
PATH = re.compile(r"`((?:src|apps|tests|tools|scripts|cmake|benchmarks|examples|python|viewer)/[\w./-]+\.(?:hpp|cpp|py|ts|mjs|sh|yaml|txt|cmake))(?::(\d+))?`")
LABELLED = re.compile(r"\$\$(.+?)\$\$", re.S)
LABEL = re.compile(r"\s*\\label\{([\w:-]+)\}")
INDEX_CODE = re.compile(r"`(?P<name>[^`]+)` \((?P<path>(?:src|tests)/[\w./-]+)\)|(?<=[ >])(?P<alone>(?:src|tests)/[\w./-]+)(?=<br>|\s)")

PDF = '\n<a href="../theory.pdf">All pages of the theory in one PDF.</a>\n'


def site_path(path):
    """Place in the site of a page of the repository."""
    if path in TOP:
        return TOP[path]
    if path.startswith("docs/"):
        return path[len("docs/"):]
    if path.endswith("/README.md"):
        return path[:-len("README.md")] + "index.md"
    return path


class Site:
    def __init__(self, target):
        self.target = target
        self.cited = {}   # source file -> equation labels whose lines are linked

    def write(self, place, text):
        path = self.target / place
        path.parent.mkdir(parents=True, exist_ok=True)
        if not path.exists() or path.read_text() != text:
            path.write_text(text)

    def copy(self, place, at):
        path = self.target / at
        path.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(ROOT / place, path)

    def source_link(self, page, path, shown, anchor="", title=""):
        """HTML link from a page of the site to the page of a source file."""
        self.cited.setdefault(path, set())
        up = posixpath.relpath(f"code/{path}.html", posixpath.dirname(page) or ".")
        told = f' title="{title}"' if title else ""
        return f'<a class="code" href="{up}{anchor}"{told}>{shown}</a>'

    def row(self, line, page):
        """A row of a table: what it means has the room. Source files are links with short names, or alone in their cell with none."""
        def source(match, shown):
            path, number = match.groups()
            return self.source_link(page, path, shown, f"#L{number}" if number else "", path) if (ROOT / path).is_file() else match[0]

        cells = re.split(r"(?<!\\)\|", line)
        for at, cell in enumerate(cells):
            if alone := PATH.fullmatch(cell.strip()):
                cells[at] = f" {source(alone, 'code')} "
            else:
                cells[at] = PATH.sub(lambda m: source(m, f"<code>{tables.breakable(posixpath.basename(m[1]))}</code>"), cell)
        return "|".join(cells)

    def link(self, match, place, page):
        text, target, title = match.groups()
        if re.match(r"[a-z]+:|#", target):
            return match[0]
        name, _, anchor = target.partition("#")
        path = posixpath.normpath(posixpath.join(posixpath.dirname(place), name))
        if (ROOT / path).is_dir():
            path += "/README.md"
            if not (ROOT / path).exists():
                return "[%s](%s)" % (text[1:-1], posixpath.relpath("theory/index.md", posixpath.dirname(page) or ".")) if path.startswith("docs/theory") else text[1:-1]
        if path.endswith(".md"):
            to = site_path(path)
        elif text.startswith("!"):
            to = site_path(path)
            self.copy(path, to)
        else:
            return self.source_link(page, path, text[1:-1])
        to = posixpath.relpath(to, posixpath.dirname(page) or ".")
        return f"{text}({to}{'#' + anchor if anchor else ''}{title})"

    def rewritten(self, text, place, page):
        lines, fence = [], None
        for line in text.split("\n"):
            mark = FENCE.match(line)
            if mark and fence is None and mark[1][0] != ":":
                fence = mark[1]
                line = line.replace("```console", "```text")
            elif mark and fence and mark[1].startswith(fence):
                fence = None
            elif fence is None:
                line = LINK.sub(lambda m: self.link(m, place, page), line)
                if line.startswith("|"):
                    line = self.row(line, page)
                line = PATH.sub(lambda m: self.source_link(page, m[1], f"<code>{m[1]}</code>", f"#L{m[2]}" if m[2] else "")
                                if (ROOT / m[1]).is_file() else m[0], line)
            lines.append(line)
        return "\n".join(lines)

    def add(self, place, more=""):
        """A page of the repository."""
        page = site_path(place)
        text = (ROOT / place).read_text()
        if place == "docs/theory/index.md":
            text = self.index_of_equations(text)
        elif place.startswith("docs/theory/"):
            text = with_labels(text)
        self.write(page, self.rewritten(text, place, page) + more)
        return page

    def index_of_equations(self, text):
        """The index with links in place of paths: a function or test by its name, a file by its own."""
        def code(match, label):
            name, path = match["name"], match["path"] or match["alone"]
            if not (ROOT / path).is_file():
                return match[0]
            link = self.source_link("theory/index.md", path, f"<code>{tables.breakable(name or posixpath.basename(path))}</code>", f"#{label}", path)
            self.cited[path].add(label)
            return link

        lines = []
        for line in text.split("\n"):
            if row := re.match(r"\| \[([\w:-]+)\]\((\w+)\.md\)", line):
                label = row[1]
                rest = INDEX_CODE.sub(lambda m: code(m, label), line[row.end():])
                line = f'| <a href="{row[2]}.html#{nodes.make_id("equation-" + label)}">{label}</a>{rest}'
            lines.append(line)
        return "\n".join(lines)

    def example(self, folder, live):
        model = (folder / "model.yaml").read_text().rstrip()
        more = f"\n## The model\n\n```yaml\n{model}\n```\n"
        if live:
            more = (f'\n## Live\n\n<iframe class="live" loading="lazy" title="The run of this example, to play, turn and plot" src="../../live/{folder.name}.html"></iframe>\n\n'
                    f'<a href="../../live/{folder.name}.html">The run alone in the window.</a>\n') + more
        self.add(f"examples/{folder.name}/README.md", more)

    def gallery(self, live):
        rows = re.findall(r"^\| \[(\w+)\]\(\w+\) \| ([^|]+) \| ([^|]+) \|$", (ROOT / "examples/README.md").read_text(), re.M)
        text = ["# Gallery", "", "Every example is a model to read, to run and to change, and has a check against something known, which the tests run.",
                "*Live* plays its run in the browser, without network.", "", '<div id="gallery-filter"></div>', "", "::::{container} gallery", ""]
        for name, shows, compared in rows:
            title = (ROOT / f"examples/{name}/README.md").read_text().split("\n")[0].lstrip("# ")
            playing = f' <a class="play" href="live/{name}.html">Live</a>' if name in live else ""
            topics = gallery_topics.topics((ROOT / f"examples/{name}/model.yaml").read_text())
            if not (ROOT / f"docs/images/gallery/{name}.webp").exists():
                sys.exit(f"assemble.py: the example '{name}' has no docs/images/gallery/{name}.webp. Make it: tools/render_gallery.py {name}")
            self.copy(f"docs/images/gallery/{name}.webp", f"images/gallery/{name}.webp")
            text += [":::{container} card", f"[![{title}](images/gallery/{name}.webp)](examples/{name}/index.md)", "",
                     f"**[{title}](examples/{name}/index.md)**: {shows.strip()}.{playing}", "", f"Compared with: {compared.strip()}.", "",
                     f'<p class="topics">{", ".join(topics)}</p>', ":::", ""]
        text += ["::::", "", "```{toctree}", ":hidden:", "", *[f"examples/{name}/index" for name, _, _ in rows], "```", ""]
        self.write("gallery.md", "\n".join(text))


def with_labels(text):
    """$$ … \\label{x} $$ as MyST wants it: $$ … $$ (x)."""
    def one(match):
        labels = LABEL.findall(match[1])
        return f"$${LABEL.sub('', match[1])}$$" + (f" ({labels[0]})" if labels else "")
    return LABELLED.sub(one, text)


def pages():
    known = subprocess.run(["git", "ls-files", "--cached", "--others", "--exclude-standard", "*.md"], cwd=ROOT, capture_output=True, text=True, check=False)
    listed = known.stdout.split() if known.returncode == 0 else [str(p.relative_to(ROOT)) for p in ROOT.rglob("*.md") if "build" not in p.parts]
    return [p for p in sorted(listed) if (ROOT / p).exists() and (p.startswith("docs/") or p in TOP)]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("target", type=pathlib.Path, help="folder for the pages")
    parser.add_argument("--pdf", action="store_true", help="a PDF of the theory will be made: link it")
    parser.add_argument("--live", type=pathlib.Path, help="folder of pages of runs, NAME.html, and of their player")
    options = parser.parse_args()
    shutil.rmtree(options.target / "extra", ignore_errors=True)
    site = Site(options.target)
    live = {p.stem for p in options.live.glob("*.html")} - {"index"} if options.live else set()
    for place in pages():
        if place not in ("docs/README.md", "examples/README.md"):
            site.add(place, PDF if options.pdf and place == "docs/theory/index.md" else "")
    for folder in sorted((ROOT / "examples").iterdir()):
        if (folder / "README.md").exists():
            site.example(folder, folder.name in live)
    site.gallery(live)
    site.write("api/python.md", python_pages.page(ROOT / "python/polhode"))
    for name, text in cpp_pages.pages(ROOT / "src/polhode", site).items():
        site.write(name, text)
    source_pages.write(site, ROOT)
    if options.live:
        shutil.copytree(options.live, options.target / "extra/live")
    shutil.copytree(ROOT / "docs/site/static", options.target / "static", dirs_exist_ok=True)
    print(f"{len(list(options.target.rglob('*.md')))} pages, {len(site.cited)} sources, {len(live)} live runs")


if __name__ == "__main__":
    os.umask(0o022)
    main()
