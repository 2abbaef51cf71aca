#!/usr/bin/env python3
"""Checks that each folder of src/polhode includes only folders of lower layers, never one of its own layer.

    tools/check_layers.py                checks
    tools/check_layers.py --picture FILE draws the layers and their includes, as SVG

Also checks that docs/images/layers.svg has the arrows of today, that namespaces follow folders (docs/decisions/0009),
that there are no dynamic casts and that the interface of interactions stays small (docs/decisions/0008).
"""
# From the bottom up; folders of one layer do not include each other.
LAYERS = [
    ["core"],
    ["math", "geometry"],
    ["dynamics", "contact_laws"],
    ["system"],
    ["joints", "loads", "beams", "solids", "contact", "linear", "kernels"],
    ["surface_contact", "model", "equations"],
    ["impulses"],
    ["engines", "newton"],
    ["stepping"],
    ["statics"],
    ["compile"],
    ["joint_space"],
    ["simulation"],
    ["gradient"],
    ["io/text"],
    ["io/schema", "io/importers", "io/exporters"],
    ["io/read"],
    ["io/results"],
    ["study", "view"],
]

import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
SOURCE = ROOT / "src/polhode"
RANK = {folder: i for i, layer in enumerate(LAYERS) for folder in layer}
INCLUDE = re.compile(r'\s*#\s*include\s*[<"]polhode/([\w/]+)/\w+\.\w+[>"]')
PICTURE = ROOT / "docs/images/layers.svg"
INTERACTIONS = SOURCE / "system/interaction_group.hpp"
MOST_VIRTUALS = 15
VIRTUAL = re.compile(r"\bvirtual [^~\n]*\(")
# Facets of a group of elements, and the functions that return them.
FACETS = {"BarrierConstraint": "barrier_constraint", "InternalUnknowns": "internal_unknowns",
          "ChangingSparsity": "changing_sparsity", "SurfaceImpacts": "surface_impacts"}
# Namespaces of folders; all others have polhode.
NAMESPACES = {"geometry": "geometry", "solids": "solids", "linear": "linear", "contact": "contact",
              "contact_laws": "contact", "surface_contact": "surface_contact", "io": "io"}
# Numbers with derivatives by the motion of two bodies in contact, in folders below contact.
OF_CONTACT = {"math/dual.hpp", "dynamics/placement.hpp"}
NAMESPACE = re.compile(r"^namespace (polhode(?:::\w+)*) \{\n(.*?)^\}", re.MULTILINE | re.DOTALL)
DECLARATION = re.compile(r"(?:(?:template.*|class|struct|enum class) .*;\s*)*")
HEADERS_OF_OTHERS = re.compile(r'\s*#\s*include\s*"')


def layer(folder):
    """Name in LAYERS of a folder: itself, or its parent folder."""
    parts = folder.split("/")
    return next((name for n in (2, 1) if (name := "/".join(parts[:n])) in RANK), None)


def wrong_namespace(path, text):
    """First namespace that is not that of the file's folder and has more than declarations, or None; the folder's."""
    place = path.relative_to(SOURCE)
    inner = "contact" if place.as_posix() in OF_CONTACT else NAMESPACES.get(place.parts[0])
    expected = f"polhode::{inner}" if inner else "polhode"
    for name, body in NAMESPACE.findall(text):
        follows = name.split("::")[1:2] == [inner] if inner else name.split("::")[1:2] not in [[n] for n in NAMESPACES.values()]
        if not follows and not DECLARATION.fullmatch(body.strip()):
            return name, expected
    return None, expected


def survey():
    """Problems, the number of includes, and those between each pair of folders."""
    problems, includes, edges = [], 0, {}
    for path in sorted(SOURCE.rglob("*.[ch]pp")):
        place = path.relative_to(ROOT)
        here = layer(path.parent.relative_to(SOURCE).as_posix())
        if path == SOURCE / "polhode.hpp":
            continue
        if path.parent == SOURCE:
            problems.append(f"{place}: is in no folder. Put it in one of LAYERS.")
            continue
        if here is None:
            problems.append(f"{place}: its folder is not in LAYERS of tools/check_layers.py.")
            continue
        text = path.read_text()
        wrong, expected = wrong_namespace(path, text)
        if wrong:
            problems.append(f"{place}: is in namespace {wrong}, but its folder has {expected}.")
        problems += [f"{place}: is {facet}, but does not override {asked}()." for facet, asked in FACETS.items()
                     if re.search(rf"public {facet}\b", text) and f"{asked}() const override" not in text]
        for number, line in enumerate(text.splitlines(), 1):
            if "dynamic_cast<" in line:
                problems.append(f"{place}:{number}: casts to a type at run time. See docs/decisions/0008-casts-and-virtuals.md.")
            if HEADERS_OF_OTHERS.match(line):
                problems.append(f"{place}:{number}: include headers of Polhode as <polhode/…>.")
            if not (match := INCLUDE.match(line)):
                continue
            includes += 1
            there = layer(match[1])
            if there is None:
                problems.append(f"{place}:{number}: {match[1]}/ is not in LAYERS of tools/check_layers.py.")
            elif there != here:
                edges[here, there] = edges.get((here, there), 0) + 1
                if RANK[there] >= RANK[here]:
                    problems.append(f"{place}:{number}: {here}/ may not include {there}/ "
                                    "(see LAYERS in tools/check_layers.py).")
    virtuals = len(VIRTUAL.findall(INTERACTIONS.read_text()))
    if virtuals > MOST_VIRTUALS:
        problems.append(f"{INTERACTIONS.relative_to(ROOT)}: {virtuals} virtual functions, at most {MOST_VIRTUALS}. "
                        "Properties that are constant during a run belong to InteractionTraits.")
    return problems, includes, edges


def picture(edges):
    """Layers from the ground up; an arrow is as thick as the logarithm of its includes."""
    import math
    width, row, room, tall = 1000, 62, 118, 34
    height = row * len(LAYERS) + 20
    place = {}
    for i, folders in enumerate(LAYERS):
        for k, name in enumerate(folders):
            x = width / 2 + (k - (len(folders) - 1) / 2) * (room + 18) + (34 if i % 2 else -34) * (len(folders) == 1)
            place[name] = (x, height - 20 - i * row - tall / 2)
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" font-family="sans-serif" '
           'font-size="13">', f'<rect width="{width}" height="{height}" fill="#fff"/>']
    for (a, b), count in sorted(edges.items(), key=lambda e: e[1]):
        (xa, ya), (xb, yb) = place[a], place[b]
        thick = 0.5 + 0.5 * math.log2(count)
        bend = (xb - xa) * 0.1 + (26 if xa >= width / 2 else -26) * (RANK[a] - RANK[b] > 1)
        out.append(f'<path d="M{xa:.0f} {ya + tall / 2:.0f} C{xa + bend:.0f} {ya + 60:.0f} {xb + bend:.0f} {yb - 60:.0f} '
                   f'{xb:.0f} {yb - tall / 2:.0f}" fill="none" stroke="#2a6f97" stroke-opacity=".28" '
                   f'stroke-width="{thick:.1f}"/>')
    for name, (x, y) in place.items():
        files = sum(1 for p in (SOURCE / name).rglob("*.[ch]pp"))
        out.append(f'<rect x="{x - room / 2:.0f}" y="{y - tall / 2:.0f}" width="{room}" height="{tall}" rx="5" '
                   'fill="#eef4f8" stroke="#2a6f97"/>'
                   f'<text x="{x:.0f}" y="{y:.0f}" text-anchor="middle">{name}</text>'
                   f'<text x="{x:.0f}" y="{y + 12:.0f}" text-anchor="middle" font-size="9" fill="#567">{files} files</text>')
    return "\n".join([*out, "</svg>", ""])


def arrows(svg):
    """Which folders include each other, as drawn."""
    return set(re.findall(r' d="([^"]+)"', svg)) | set(re.findall(r'middle">([^<]+)<', svg))


def main():
    problems, includes, edges = survey()
    if sys.argv[1:2] == ["--picture"]:
        pathlib.Path(sys.argv[2]).write_text(picture(edges))
        return 0
    if arrows(PICTURE.read_text()) != arrows(picture(edges)):
        problems.append(f"{PICTURE.relative_to(ROOT)}: other folders include each other than before. "
                        f"Draw it again: tools/check_layers.py --picture {PICTURE.relative_to(ROOT)}")
    print("\n".join(problems) if problems else f"{includes} includes, all of lower layers.")
    return bool(problems)


if __name__ == "__main__":
    sys.exit(main())
