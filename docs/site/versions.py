# SPDX-License-Identifier: Apache-2.0
"""The list of the versions of the site that lie side by side in a folder: index.html, and versions.js, which their pages read.

    versions.py FOLDER    FOLDER/0.1.0/index.html, FOLDER/0.2.0/index.html, ...
"""

import html
import json
import pathlib
import re
import sys


def order(name):
    """Numbers by size; a name without a number, such as 'next', stands above all."""
    numbers = [int(n) for n in re.findall(r"\d+", name)]
    return (0 if re.match(r"v?\d", name) else 1, numbers, name)


def write(folder):
    names = sorted((p.parent.name for p in folder.glob("*/index.html")), key=order, reverse=True)
    released = [n for n in names if order(n)[0] == 0] or names
    (folder / "versions.js").write_text(f"window.polhodeVersions = {json.dumps(names)};\n")
    rows = "".join(f'<li><a href="{html.escape(n)}/index.html">{html.escape(n)}</a>{" (newest release)" if n == released[0] else ""}</li>\n' for n in names)
    (folder / "index.html").write_text(f"""<!doctype html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width"><title>Polhode: documentation by version</title>
<style>body {{ font: 1.1rem/1.5 sans-serif; max-width: 40rem; margin: 3rem auto; padding: 0 1rem; color-scheme: light dark; }}</style></head>
<body><h1>Polhode: documentation by version</h1><ul>
{rows}</ul></body></html>
""")
    return names


if __name__ == "__main__":
    print("versions: " + ", ".join(write(pathlib.Path(sys.argv[1]))))
