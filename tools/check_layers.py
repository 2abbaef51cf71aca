#!/usr/bin/env python3
"""Each folder of src/polhode includes only folders further down, never one on its own line."""
LAYERS = [["base"], ["so3"], ["body"], ["time"], ["assembly"],
          ["contact"], ["loads", "joints", "beams", "fe", "solve"], ["coupling"], ["model"], ["io"], ["study", "view"]]
# Of the line below it, a folder named here may include only these.
ONLY = {"coupling": ["fe"]}

import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
RANK = {folder: i for i, layer in enumerate(LAYERS) for folder in layer}
INCLUDE = re.compile(r'\s*#\s*include\s*[<"]polhode/(\w+)/')
HEADERS_OF_OTHERS = re.compile(r'\s*#\s*include\s*"')


def allowed(here, there):
    if here == there:
        return True
    if RANK[there] >= RANK[here]:
        return False
    return here not in ONLY or RANK[there] != RANK[here] - 1 or there in ONLY[here]


def main():
    problems, includes = [], 0
    source = ROOT / "src/polhode"
    for path in sorted(source.rglob("*.[ch]pp")):
        here = path.relative_to(source).parts[0]
        place = path.relative_to(ROOT)
        if path.parent == source:
            problems.append(f"{place}: stands in no folder. Put it in one of LAYERS.")
            continue
        if here not in RANK:
            problems.append(f"{place}: folder {here}/ is not in LAYERS of tools/check_layers.py.")
            continue
        for number, line in enumerate(path.read_text().splitlines(), 1):
            if HEADERS_OF_OTHERS.match(line):
                problems.append(f"{place}:{number}: include our headers as <polhode/…>.")
            if not (match := INCLUDE.match(line)):
                continue
            includes += 1
            there = match[1]
            if there not in RANK:
                problems.append(f"{place}:{number}: {there}/ is not in LAYERS of tools/check_layers.py.")
            elif not allowed(here, there):
                problems.append(f"{place}:{number}: {here}/ may not include {there}/ "
                                "(see LAYERS in tools/check_layers.py).")
    print("\n".join(problems) if problems else f"{includes} includes, all pointing down.")
    return bool(problems)


if __name__ == "__main__":
    sys.exit(main())
