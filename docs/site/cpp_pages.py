# SPDX-License-Identifier: Apache-2.0
"""Pages of the C++ interface, out of the comments of the headers: a page for each layer, a section for each header."""

import re
import textwrap

_ESCAPED = re.compile(r"([\\*_\[\]<>#$|~{}])")


def _escaped(text):
    """Text whose marks mean nothing to Markdown, code in backticks excepted."""
    return "".join(part if k % 2 else _ESCAPED.sub(r"\\\1", part) for k, part in enumerate(re.split(r"(`[^`]*`)", text)))


def _paragraph(lines, equations):
    text = " ".join(lines)
    text = re.sub(r"\s*@eq\{([\w:-]+)\}", lambda m: f"\x00{m[1]}\x00", text)
    text = re.sub(r"@param(\[[\w,]+\])?\s+(\w+)\s+", "\x01\\2\x01 ", text)
    for word, shown in (("@returns?", "Returns"), ("@throws?", "Throws"), ("@tparam", "Template")):
        text = re.sub(rf"{word}\s+", f"\x02{shown}\x02 ", text)
    text = _escaped(text)
    text = re.sub("\x00(.*?)\x00", lambda m: equations(m[1].replace("\\", "")), text)
    text = re.sub("\x01(.*?)\x01", lambda m: f"<br>`{m[1]}`:".replace("\\", ""), text)
    return re.sub("\x02(.*?)\x02", r"<br>\1", text)


def _declarations(text):
    """(declaration, comment lines) of what has a comment `///`, private things left out."""
    lines, at, private = text.split("\n"), 0, False
    while at < len(lines):
        line = lines[at].strip()
        if line in ("private:", "public:"):
            private = line == "private:"
        if lines[at].startswith("}"):
            private = False
        if not line.startswith("///") or line.startswith("///<"):
            at += 1
            continue
        comment = []
        while at < len(lines) and lines[at].strip().startswith("///"):
            comment.append(lines[at].strip()[3:].strip())
            at += 1
        declared, depth = [], 0
        while at < len(lines) and len(declared) < 8:
            part = lines[at].strip()
            at += 1
            if part.startswith("///"):
                at -= 1
                break
            declared.append(re.sub(r"\s*//.*", "", part))
            depth += part.count("(") - part.count(")")
            if depth <= 0 and re.search(r"[;{}]\s*$", declared[-1]):
                break
        shown = re.sub(r"\s*(\{.*)?;?\s*$", "", " ".join(declared))
        shown = shown.replace("[[nodiscard]] ", "")
        if macro := re.match(r"#define\s+\w+(\([^)]*\))?", shown):
            shown = macro[0]
        if shown and not private:
            yield re.sub(r"\s*:\s[\w(].*$", "", shown) if shown.count("(") and re.search(r"\)\s*:\s", shown) else shown, comment


def pages(folder, site):
    made, names = {}, []
    for layer in sorted(p for p in folder.iterdir() if p.is_dir()):
        page = f"api/cpp/{layer.name}.md"
        text = []
        for header in sorted(layer.rglob("*.hpp")):
            path = f"src/polhode/{header.relative_to(folder).as_posix()}"
            section = []
            for declaration, comment in _declarations(header.read_text()):
                equations = lambda label: f' (equation <a href="../../theory/index.html">{label}</a>)'  # noqa: E731
                section += ["```cpp", textwrap.fill(declaration, 84, subsequent_indent="    ", break_long_words=False), "```", "", _paragraph(comment, equations), ""]
            if section:
                text += [f"## {header.relative_to(layer).as_posix()}", "", site.source_link(page, path, "The source"), "", *section]
        if text:
            made[page] = "\n".join([f"# {layer.name}", "", *text])
            names.append(layer.name)
    own = folder.parents[1] / "tests/consumer"
    own_program, own_build = (own / "main.cpp").read_text(), (own / "CMakeLists.txt").read_text()
    made["api/cpp/index.md"] = "\n".join([
        "# C++ interface", "", "What the headers of each layer declare, with their comments; [the architecture](../../architecture.md) says how the layers stand on each other.", "",
        "A program of your own, which the tests build against an installed Polhode:", "", "```cpp", own_program.strip(), "```", "",
        "Its `CMakeLists.txt`:", "", "```cmake", own_build.strip(), "```", "",
        "```{toctree}", ":maxdepth: 1", "", *names, "```", ""])
    return made
