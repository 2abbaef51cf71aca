# SPDX-License-Identifier: Apache-2.0
"""Helpers for the pictures of the examples: runs, outlines, figures. Needs numpy, matplotlib and h5py."""
import pathlib
import sys

import h5py
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "examples"))
import support  # noqa: E402

INK, BLUE, RED, GOLD, GREEN, PALE = "#22303c", "#2f6db3", "#c8452f", "#d99a1c", "#3d8a55", "#b9c4cd"
plt.rcParams.update({"font.size": 9, "axes.edgecolor": PALE, "axes.labelcolor": INK, "text.color": INK,
                     "xtick.color": INK, "ytick.color": INK, "axes.spines.top": False, "axes.spines.right": False,
                     "axes.grid": True, "grid.color": "#e9eef1", "lines.linewidth": 1.2, "axes.titlesize": 10})


class Motion:
    """Motion of the bodies and columns of the probes of a run."""

    def __init__(self, name, *settings, model="model.yaml"):
        self.run = support.Run(ROOT / "examples" / name / model, *settings)
        with h5py.File(self.run.folder / "results.h5") as file:
            self.t = file["time"][:]
            names = [n.decode() for n in file["packed/bodies/names"][:]]
            count = len(self.t)
            place, turn = file["packed/bodies/position"][:count], file["packed/bodies/orientation"][:count]
            self.cables = {n: cable["position"][:count] for n, cable in file.get("cables", {}).items()}
            self.beams = {n: beam["nodes/position"][:count] for n, beam in file.get("beams", {}).items()}
        self.place = {n: place[:, i] for i, n in enumerate(names)}
        self.turn = {n: rotation(turn[:, i]) for i, n in enumerate(names)}

    def points(self, body, outline, frame):
        """Points of a body (relative to its centre of mass, body axes) in the ground frame, at one frame of the results."""
        return self.place[body][frame] + np.asarray(outline, float) @ self.turn[body][frame].T

    def path(self, body, point):
        return self.place[body] + np.einsum("kij,j->ki", self.turn[body], point)

    def probe(self, name):
        return {key: np.array(column) for key, column in self.run.probe(name).items()}


def rotation(q):
    """Rotation matrices of quaternions (w, x, y, z)."""
    w, x, y, z = q.T
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                     [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                     [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]]).transpose(2, 0, 1)


def box(x, y, z, centre=(0, 0, 0)):
    """The edges of a box as one polyline."""
    corners = np.array([[-1, -1, -1], [1, -1, -1], [1, 1, -1], [-1, 1, -1],
                        [-1, -1, 1], [1, -1, 1], [1, 1, 1], [-1, 1, 1]])
    order = [0, 1, 2, 3, 0, 4, 5, 1, 5, 6, 2, 6, 7, 3, 7, 4]
    return corners[order] * np.array([x, y, z]) / 2 + np.array(centre)


def circle(radius, axis=2, at=0.0, count=49):
    """A circle about an axis of the body."""
    a = np.linspace(0, 2 * np.pi, count)
    out = np.zeros((count, 3))
    out[:, axis], out[:, (axis + 1) % 3], out[:, (axis + 2) % 3] = at, radius * np.cos(a), radius * np.sin(a)
    return out


def tube(radius, length, axis, centre=0.0):
    """Outline of a cylinder: two circles and four lines between them."""
    a, b = circle(radius, axis, centre - length / 2), circle(radius, axis, centre + length / 2)
    lines = [a, b]
    lines += [np.array([a[i], b[i]]) for i in range(0, 48, 12)]
    return lines


def sheet(view=None, wide=1.25, flat=False, size=(9.6, 4.1)):
    """A figure with a scene on the left and a plot on the right."""
    figure = plt.figure(figsize=size)
    grid = figure.add_gridspec(1, 2, width_ratios=[wide, 1], left=0.075 if flat else 0.0,
                               right=0.98, bottom=0.13, top=0.92, wspace=0.16)
    scene = figure.add_subplot(grid[0], projection=None if flat else "3d")
    if flat:
        scene.set_aspect("equal")
    else:
        scene.view_init(*(view or (22, -58)))
        scene.set_axis_off()
        scene.set_position([0.0, 0.0, wide / (1 + wide), 1.0])
        scene.set_proj_type("ortho")
    return figure, scene, figure.add_subplot(grid[1])


def fit(scene, low, high, zoom=1.25):
    """Equal scales within the box from low to high."""
    low, high = np.array(low, float), np.array(high, float)
    scene.set_xlim(low[0], high[0]), scene.set_ylim(low[1], high[1]), scene.set_zlim(low[2], high[2])
    scene.set_box_aspect(high - low, zoom=zoom)


def draw(scene, points, colour=INK, alpha=1.0, width=1.0, **more):
    points = np.asarray(points)
    columns = points.T if hasattr(scene, "get_zlim") else points.T[:2]
    scene.plot(*columns, color=colour, alpha=alpha, linewidth=width, solid_capstyle="round", clip_on=False, **more)


def frames(motion, begin, end, count):
    return [int(np.argmin(abs(motion.t - t))) for t in np.linspace(begin, end, count)]


def fades(items):
    """Pairs of an item and its opacity, which increases to 1 for the last."""
    return zip(items, np.linspace(0.15, 1.0, len(items)) ** 1.3)


def label(plot, title, x="t [s]", y=""):
    plot.set_title(title, loc="left"), plot.set_xlabel(x), plot.set_ylabel(y)


def save(figure, path, dpi=110, trim="tight"):
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=dpi, metadata={"Software": None}, bbox_inches=trim, pad_inches=0.08)
    plt.close(figure)
    print(f"{path.relative_to(ROOT)}  {path.stat().st_size / 1000:.0f} KB")
