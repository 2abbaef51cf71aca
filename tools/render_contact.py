# SPDX-License-Identifier: Apache-2.0
"""Pictures of the examples with contact; tools/render_example.py makes them."""
import numpy as np

EDGE = np.array([[-1, -1, -1], [1, -1, -1], [1, 1, -1], [-1, 1, -1], [-1, -1, 1], [1, -1, 1], [1, 1, 1], [-1, 1, 1]])


def balls(scene, centres, radius, colours, alpha=1.0):
    """Circles in the plane of the picture, x to the right and z up."""
    from matplotlib.patches import Circle
    for (x, _, z), colour in zip(centres, colours):
        scene.add_patch(Circle((x, z), radius, facecolor=colour, alpha=alpha, edgecolor="white", linewidth=0.6))


def polygon(scene, points, colour, alpha=1.0):
    from matplotlib.patches import Polygon
    scene.add_patch(Polygon(np.asarray(points)[:, [0, 2]], facecolor=colour, alpha=alpha, edgecolor="white", linewidth=0.6))


def side(motion, body, x, z, frame):
    """The outline of a box seen along y."""
    return motion.points(body, [[-x / 2, 0, -z / 2], [x / 2, 0, -z / 2], [x / 2, 0, z / 2], [-x / 2, 0, z / 2]], frame)


def flat(scene, low, high):
    scene.set_xlim(low[0], high[0]), scene.set_ylim(low[1], high[1]), scene.grid(False)
    scene.set_xlabel("x [m]"), scene.set_ylabel("z [m]")


def triangles_of(file):
    numbers = [list(map(float, line.split()[1:])) for line in open(file) if line.strip().startswith("vertex")]
    return np.array(numbers).reshape(-1, 3, 3) * 1e-3


class Pictures:
    """One function for each example; `r` is the module drawing."""

    def __init__(self, r):
        self.r = r

    def bouncing_ball(self):
        r, m = self.r, self.r.Motion("bouncing_ball")
        figure, scene, plot = r.sheet(flat=True, wide=1.1)
        names, colours = {"elastic": "e = 1", "lively": "e = 0.8", "dull": "e = 0.5"}, (r.BLUE, r.GOLD, r.RED)
        scene.axhline(0, color=r.INK, linewidth=1.5)
        for k, alpha in r.fades(r.frames(m, 0.0, 0.9, 14)):
            balls(scene, [m.place[n][k] for n in names], 0.05, colours, alpha)
        flat(scene, (-0.25, -0.05), (1.05, 1.2))
        for n, c in zip(names, colours):
            p = m.probe(n)
            plot.plot(p["t"], p["z"], color=c, label=names[n])
        plot.set_xlim(0, 6), plot.set_ylim(0, 1.2), plot.legend(frameon=False, loc="upper right", ncol=3)
        r.label(plot, "height of the centre", y="z [m]")
        return figure

    def incline(self):
        r, m = self.r, self.r.Motion("incline")
        figure, scene, plot = r.sheet((18, -62), wide=1.3)
        c, s = np.cos(np.pi / 6), np.sin(np.pi / 6)
        for y in np.linspace(-0.5, 1.5, 9):
            r.draw(scene, [[-0.6 * c, y, 0.6 * s], [1.9 * c, y, -1.9 * s]], r.PALE, width=0.7)
        for a in np.linspace(-0.6, 1.9, 11):
            r.draw(scene, [[a * c, -0.5, -a * s], [a * c, 1.5, -a * s]], r.PALE, width=0.7)
        for k, alpha in r.fades(r.frames(m, 0.0, 1.2, 3)):
            r.draw(scene, m.points("slides", r.box(0.4, 0.4, 0.2), k), r.RED, alpha)
        r.draw(scene, m.points("holds", r.box(0.4, 0.4, 0.2), -1), r.BLUE)
        r.fit(scene, (-0.6, -0.5, -1.0), (1.7, 1.5, 0.4), 1.2)
        for name, colour in (("holds", r.BLUE), ("slides", r.RED)):
            p = m.probe(name)
            displacement = np.linalg.norm(np.array([p[c] - p[c][0] for c in "xyz"]), axis=0)
            label = {"holds": "mu = 0.6", "slides": "mu = 0.5"}[name]
            plot.semilogy(p["t"][1:], displacement[1:], color=colour, label=label)
        plot.legend(frameon=False, loc="center right")
        r.label(plot, "displacement from the start", y="[m]")
        return figure

    def newtons_cradle(self):
        r, m = self.r, self.r.Motion("newtons_cradle")
        figure, scene, plot = r.sheet(flat=True, wide=1.2)
        colours = (r.BLUE, r.PALE, r.PALE, r.PALE, r.RED)
        last = int(np.argmax(np.where(m.t < 1.2, m.place["b4"][:, 2], -1)))
        for k, alpha in ((0, 0.35), (last, 1.0)):
            for i in range(5):
                x, _, z = m.place[f"b{i}"][k]
                scene.plot([0.052 * i, x], [0.5, z], color=r.INK, alpha=alpha, linewidth=0.7)
            balls(scene, [m.place[f"b{i}"][k] for i in range(5)], 0.025, colours, alpha)
        scene.plot([-0.05, 0.26], [0.5, 0.5], color=r.INK, linewidth=2)
        flat(scene, (-0.32, -0.06), (0.53, 0.54))
        for i, colour, start in ((0, r.BLUE, -30), (2, r.PALE, 0), (4, r.RED, 0)):
            p = m.probe(f"h{i}")
            plot.plot(p["t"], np.degrees(p["rz"]) + start, color=colour, label=f"ball {i + 1}")
        plot.legend(frameon=False, ncol=3, loc="upper center")
        plot.set_ylim(-35, 45)
        r.label(plot, "rod angles", y="[deg]")
        return figure

    def tippe_top(self):
        r, m = self.r, self.r.Motion("tippe_top")
        figure, scene, plot = r.sheet((14, -65), wide=1.7)
        for n, k in enumerate(r.frames(m, 0.0, 1.5, 6)):
            shift = np.array([0.042 * n - m.place["top"][k][0], -m.place["top"][k][1], 0])
            for z in np.linspace(-0.8, 0.8, 5):
                ring = r.circle(0.015 * np.sqrt(1 - z * z), 2, 0.0045 + 0.015 * z)
                r.draw(scene, m.points("top", ring, k) + shift, r.BLUE if z < 0 else r.RED, 0.8)
            r.draw(scene, m.points("top", [[0, 0, -0.0105], [0, 0, 0.026]], k) + shift, r.INK, width=1.4)
        r.fit(scene, (-0.02, -0.02, 0), (0.23, 0.02, 0.04), 1.55)
        tilt = np.degrees(np.arccos(np.clip(m.turn["top"][:, 2, 2], -1, 1)))
        plot.plot(m.t, tilt, color=r.BLUE)
        plot.axhline(90, color=r.PALE)
        r.label(plot, "tilt of the axis", y="[deg]")
        return figure

    def rattleback(self):
        r = self.r
        m, other = r.Motion("rattleback"), r.Motion("rattleback", "spin=5")
        figure, scene, plot = r.sheet((30, -60), wide=1.2)
        k = 0
        for z in np.linspace(-0.95, 0.0, 7):
            ring = r.circle(np.sqrt(1 - z * z), 2, z) * [0.2, 0.03, 0.02] + [0, 0, 0.01]
            r.draw(scene, m.points("stone", ring, k), r.BLUE)
        for a in np.linspace(0, 2 * np.pi, 24):
            z = np.linspace(-1, 0, 12)
            line = np.column_stack([np.sqrt(1 - z * z) * np.cos(a), np.sqrt(1 - z * z) * np.sin(a), z]) * [0.2, 0.03, 0.02]
            r.draw(scene, m.points("stone", line + [0, 0, 0.01], k), r.BLUE, 0.5, 0.6)
        r.fit(scene, (-0.2, -0.06, -0.01), (0.2, 0.06, 0.03), 1.3)
        for motion, colour, label in ((m, r.RED, "started in the unstable direction"), (other, r.BLUE, "started in the stable direction")):
            omega = np.array(self.r.support.angular_velocity(motion.run, "origin", ("x_tip", "y_tip", "z_tip")))
            plot.plot(motion.probe("origin")["t"], omega[:, 2], color=colour, label=label)
        plot.axhline(0, color=r.PALE), plot.legend(frameon=False, loc="lower right")
        r.label(plot, "angular velocity about the vertical", y="[rad/s]")
        return figure

    def stack(self):
        r, m = self.r, self.r.Motion("stack", "analysis.duration=4 s", "output.every=20 ms")
        figure, scene, plot = r.sheet(flat=True, wide=0.5)
        scene.axhline(0, color=r.INK, linewidth=1.5)
        for i in range(10):
            w = 0.2 * 0.98**i
            polygon(scene, side(m, f"box_{i}", w, 0.1, -1), r.BLUE if i % 2 else r.INK, 0.8)
        flat(scene, (-0.25, -0.05), (0.25, 1.05))
        first = int(np.argmin(abs(m.t - 1.0)))
        for i, colour in ((0, r.PALE), (4, r.GOLD), (9, r.RED)):
            displacement = np.linalg.norm(m.place[f"box_{i}"] - m.place[f"box_{i}"][first], axis=1)
            plot.semilogy(m.t[1:], np.maximum(displacement[1:], 1e-17), color=colour, label=f"box {i + 1}")
        plot.legend(frameon=False), plot.set_ylim(1e-17, 1e-3)
        r.label(plot, "displacement since t = 1 s", y="[m]")
        return figure

    def card_house(self):
        r = self.r
        stands, falls = r.Motion("card_house"), r.Motion("card_house", "margin=0.9", "analysis.duration=1.5 s")
        figure, scene, plot = r.sheet(flat=True, wide=1.4)
        scene.plot([-0.8, 2.9], [0, 0], color=r.INK, linewidth=1.5)
        for name in ("left", "right"):
            polygon(scene, side(stands, name, 0.02, 1.0, -1), r.BLUE)
            for k, alpha in r.fades(r.frames(falls, 0.0, 1.2, 5)):
                polygon(scene, side(falls, name, 0.02, 1.0, k) + [1.8, 0, 0], r.RED, alpha)
        flat(scene, (-0.8, -0.1), (3.0, 1.1))
        plot.plot(stands.t, stands.place["right"][:, 2], color=r.BLUE, label="friction 10 % above the limit")
        plot.plot(falls.t, falls.place["right"][:, 2], color=r.RED, label="friction 10 % below the limit")
        plot.legend(frameon=False, loc="center right"), plot.set_ylim(0, 0.6)
        r.label(plot, "height of a plate's centre", y="[m]")
        return figure

    def rolling_coin(self):
        r, m = self.r, self.r.Motion("rolling_coin")
        figure, scene, plot = r.sheet((28, -50), wide=1.2)
        for k, alpha in r.fades(r.frames(m, 0.0, 0.2, 6)):
            r.draw(scene, m.points("coin", r.circle(0.01, 0), k), r.BLUE, alpha)
        r.draw(scene, m.place["coin"], r.RED, width=0.9)
        foot = m.place["coin"] * [1, 1, 0]
        r.draw(scene, foot, r.PALE, width=0.7)
        r.fit(scene, (-0.009, -0.009, 0), (0.009, 0.009, 0.02), 1.1)
        plot.plot(m.t, 1e3 * m.place["coin"][:, 2], color=r.BLUE)
        r.label(plot, "height of the centre", y="[mm]")
        return figure

    def spheres_in_a_bin(self):
        r, m = self.r, self.r.Motion("spheres_in_a_bin")
        figure, scene, plot = r.sheet(flat=True, wide=1.25)
        half, n = 0.25 * 5 / 2, 100
        for shift, k in ((0, 0), (1.5, -1)):
            order = sorted(range(n), key=lambda i: -m.place[f"b{i}"][k][1])
            shades = [r.plt.cm.Blues(0.35 + 0.5 * j / n) for j in range(n)]
            balls(scene, [m.place[f"b{i}"][k] + [shift, 0, 0] for i in order], 0.1, shades)
            scene.plot(np.array([-half, -half, half, half]) + shift, [1.5, 0, 0, 1.5], color=r.INK, linewidth=1.5)
        flat(scene, (-0.75, -0.05), (2.25, 1.55))
        with r.h5py.File(m.run.folder / "results.h5") as file:
            for name, colour in (("kinetic", r.BLUE), ("lost_in_impacts", r.RED), ("lost_by_friction", r.GOLD)):
                plot.plot(m.t, file[f"energy/{name}"][: len(m.t)], color=colour, label=name.replace("_", " "))
        plot.legend(frameon=False, loc="lower right", bbox_to_anchor=(1, 0.2))
        r.label(plot, "energy", y="[J]")
        return figure

    def gear_pair(self):
        r, m = self.r, self.r.Motion("gear_pair", "analysis.duration=0.15 s")
        figure, scene, plot = r.sheet(flat=True, wide=1.35)
        from matplotlib.collections import PolyCollection
        for name, colour in (("pinion", r.RED), ("wheel", r.BLUE)):
            faces = triangles_of(r.ROOT / "examples/gear_pair" / f"{name}.stl")
            faces = faces[np.all(faces[:, :, 2] > 0, axis=1)]
            x = m.points(name, faces.reshape(-1, 3), -1).reshape(-1, 3, 3)[:, :, :2]
            scene.add_collection(PolyCollection(x, facecolor=colour, edgecolor=colour, linewidth=0.4))
        flat(scene, (-0.07, -0.1), (0.23, 0.1))
        scene.set_ylabel("y [m]")
        for name, colour in (("pinion", r.RED), ("wheel", r.BLUE)):
            p = m.probe(name)
            plot.plot(p["t"], abs(p["rate rz"]), color=colour, label=name)
        p = m.probe("teeth")
        force = plot.twinx()
        force.plot(p["t"], p["normal"], color=r.PALE, linewidth=0.5, zorder=0), force.set_ylim(0, None)
        force.set_ylabel("normal force [N]"), force.grid(False)
        plot.legend(frameon=False, loc="upper right")
        r.label(plot, "angular velocities of the gears", y="[rad/s]")
        return figure

    def crossed_lines(self):
        r, m = self.r, self.r.Motion("crossed_lines")
        figure, scene, plot = r.sheet(flat=True, wide=1.4)
        for name, along, colour, pieces in (("lower", 0, r.BLUE, 20), ("upper", 1, r.RED, 40)):
            x = np.array([m.place[f"{name}.{k}"][-1] for k in range(pieces + 1)])
            scene.plot(x[:, along], 1e3 * x[:, 2], color=colour, label=name, marker="o", ms=2)
        scene.set_aspect("auto"), scene.legend(frameon=False)
        r.label(scene, "both cables, each seen from the side", "position along the cable [m]", "z [mm]")
        masses = np.linspace(0.2, 1.0, 5)
        for tight, colour in (("1.99 m", r.BLUE), ("1.995 m", r.GOLD)):
            runs = [r.support.Run(r.ROOT / "examples/crossed_lines/model.yaml", f"heavy={mass} kg/m", f"tight={tight}")
                    for mass in masses]
            plot.plot(masses, [run.probe("press")["normal"][-1] for run in runs], "o-", color=colour, ms=4, label=f"lower cable of {tight}")
        plot.legend(frameon=False)
        r.label(plot, "contact force [N], by free length", "mass of the upper cable [kg/m]")
        return figure
