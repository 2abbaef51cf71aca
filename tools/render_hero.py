# SPDX-License-Identifier: Apache-2.0
"""The picture of the README; tools/render_example.py makes it."""
import pathlib
import tempfile

import h5py
import matplotlib.pyplot as plt
import numpy as np

from drawing import INK, draw, fit, rotation, support


def hero():
    """Polhodes: paths of the angular velocity on the ellipsoid of constant angular momentum. Free bodies with principal moments
    1, 2, 3 kg m^2, equal magnitude of angular momentum and different energies."""
    J, h = np.array([1.0, 2.0, 3.0]), 1.0
    figure = plt.figure(figsize=(7.6, 4.9))
    scene = figure.add_axes([0, -0.06, 1, 1.1], projection="3d", computed_zorder=False)
    scene.set_axis_off()
    scene.set_proj_type("ortho")
    e, a = np.radians(34), np.radians(40)
    scene.view_init(34, 40)
    eye = np.array([np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)])
    u, v = np.meshgrid(np.linspace(0, 2 * np.pi, 241), np.linspace(0, np.pi, 121))
    ball = np.array([np.cos(u) * np.sin(v), np.sin(u) * np.sin(v), np.cos(v)])
    normals = ball * J[:, None, None]
    light = eye + np.array([0.1, 0.5, 0.7])
    bright = np.einsum("iab,i->ab", normals / np.linalg.norm(normals, axis=0), light / np.linalg.norm(light))
    tint = np.clip(0.70 + 0.29 * bright, 0, 1)[..., None] * np.array([0.99, 0.985, 0.965])
    surface = scene.plot_surface(*(0.99 * ball / J[:, None, None]), facecolors=tint, shade=False, linewidth=0,
                                 antialiased=False, zorder=0, rcount=241, ccount=241)
    surface.set_clip_on(False)
    colours = plt.get_cmap("Spectral")
    starts = []
    for part in np.linspace(0.1, 0.97, 10):  # fraction of the angle from an axis to the separatrix
        a, b = part * np.radians([30.0, 60.0])  # angles of the momenta from z and from x, in the x-z plane
        starts += [(s * np.cos(b), 0, np.sin(b)) for s in (1, -1)] + [(np.sin(a), 0, s * np.cos(a)) for s in (1, -1)]
    starts += [(s * 1e-4, y, r * 1e-4) for s in (1, -1) for r in (1, -1) for y in (1, -1)]
    with tempfile.TemporaryDirectory() as folder:
        for n, start in enumerate(starts):
            pi = h * np.array(start) / np.linalg.norm(start)  # momentum in body axes
            omega = pi / J
            model = pathlib.Path(folder) / f"body_{n}.yaml"
            model.write_text(f"""format: 1
bodies:
  body: {{mass: 1, inertia: [1, 2, 3], angular_velocity: [{omega[0]}, {omega[1]}, {omega[2]}]}}
analysis: {{duration: 80 s, step: 0.1 s, order: 6}}
output: {{every: 0.1 s}}
""")
            run = support.Run(model)
            with h5py.File(run.folder / "results.h5") as file:
                count = len(file["time"])
                R = rotation(file["packed/bodies/orientation"][:count, 0])
                path = np.einsum("kji,kj->ki", R, file["packed/bodies/angular_velocity"][:count, 0])
            energy = 0.5 * (pi**2 / J).sum() / h**2  # from 1/6 to 1/2, 1/4 on the separatrix
            shade = 0.5 * (energy - 1 / 6) / (1 / 12) if energy < 0.25 else 0.5 + 0.5 * (energy - 0.25) / 0.25
            separatrix = abs(energy - 0.25) < 1e-6
            normal = path * J**2  # outward, to the ellipsoid
            hidden = (normal @ eye) < -1e-3
            path = np.where(hidden[:, None], np.nan, path)
            colour, width = (INK, 1.8) if separatrix else (colours(0.04 + 0.92 * shade), 1.4)
            draw(scene, path, colour, 1, width, zorder=3)
    for i, length in enumerate(1.0 / J):
        axis = np.zeros(3)
        axis[i] = 1
        draw(scene, [axis * length, axis * (length + 0.16)], INK, 1, 1.2, zorder=4)
        name = ("smallest", "intermediate", "largest")[i] + " moment of inertia"
        beside = ("center", "left", "right")[i]
        scene.text(*(axis * (length + (0.25, 0.17, 0.27)[i])), name, fontsize=8, ha=beside, color=INK, zorder=5)
    fit(scene, (-1, -0.5, -0.34), (1, 0.5, 0.34), 1.5)
    return figure
