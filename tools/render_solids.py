#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Makes the pictures of the examples with deformable solids. Needs numpy, matplotlib and h5py.

    POLHODE=build/release/apps/polhode/polhode python3 tools/render_solids.py [NAME ...]
"""
import sys

import h5py
import numpy as np
from matplotlib import cm, colors
from mpl_toolkits.mplot3d.art3d import Poly3DCollection

from drawing import BLUE, GOLD, GREEN, INK, PALE, RED, ROOT, box, draw, fit, label, rotation, save, sheet, support

FACES = ((0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7))  # of a hexahedron
LIGHT = np.array([0.35, -0.55, 0.76])


class Solids:
    """Frames of a run: solids by name, bodies, probes, energies."""

    def __init__(self, name, *settings):
        self.run = support.Run(ROOT / "examples" / name / "model.yaml", *settings)
        self.figures = self.run.figures
        with h5py.File(self.run.folder / "results.h5") as file:
            self.t = file["time"][:]
            n = len(self.t)
            self.energy = {key: value[:n] for key, value in file["energy"].items()}
            self.place, self.turn = {}, {}
            for body in file.get("bodies", {}):
                self.place[body] = file[f"bodies/{body}/position"][:n]
                self.turn[body] = rotation(file[f"bodies/{body}/orientation"][:n])
            self.spin = {b: file[f"bodies/{b}/angular_velocity"][:n] for b in file.get("bodies", {})}
            self.nodes, self.stress, self.faces = {}, {}, {}
            for solid in file["solids"]:
                group = file[f"solids/{solid}"]
                self.nodes[solid] = group["nodes/reference"][:] + group["nodes/displacement"][:n]
                self.stress[solid] = group["nodes/von_mises"][:n]
                self.faces[solid] = surface(group["elements/connectivity"][:], group["elements/offsets"][:])

    def probe(self, name):
        return {key: np.array(column) for key, column in self.run.probe(name).items()}


def surface(connectivity, offsets):
    """Corner nodes of the outer faces: those that belong to one hexahedron only."""
    seen = {}
    for first in offsets[:-1] if len(offsets) > 1 else offsets:
        corners = connectivity[first:first + 8]
        for face in FACES:
            nodes = corners[list(face)]
            key = tuple(sorted(nodes))
            seen[key] = None if key in seen else nodes
    return np.array([nodes for nodes in seen.values() if nodes is not None])


def show(scene, x, faces, values=None, scale=1.0, colour=BLUE, alpha=1.0, turn=np.eye(3), edges=0.25):
    """Draws a solid with shading, coloured by a nodal field or in one colour."""
    quads = x[faces] @ turn.T
    normals = np.cross(quads[:, 2] - quads[:, 0], quads[:, 3] - quads[:, 1])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    shade = 0.62 + 0.38 * np.clip(normals @ LIGHT, -0.4, 1)
    if values is None:
        base = np.tile(colors.to_rgb(colour), (len(faces), 1))
    else:
        base = cm.viridis(np.clip(values[faces].mean(axis=1) / scale, 0, 1))[:, :3]
    face = np.clip(base * shade[:, None], 0, 1)
    scene.add_collection3d(Poly3DCollection(quads, facecolors=np.c_[face, np.full(len(face), alpha)],
                                            edgecolors=(0.13, 0.19, 0.24, 0.5 * alpha), linewidths=edges, clip_on=False))


def flexible_panel():
    m = Solids("flexible_panel")
    figure, scene, plot = sheet((20, -60), wide=1.5)
    for shift, t in zip((0, 3.4, 6.8), (0.0, 52.0, m.t[-1])):
        k = int(np.argmin(abs(m.t - t)))
        offset = np.array([shift, 0, 0]) - m.place["hub"][k]
        corners = box(0.36, 0.36, 1.0) @ m.turn["hub"][k].T + m.place["hub"][k] + offset
        draw(scene, corners, INK, 1, 1.0)
        show(scene, m.nodes["panel"][k] + offset, m.faces["panel"])
        axis = m.spin["hub"][k] / np.linalg.norm(m.spin["hub"][k]) * 1.1
        draw(scene, [offset + m.place["hub"][k] - axis, offset + m.place["hub"][k] + axis], RED, 1, 1.4)
        scene.text(shift, 0, -1.75, f"{m.t[k]:.0f} s", ha="center", fontsize=8)
    fit(scene, (-1.0, -1.6, -1.6), (8.0, 1.6, 1.6), 1.9)
    body = np.einsum("kji,kj->ki", m.turn["hub"], m.spin["hub"])
    for i, (name, colour) in enumerate((("along the panel", GOLD), ("across it (largest inertia)", BLUE),
                                        ("long axis (smallest inertia)", RED))):
        plot.plot(m.t, body[:, i], color=colour, label=name, linewidth=0.8)
    plot.legend(frameon=False, fontsize=7.5, loc="upper right")
    label(plot, "angular velocity in body axes [rad/s]")
    return figure


def knee():
    intact, torn = Solids("knee"), Solids("knee", "cruciate=0")
    side = Solids("knee", "drawer=0", "varus=20 N")
    figure, scene, plot = sheet((12, -66), wide=1.7)
    for shift, m, name in ((0, intact, "drawer, intact"), (0.1, torn, "drawer, torn"), (0.2, side, "varus")):
        offset = np.array([shift, 0, 0])
        for solid, scale in (("inner_collateral", 1.2e6), ("outer_collateral", 1.2e6), ("pad", 2e5)):
            show(scene, m.nodes[solid][-1] + offset, m.faces[solid], m.stress[solid][-1], scale)
        condyle = box(0.044, 0.08, 0.03, (0, 0, 0.022)) + offset
        draw(scene, condyle, PALE, 1, 0.9)
        plateau = m.place["tibia"][-1] + box(0.044, 0.08, 0.03, (0, 0, 0.158)) @ m.turn["tibia"][-1].T + offset
        draw(scene, plateau, INK, 1, 0.9)
        scene.text(shift, 0, -0.056, name, ha="center", fontsize=8)
    fit(scene, (-0.03, -0.04, -0.045), (0.235, 0.04, 0.045), 1.45)
    bars = [("intact", intact), ("anterior\ntorn", torn)]
    forces = [[abs(m.probe("pad")["fx"][-1]), np.linalg.norm([m.probe("anterior")[k][-1] for k in ("fx", "fz")]),
               np.linalg.norm([m.probe("posterior")[k][-1] for k in ("fx", "fz")])] for _, m in bars]
    for i, (name, colour) in enumerate((("shear force of the pad", GREEN), ("anterior cruciate", RED),
                                        ("posterior cruciate", GOLD))):
        plot.bar(np.arange(2) + 0.22 * (i - 1), [f[i] for f in forces], 0.2, color=colour, label=name)
    for i, (_, m) in enumerate(bars):
        top = max(forces[i]) + 3
        plot.text(i, top, f"{1e3 * m.probe('tibia')['x'][-1]:.2f} mm forward", ha="center", fontsize=8)
    plot.set_axisbelow(True)
    plot.grid(axis="x", visible=False)
    plot.set_xticks(range(2), [name for name, _ in bars])
    plot.legend(frameon=False, fontsize=7.5, loc="upper left")
    plot.set_ylim(0, 1.35 * max(map(max, forces)))
    label(plot, "load sharing at 100 N drawer force [N]", "")
    return figure


def rubber_bushing():
    m = Solids("rubber_bushing", "analysis.load_steps=8", "radial=4 kN")
    figure, scene, plot = sheet((32, -62), wide=1.15)
    x, faces = m.nodes["rubber"][-1], m.faces["rubber"]
    show(scene, x, faces, m.stress["rubber"][-1], np.percentile(m.stress["rubber"][-1], 98))
    fit(scene, (-0.021, -0.021, -0.021), (0.022, 0.021, 0.021), 1.2)
    pin = m.probe("pin")
    plot.plot(1e3 * pin["x"], 4 * pin["t"], color=BLUE, marker="o", ms=3, label="radial, statics")
    ring = Solids("rubber_bushing", *DYNAMICS)
    away = ring.probe("pin")
    inset = plot.inset_axes([0.62, 0.12, 0.36, 0.34])
    inset.plot(1e3 * away["t"], 1e3 * away["x"], color=RED, linewidth=0.9)
    inset.set_title("sudden load: pin [mm] over t [ms]", fontsize=7.5)
    inset.tick_params(labelsize=7)
    label(plot, "radial force [kN]", "deflection of the pin [mm]")
    return figure


def side(scene, x, faces, values, scale, towards):
    """Draws the faces of a solid whose normals point in a direction, seen from there, in the x-z plane."""
    quads = x[faces]
    normals = np.cross(quads[:, 2] - quads[:, 0], quads[:, 3] - quads[:, 1])
    seen = normals @ towards > 0.5 * np.linalg.norm(normals, axis=1)
    base = cm.viridis(np.clip(values[faces].mean(axis=1) / scale, 0, 1))
    for quad, colour in zip(quads[seen], base[seen]):
        scene.fill(1e3 * quad[:, 0], 1e3 * quad[:, 2], facecolor=colour, edgecolor=INK, linewidth=0.25)


def ironing():
    m = Solids("ironing")
    figure, scene, plot = sheet(flat=True, wide=1.5)
    x, values, k = m.nodes["block"], m.stress["block"], len(m.t) - 3
    side(scene, x[k], m.faces["block"], values[k], np.percentile(values[k], 97), np.array([0, -1, 0]))
    a = np.linspace(0, 2 * np.pi, 90)
    scene.fill(20 * np.cos(a), 40.2 + 20 * np.sin(a), facecolor=PALE, edgecolor=INK, linewidth=0.8)
    label(scene, "von Mises stress while the block is pulled to the left", "x [mm]", "z [mm]")
    face = m.probe("face")
    plot.plot(face["t"], face["normal"], color=BLUE, label="normal")
    plot.plot(face["t"], np.hypot(face["ftx"], face["ftz"]), color=RED, label="friction")
    plot.plot(face["t"], 0.3 * face["normal"], color=GOLD, linestyle="--", linewidth=0.8, label="0.3 times normal")
    plot.legend(frameon=False, fontsize=7.5)
    label(plot, "force on the block [N]")
    return figure


def tyre_on_kerb():
    m = Solids("tyre_on_kerb")
    figure, scene, plot = sheet(flat=True, wide=2.2)
    x, values = m.nodes["tyre"], m.stress["tyre"]
    scene.fill([-250, 400, 400, 800, 800, 1300, 1300, -250], [0, 0, 30, 30, 0, 0, -25, -25], facecolor=PALE, edgecolor=INK,
               linewidth=0.8)
    a = np.linspace(0, 2 * np.pi, 60)
    for t in (0.0, 0.2, 0.42, 0.6):
        k = int(np.argmin(abs(m.t - t)))
        side(scene, x[k], m.faces["tyre"], values[k], 1.2e5, np.array([0, -1, 0]))
        centre = 1e3 * m.place["hub"][k]
        scene.fill(centre[0] + 120 * np.cos(a), centre[2] + 120 * np.sin(a), facecolor="white", edgecolor=INK, linewidth=0.6)
        spoke = m.turn["hub"][k] @ np.array([0.12, 0, 0]) * 1e3
        draw(scene, [[centre[0], centre[2]], [centre[0] + spoke[0], centre[2] + spoke[2]]], RED, 1, 1.2)
    label(scene, "0, 0.2, 0.42 and 0.6 s", "x [mm]", "z [mm]")
    hub, floor, kerb = m.probe("hub"), m.probe("floor"), m.probe("kerb")
    plot.plot(floor["t"], floor["normal"], color=BLUE, label="floor")
    plot.plot(kerb["t"], kerb["normal"], color=RED, label="kerb")
    plot.legend(frameon=False, fontsize=7.5)
    label(plot, "normal force [N]")
    return figure


def soft_rings():
    m = Solids("soft_rings")
    figure, scene, plot = sheet(flat=True, wide=1.6)
    for shift, t in ((0.0, 0.0), (0.085, 0.2), (0.175, 0.4)):
        k = int(np.argmin(abs(m.t - t)))
        for name in ("lower", "upper"):
            x = m.nodes[name][k][:, [0, 2, 1]] + np.array([shift, 0, 0])
            side(scene, x, m.faces[name], m.stress[name][k], 4e4, np.array([0, -1, 0]))
    label(scene, "0, 0.2 and 0.4 s", "x [mm]", "y [mm]")
    face, hand = m.probe("face"), m.probe("hand")
    plot.plot(1e3 * face["t"], face["normal"], color=BLUE, label="normal contact force")
    plot.plot(1e3 * hand["t"], -hand["fy"], color=RED, linewidth=0.8, label="driving force")
    plot.legend(frameon=False, fontsize=7.5)
    label(plot, "force [N]", "t [ms]")
    return figure


DYNAMICS = ("analysis.type=dynamics", "analysis.duration=40 ms", "analysis.step=0.25 ms")
PICTURES = {"flexible_panel": flexible_panel, "knee": knee, "rubber_bushing": rubber_bushing, "ironing": ironing,
            "tyre_on_kerb": tyre_on_kerb, "soft_rings": soft_rings}


def main():
    for name in sys.argv[1:] or PICTURES:
        figure = PICTURES[name]()
        save(figure, ROOT / "examples" / name / "picture.png")


if __name__ == "__main__":
    main()
