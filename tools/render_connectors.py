"""Pictures of the examples with gears and bushings, for render_example.py."""
import numpy as np


def planetary_gearbox(tools):
    m = tools.Motion("planetary_gearbox")
    figure, scene, plot = tools.sheet(flat=True, wide=1.0)
    k = tools.frames(m, 0.3, 0.3, 1)[0]
    wheels = {"sun": (0.1, tools.GOLD), "planet_1": (0.1, tools.BLUE), "planet_2": (0.1, tools.BLUE), "planet_3": (0.1, tools.BLUE)}
    for body, (radius, colour) in wheels.items():
        rim = m.points(body, tools.circle(radius), k)
        spoke = m.points(body, [[-radius, 0, 0], [radius, 0, 0]], k)
        scene.plot(rim[:, 0], rim[:, 1], color=colour, lw=2)
        scene.plot(spoke[:, 0], spoke[:, 1], color=colour, lw=1)
    ring = tools.circle(0.3)
    scene.plot(ring[:, 0], ring[:, 1], color=tools.INK, lw=3)
    arms = np.array([m.place[f"planet_{i}"][k] for i in (1, 2, 3)])
    for arm in arms:
        scene.plot([0, arm[0]], [0, arm[1]], color=tools.RED, lw=2)
    tools.label(scene, "sun, three planets on their carrier, ring", "x [m]", "y [m]")
    motor, teeth = m.probe("motor"), m.probe("teeth_1")
    plot.plot(motor["t"], motor["mz"], color=tools.RED, label="moment of the motor [N m]")
    plot.plot(teeth["t"], -teeth["effort_1"], color=tools.BLUE, label="of one planet on the sun [N m]")
    plot.legend(frameon=False)
    tools.label(plot, "half a second to full speed")
    return figure


def suspension_corner(tools):
    m = tools.Motion("suspension_corner", "variables.stroke=20 mm")
    figure, scene, plot = tools.sheet(flat=True, wide=0.9)
    for k, alpha in tools.fades(tools.frames(m, 4.0, 4.3, 3)):
        for body, line, colour, width in (
                ("lower_arm", [[0, -0.2, 0], [0, 0.2, 0]], tools.BLUE, 3), ("upper_arm", [[0, -0.2, 0], [0, 0.2, 0]], tools.BLUE, 3),
                ("wheel", [[0, -0.05, -0.1], [0, -0.05, 0.1]], tools.INK, 3),
                ("chassis", [[0, 0.3, -0.5], [0, 0.3, 0.05], [0, 0.5, 0.05]], tools.PALE, 5),
                ("platform", [[0, -0.15, -0.02], [0, 0.15, -0.02]], tools.GOLD, 4)):
            p = m.points(body, line, k)
            scene.plot(p[:, 1], p[:, 2], color=colour, lw=width, alpha=alpha)
        tyre = m.points("wheel", tools.circle(0.3, 0), k)
        scene.plot(0.75 + 0.25 * (tyre[:, 1] - 0.75), tyre[:, 2], color=tools.INK, lw=1.5, alpha=alpha)
        top, bottom = m.points("chassis", [[0, 0.5, 0]], k)[0], m.points("lower_arm", [[0, 0, 0]], k)[0]
        scene.plot([top[1], bottom[1]], [top[2], bottom[2]], color=tools.RED, lw=2, alpha=alpha)
    tools.label(scene, "arms in bushings, strut, tyre on its platform", "y [m]", "z [m]")
    for body, colour in (("chassis", tools.BLUE), ("wheel", tools.INK)):
        z = m.probe(body)["z"]
        plot.plot(m.t, 1e3 * (z - z[0]), color=colour, label=body)
    shaker = m.probe("shaker")
    plot.plot(shaker["t"], 1e3 * shaker["displacement"], color=tools.GOLD, label="shaker")
    plot.legend(frameon=False)
    tools.label(plot, "heave [mm], 20 mm at 1.5 Hz")
    return figure


def shaking_table(tools):
    m = tools.Motion("shaking_table")
    figure, scene, plot = tools.sheet(flat=True, wide=0.9)
    for k, alpha in tools.fades(tools.frames(m, 0.5, 0.75, 3)):
        for body, (half, up), colour in (("table", (0.8, 0.05), tools.INK), ("slips", (0.15, 0.05), tools.RED), ("rides", (0.15, 0.05), tools.BLUE)):
            if body == "rides":
                continue
            corners = m.points(body, [[-half, 0, -up], [half, 0, -up], [half, 0, up], [-half, 0, up], [-half, 0, -up]], k)
            scene.plot(corners[:, 0], corners[:, 2], color=colour, lw=2, alpha=alpha)
    tools.label(scene, "the table and the crate that slips, a quarter of a second", "x [m]", "z [m]")
    for body, colour, name in (("table", tools.INK, "table, mu 0.9 on it"), ("slips", tools.RED, "mu 0.4")):
        probe = m.probe(body)
        plot.plot(probe["t"], probe["vx"], color=colour, label=name)
    plot.legend(frameon=False, loc="lower center", bbox_to_anchor=(0.6, 1), ncol=2)
    tools.label(plot, "velocities", "t [s]", "[m/s]")
    return figure
