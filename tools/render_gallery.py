#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Makes the pictures of the gallery, docs/images/gallery/NAME.webp: a moment of the run of each example, as its page shows it. Needs h5py, Pillow
and a Chromium.

    POLHODE=build/release/apps/polhode/polhode python3 tools/render_gallery.py [NAME ...]
"""
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

import h5py
from PIL import Image

ROOT = pathlib.Path(__file__).resolve().parent.parent
TARGET = ROOT / "docs/images/gallery"
SIZE = 480, 300
# Part of the time at which an example is shown, and eye and target of the camera where those of the whole run are too far away.
MOMENT = 0.3
MOMENTS = {"beam_roll_up": (1.0, None), "heavy_top": (0.12, None), "newtons_cradle": (0.3, None),
           "bicycle": (0.1, ((5.4, -5.2, 2.4), (2.8, -0.18, 0.7))), "crossed_lines": (1.0, None),
           "elbow": (0.38, ((0.04, -0.62, -0.06), (0.07, 0, 0.1))),
           "falling_cat": (0.3, ((0.35, -0.9, 2.1), (0, 0, 1.85))), "flexible_panel": (0.1, ((5, -3.5, 3), (0.8, 1.75, 0))),
           "gear_pair": (0.3, ((0.14, -0.2, 0.32), (0.07, 0, 0))), "incline": (0.1, ((4, -4.5, 2.5), (0.4, 0.5, 0.1))),
           "spinning_bar": (0.1, ((6, 4.5, 9), (0.14, 11.74, 4.37))), "trebuchet": (0.1, ((4.5, -13, 6), (-0.8, 0, 2.6)))}


def render(polhode, name, folder):
    # Files that the model names lie beside it, and results are where pages of them look for those files.
    shutil.copytree(ROOT / "examples" / name, folder / name)
    results, pictures = folder / name / "model.results", folder / name / "pictures"
    subprocess.run([polhode, "run", str(folder / name / "model.yaml"), "--quiet"], check=True)
    with h5py.File(results / "results.h5") as file:
        times = file["time"][:]
    part, camera = MOMENTS.get(name, (MOMENT, None))
    time = repr(float(times[0] + part * (times[-1] - times[0])))
    link = ["--link", "#" + "&".join(f"{key}={','.join(map(str, place))}" for key, place in zip(("eye", "at"), camera))] if camera else []
    subprocess.run([polhode, "convert", str(results), str(pictures), "--from", time, "--to", time, "--size", f"{2 * SIZE[0]}x{2 * SIZE[1]}", *link],
                   check=True, stdout=subprocess.DEVNULL)
    picture = Image.open(next(pictures.glob("*.png"))).convert("RGB").resize(SIZE, Image.LANCZOS)
    picture.save(TARGET / f"{name}.webp", quality=82, method=6)


def main():
    known = sorted(path.parent.name for path in (ROOT / "examples").glob("*/model.yaml"))
    wanted = sys.argv[1:] or known
    if unknown := sorted(set(wanted) - set(known)):
        sys.exit(f"render_gallery.py: there is no example '{unknown[0]}'. There are {', '.join(known)}")
    polhode = os.environ.get("POLHODE", str(ROOT / "build/release/apps/polhode/polhode"))
    TARGET.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        for name in wanted:
            render(polhode, name, pathlib.Path(folder))
            print(f"{name}: {(TARGET / f'{name}.webp').stat().st_size / 1e3:.0f} KB", flush=True)


if __name__ == "__main__":
    main()
