#!/usr/bin/env python3
"""Documentation and source agree.

* Every kind in a registry has a row in its reference page, and every row has its kind.
* Every path of the repository that a page names in `backticks` exists.
* The target of every link from a page to a file of the repository exists.
* The C++ program of the tour is that of tests/consumer, which is built and run against the installed library.
* No file under src/ has more than 500 lines; above 300 there is a notice.
* The newest section of the changelog, the version of CMake and the files that the page install names agree, and notes of changes have names
  with their day, not before that section's, and a title.
"""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
# Registry of kinds, by the first string of each entry -> page with a table row for each.
REGISTRIES = {
    "src/polhode/geometry/shapes.cpp": "docs/reference/shapes.md",
    "src/polhode/joints/registry.cpp": "docs/reference/joints.md",
    "src/polhode/loads/registry.cpp": "docs/reference/loads.md",
    "src/polhode/solids/elements/registry.cpp": "docs/reference/elements.md",
    "src/polhode/solids/mesh/generators.cpp": "docs/reference/meshes.md",
}
# Kinds whose name is in their own files, kKind = "name" -> page.
KIND_FILES = {
    "src/polhode/solids/materials": "docs/reference/materials.md",
}
# Loads on solids have .name = "name" in their own files and are on the page of the loads on bodies.
SOLID_LOADS = "src/polhode/solids/loads"
JOINT_LOADS = "src/polhode/io/schema/field_table.hpp"  # plain names of motors and dampers
JOINT_LOAD = re.compile(r'kJoint(?:Moment|Force) = "(\w+)"')
SOLID_LOAD = re.compile(r'\{\.name = "(\w+)"')
KIND = re.compile(r'^ {6}(?:(?:\{|inerter_kind\()"(?=\w+",))?(\w+)(?:",|_kind\(\),)', re.M)
OWN_KIND = re.compile(r'\bkKind = "(\w+)"')
TOP = ("src", "apps", "tests", "docs", "tools", "scripts", "cmake", "benchmarks", "examples", "changes", "python",
       "viewer")
PATH = re.compile(r"`((?:%s)/[^`\s]*)`" % "|".join(TOP))
LINK = re.compile(r"\[[^\]]*\]\(<?([^)>\s]+)>?(?:\s+\"[^\"]*\")?\)")
LINES_WARN, LINES_MOST = 300, 500


def pages():
    skip = {"build", ".git", "node_modules"}
    for path in sorted(ROOT.rglob("*.md")):
        parts = path.relative_to(ROOT).parts
        if not skip & set(parts) and not any(p.endswith(".results") for p in parts):
            yield path


def expansions(path):
    """a/{b,c}.hpp -> a/b.hpp, a/c.hpp."""
    if match := re.search(r"\{([^{}]*)\}", path):
        return [e for part in match[1].split(",")
                for e in expansions(path[:match.start()] + part.strip() + path[match.end():])]
    return [path]


def exists(path):
    if re.search(r"[<>…]|\.\.\.", path):  # a pattern for the reader, such as src/polhode/joints/<x>_joint.hpp
        return True
    path = re.sub(r"(:\d+)+$", "", path)  # file:line
    if any(c in path for c in "*?["):
        return any(True for _ in ROOT.glob(path))
    return (ROOT / path).exists()


def check_kinds(problems):
    found = {r: (set(KIND.findall((ROOT / r).read_text())), page) for r, page in REGISTRIES.items() if (ROOT / r).exists()}
    for folder, page in KIND_FILES.items():
        texts = [path.read_text() for path in (ROOT / folder).glob("*.hpp")]
        found[folder] = ({kind for text in texts for kind in OWN_KIND.findall(text)}, page)
    for path in (ROOT / SOLID_LOADS).glob("*.hpp"):
        found["src/polhode/loads/registry.cpp"][0].update(SOLID_LOAD.findall(path.read_text()))
    found["src/polhode/loads/registry.cpp"][0].update(JOINT_LOAD.findall((ROOT / JOINT_LOADS).read_text()))
    for registry, (registered, page) in found.items():
        text = (ROOT / page).read_text() if (ROOT / page).exists() else ""
        rows = re.findall(r"^\|\s*`?(\w+)`?\s*\|", text, re.M)
        documented = set(rows) - {"name", "kind", "type", "shape", "joint", "load", "material", "fibre", "element", "mesh"}
        problems += [f"{registry}: '{kind}' has no row in {page}. Add one." for kind in sorted(registered - documented)]
        problems += [f"{page}: '{kind}' is not in {registry}." for kind in sorted(documented - registered)]


def check_pages(problems):
    for page in pages():
        place = page.relative_to(ROOT)
        for number, line in enumerate(page.read_text().splitlines(), 1):
            for named in PATH.findall(line):
                for path in expansions(named.rstrip("/.,;:")):
                    if not exists(path):
                        problems.append(f"{place}:{number}: `{path}` does not exist.")
            for target in LINK.findall(re.sub(r"`[^`]*`", "", line)):
                if re.match(r"[a-z]+:|#", target):
                    continue
                if not (page.parent / target.split("#")[0]).exists():
                    problems.append(f"{place}:{number}: the target of the link {target} does not exist.")


def check_lengths(problems):
    for path in sorted((ROOT / "src").rglob("*.[ch]pp")):
        lines = len(path.read_text().splitlines())
        if lines > LINES_MOST:
            problems.append(f"{path.relative_to(ROOT)}: {lines} lines, at most {LINES_MOST}. Split it.")
        elif lines > LINES_WARN:
            print(f"{path.relative_to(ROOT)}: {lines} lines; split it if it grows (notice above {LINES_WARN}).")


def check_program(problems):
    """Lines of a block of code without blanks and its closing brace."""
    def lines(text):
        return [line.rstrip() for line in text.splitlines() if line.strip()]

    shown = re.search(r"```cpp\n(.*?)```", (ROOT / "docs/tour.md").read_text(), re.S)
    built = lines((ROOT / "tests/consumer/main.cpp").read_text())
    wanted = lines(shown[1])[:-1] if shown else []
    if not wanted or not any(built[i:i + len(wanted)] == wanted for i in range(len(built))):
        problems.append("docs/tour.md: its C++ program is not that of tests/consumer/main.cpp. Copy it from there.")


def check_release(problems, root=ROOT):
    version = re.search(r"^project\(polhode VERSION (\S+)", (root / "CMakeLists.txt").read_text(), re.M)[1]
    sections = re.findall(r"^## (\S+) \((\d{4}-\d{2}-\d{2})\)$", (root / "CHANGELOG.md").read_text(), re.M)
    if not sections or sections[0][0] != version:
        problems.append(f"CHANGELOG.md: its newest section is not '## {version} (date)', the version of CMakeLists.txt.")
    page = (root / "docs/how_to/install.md").read_text()
    for other in sorted(set(re.findall(r"polhode(?:-dev)?[-_](\d+\.\d+\.\d+)", page)) - {version}):
        problems.append(f"docs/how_to/install.md: names files of version {other}, but the version is {version}.")
    for note in sorted(set((root / "changes").iterdir()) - {root / "changes/README.md"}):
        day = re.fullmatch(r"(\d{8})-[\w-]+\.md", note.name)
        if day is None or not note.read_text().startswith("# "):
            problems.append(f"changes/{note.name}: a note is YYYYMMDD-words.md and begins with a title '# ...'.")
        elif sections and day[1] < sections[0][1].replace("-", ""):
            problems.append(f"changes/{note.name}: is older than version {sections[0][0]}. Add it to CHANGELOG.md, and remove it.")


def main():
    problems = []
    check_release(problems)
    check_program(problems)
    check_kinds(problems)
    check_pages(problems)
    check_lengths(problems)
    print("\n".join(problems) if problems else "Documentation and source agree.")
    return bool(problems)


if __name__ == "__main__":
    sys.exit(main())
