#!/usr/bin/env python3
"""Checks that every equation label of docs/theory is in the code and in a test, or in a list of exceptions.

Code has `@eq{label}`, a test `@tests{label}`. docs/theory/not_in_code.txt lists, with a
reason, the labels that no function implements. With --index, writes docs/theory/index.md: label,
section, function, test. Without it, also checks that this page is up to date.
"""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
THEORY = ROOT / "docs/theory"
INDEX = THEORY / "index.md"
EXCUSES = THEORY / "not_in_code.txt"
TEST = re.compile(r"^TEST(?:_P|_F)?\((\w+), (\w+)\)")
COMMENT = re.compile(r"^\s*(///?|\*)")
NAME = re.compile(r"([A-Za-z_][\w:]*)\s*(?:\(|\{|$)")


def theory_labels():
    """{label: (page, section)} in the order of the pages."""
    labels = {}
    for page in sorted(THEORY.glob("*.md")):
        if page == INDEX:
            continue
        section = ""
        for line in page.read_text().splitlines():
            if line.startswith("#"):
                section = line.lstrip("# ")
            for label in re.findall(r"\\label\{([\w:-]+)\}", line):
                labels[label] = (page.name, section)
    return labels


def subject(lines, at):
    """Test, function or type below the comment at lines[at]; '' if unclear."""
    if not COMMENT.match(lines[at]):
        return ""
    while at < len(lines) and COMMENT.match(lines[at]):
        at += 1
    if at == len(lines):
        return ""
    if match := TEST.match(lines[at]):
        return ".".join(match.groups())
    text = re.sub(r"\[\[.*?\]\]|\b(inline|static|constexpr|virtual|struct|class|const)\b|<[^<>]*>", "", lines[at])
    match = NAME.search(text)
    return match[1] if match and not text.startswith("    " * 2) else ""


def tagged(folder, tag):
    """{label: [(path, test or function below the tag)]}."""
    found = {}
    for path in sorted((ROOT / folder).rglob("*.[ch]pp")):
        lines = path.read_text().splitlines()
        for at, line in enumerate(lines):
            for label in re.findall(re.escape(tag) + r"\{([\w:-]+)\}", line):
                found.setdefault(label, []).append((path.relative_to(ROOT), subject(lines, at)))
    return found


def entry(places):
    unique = dict.fromkeys(f"`{what}` ({path})" if what else str(path) for path, what in places)
    return "<br>".join(unique)


def index_text(labels, coded, tested, excuses):
    text = ["# Index of equations", "",
            "Written by `tools/check_equations.py --index`; labels link to the page that derives them.", "",
            "| label | section | code | test |", "| --- | --- | --- | --- |"]
    for label, (page, section) in labels.items():
        code = entry(coded[label]) if label in coded else excuses.get(label, "")
        text.append(f"| [{label}]({page}) | {section} | {code} | {entry(tested.get(label, []))} |")
    return "\n".join(text) + "\n"


def main():
    labels = theory_labels()
    excuses = dict(re.findall(r"^([\w:-]+) +(\S.*)$", EXCUSES.read_text(), re.M))
    coded, tested = tagged("src", "@eq"), tagged("tests", "@tests")
    index = index_text(labels, coded, tested, excuses)
    if "--index" in sys.argv[1:]:
        INDEX.write_text(index)

    problems = []
    for found, tag in ((coded, "@eq"), (tested, "@tests")):
        for label in sorted(found.keys() - labels.keys()):
            problems.append(f"{found[label][0][0]}: {tag}{{{label}}}: no such label in docs/theory.")
    problems += [f"{EXCUSES.relative_to(ROOT)}: {x}: no such label in docs/theory."
                 for x in excuses if x not in labels]
    for label, (page, _) in labels.items():
        if label in coded and label in excuses:
            problems.append(f"{label}: in the code ({coded[label][0][0]}); take it out of not_in_code.txt.")
        if label not in coded and label not in excuses:
            problems.append(f"{label}: no @eq in src/. Tag the function that implements it, "
                            "or list it with a reason in docs/theory/not_in_code.txt.")
        if label in coded and label not in tested:
            problems.append(f"{label}: in the code ({coded[label][0][0]}), but no @tests names it.")
    if not INDEX.exists() or INDEX.read_text() != index:
        problems.append("docs/theory/index.md is out of date. Run tools/check_equations.py --index.")
    print("\n".join(problems) if problems else
          f"{len(labels)} equations: {len(coded)} in the code, {len(tested)} in tests.")
    return bool(problems)


if __name__ == "__main__":
    sys.exit(main())
