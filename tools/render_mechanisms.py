# SPDX-License-Identifier: Apache-2.0
"""Pictures of the examples of rigid mechanisms and beams; tools/render_example.py makes them."""
import numpy as np

from drawing import BLUE, GOLD, GREEN, INK, PALE, RED, Motion, box, draw, fades, fit, frames, label, sheet, support, tube


def tumbling_body():
    m = Motion("tumbling_body")
    figure, scene, plot = sheet((24, -72), wide=1.6)
    c = 0.05 / 2 * 5 / 13
    parts = tube(0.005, 0.08, 1) + tube(0.005, 0.05, 0, 0.025)
    picks = frames(m, 1.1, 3.6, 9)
    for n, k in enumerate(picks):
        shift = np.array([n * 0.072, 0, 0])
        for part in parts:
            draw(scene, m.points("handle", part - [c, 0, 0], k) + shift, BLUE if n % 2 else INK, 1, 0.9)
        end = m.points("handle", [[0.05 - c, 0, 0]], k) + shift
        draw(scene, end, RED, marker="o", ms=4)
    fit(scene, (-0.04, -0.05, -0.05), (0.62, 0.05, 0.05), 2.05)
    scene.set_title("the handle every 0.31 s, side by side", loc="center", y=0.84)
    omega = np.array(support.angular_velocity(m.run, "origin", ("x_tip", "y_tip", "z_tip")))
    body = np.einsum("kji,kj->ki", m.turn["handle"], omega)
    for i, (name, colour) in enumerate((("about the shaft", RED), ("about the bar", PALE), ("about the normal", BLUE))):
        plot.plot(m.t, body[:, i], color=colour, label=name)
    plot.legend(frameon=False, fontsize=7.5, loc="lower center", ncol=3, columnspacing=0.8, handlelength=1.2)
    plot.set_ylim(-16, 14)
    label(plot, "angular velocity in body axes [rad/s]")
    return figure


def heavy_top():
    m = Motion("heavy_top", "output.every=2 ms")
    figure, scene, plot = sheet((18, -52))
    path = m.path("top", (0, 0, 0))
    scene.scatter(*path.T, c=m.t, cmap="viridis", s=1.6)
    for k, alpha in fades(frames(m, 0.0, 0.2, 4)):
        draw(scene, np.array([[0, 0, 0], path[k]]), INK, alpha, 1.6)
        for part in tube(0.25, 0.02, 1):
            draw(scene, m.points("top", part, k), RED, alpha, 0.9)
    scene.scatter([0], [0], [0], color=INK, s=18)
    fit(scene, (-1, -1, -1), (1, 1, 0.25), 1.45)
    plot.plot(m.t, path[:, 2], color=BLUE)
    label(plot, "height of the centre of mass [m]")
    return figure


def double_pendulum():
    m = Motion("double_pendulum", "output.every=5 ms")
    figure, scene, plot = sheet(flat=True, wide=0.95)
    tip, elbow = m.path("lower", (0.5, 0, 0)), m.path("upper", (0.5, 0, 0))
    scene.scatter(tip[:, 0], tip[:, 2], c=m.t, cmap="plasma", s=1.5)
    for k, alpha in fades(frames(m, 0, 0.9, 8)):
        scene.plot([0, elbow[k, 0], tip[k, 0]], [0, elbow[k, 2], tip[k, 2]], "-o", color=INK, alpha=alpha, ms=3, lw=1.5)
    label(scene, "path of the tip; bars during the first swing", "x [m]", "z [m]")
    plot.plot(m.t, np.degrees(m.probe("shoulder")["rz"]), color=BLUE, label="shoulder")
    plot.plot(m.t, np.degrees(m.probe("elbow")["rz"]), color=RED, label="elbow")
    plot.legend(frameon=False)
    label(plot, "joint angles [deg]")
    return figure


def spatial_slider_crank():
    m = Motion("spatial_slider_crank", "output.every=2 ms")
    figure, scene, plot = sheet((24, -50))
    A, k_all = np.array([0, 0.1, 0.12]), frames(m, 0, 0.5, 7)
    B, C = m.path("crank", (0, 0, 0.04)), m.place["slider"]
    draw(scene, B[m.t < 0.6], PALE, 1, 1.5)
    draw(scene, [[0.14, 0, 0], [0.32, 0, 0]], PALE, 1, 4)
    for k, alpha in fades(k_all):
        draw(scene, [A, B[k]], RED, alpha, 3)
        draw(scene, [B[k], C[k]], INK, alpha, 1.8)
        draw(scene, m.points("slider", box(0.03, 0.02, 0.02), k), BLUE, alpha, 1)
        scene.scatter(*np.array([B[k], C[k]]).T, color=INK, s=8, alpha=alpha)
    fit(scene, (-0.02, -0.03, -0.02), (0.32, 0.2, 0.21), 1.4)
    plot.plot(m.t, m.probe("slider")["x"] if len(m.t) == len(m.probe("slider")["x"]) else C[:, 0], color=BLUE)
    label(plot, "position of the slider [m]")
    return figure


def crank_rocker():
    m = Motion("crank_rocker", "output.every=5 ms")
    figure, scene, plot = sheet(flat=True, wide=0.95)
    B, C = m.path("crank_arm", (0.05, 0, 0)), m.path("rocker_arm", (0.125, 0, 0))
    scene.plot(B[:, 0], B[:, 2], color=PALE)
    scene.plot(C[:, 0], C[:, 2], color=GOLD, lw=2)
    for k, alpha in fades(frames(m, 0.55, 1.05, 9)):
        scene.plot([0, B[k, 0]], [0, B[k, 2]], "-", color=RED, alpha=alpha, lw=2.5)
        scene.plot([B[k, 0], C[k, 0]], [B[k, 2], C[k, 2]], "-o", color=INK, alpha=alpha, ms=3, lw=1.5)
        scene.plot([C[k, 0], 0.4], [C[k, 2], 0], "-", color=BLUE, alpha=alpha, lw=2)
    scene.plot([0, 0.4], [0, 0], "o", color=INK, ms=6)
    label(scene, "one turn of the crank at full speed", "x [m]", "z [m]")
    motor = m.probe("motor")
    plot.plot(motor["t"], -np.array(motor["my"]), color=RED, label="motor torque [N m]")
    plot.plot(motor["t"], np.array(motor["rate"]) / 10, color=BLUE, label="motor speed [10 rad/s]")
    plot.legend(frameon=False, loc="lower left")
    plot.set_ylim(-1.8, 1.3)
    label(plot, "full speed after 0.5 s")
    return figure


def n_four_bar():
    m = Motion("n_four_bar")
    figure, scene, plot = sheet(flat=True, wide=1.5)
    picks = frames(m, 0, 0.86, 9)
    for k, alpha in fades(picks):
        tops = []
        for i in range(3):
            ends = m.points(f"upright_{i}", [[0, -0.5, 0], [0, 0.5, 0]], k)
            draw(scene, ends, BLUE, alpha, 2)
            tops.append(ends[1])
        draw(scene, tops, RED, alpha, 2, marker="o", ms=3)
    scene.plot([0, 1, 2], [0, 0, 0], "o", color=INK, ms=6)
    label(scene, "from upright through the position with all bars in one line", "x [m]", "y [m]")
    B0 = m.probe("B0")
    plot.plot(B0["t"], B0["x"], color=BLUE, label="x")
    plot.plot(B0["t"], B0["y"], color=RED, label="y")
    plot.set_xlim(0, 6)
    plot.legend(frameon=False, loc="lower right", ncol=2)
    plot.set_ylim(-1.35, 1.1)
    label(plot, "position of B0, top of the first upright [m]")
    return figure


PLATES = {  # outlines relative to the reference points of the plates; centres of mass are subtracted below
    "K1": ((0.00092, 0), [(0, 0), (0.007, 0)], RED), "K2": ((-0.0115, 0), [(0, 0), (-0.028, 0)], GOLD),
    "K3": ((0.01043, -0.01874), [(0, 0), (0, -0.035), (0.02, -0.018), (0, 0)], BLUE),
    "K4": ((0, -0.00579), [(0, 0), (0, -0.02)], GREEN),
    "K5": ((0.02308, 0.00916), [(0, 0), (0.02308, 0.00916), (0.04, 0), (0, 0)], INK),
    "K6": ((0.00579, 0), [(0, 0), (0.02, 0)], GREEN),
    "K7": ((-0.00449, -0.01228), [(0, 0), (-0.00449, -0.01228), (0, -0.04), (0, 0)], INK)}


def andrews_squeezer():
    m = Motion("andrews_squeezer", "output.every=0.05 ms")
    figure, scene, plot = sheet(flat=True, wide=1.05)
    for k, alpha in fades(frames(m, 0, 0.0118, 6)):
        for name, (com, outline, colour) in PLATES.items():
            points = np.array([(x - com[0], y - com[1], 0) for x, y in outline])
            draw(scene, 1e3 * m.points(name, points, k), colour, alpha, 1.6, marker=".", ms=4)
    E = 1e3 * m.path("K3", (0 - 0.01043, -0.035 + 0.01874, 0))
    draw(scene, E, PALE, 1, 0.8)
    scene.plot([0, -69.34, -36.35, 14], [0, -2.27, 32.73, 72], "^", color=INK, ms=6)
    D = 1e3 * m.path("K3", (0.02 - 0.01043, -0.018 + 0.01874, 0))
    draw(scene, [(14, 72, 0), D[-1]], PALE, 1, 1, linestyle=":")
    label(scene, "six instants of the first 12 ms", "x [mm]", "y [mm]")
    for name, start, colour in (("gamma", 0.45527981916307037, BLUE), ("phi", 0.22266839016588588, GREEN),
                                ("delta", 0.48736497954384256, INK)):
        p = m.probe(name)
        plot.plot(1e3 * p["t"], p["rz"] + start, color=colour, label=name)
    plot.legend(frameon=False, ncol=3, loc="lower left", fontsize=8)
    plot.set_ylim(-1.05, 0.75)
    label(plot, "angles [rad]", "t [ms]")
    return figure


def bricard():
    m = Motion("bricard")
    figure, scene, plot = sheet((28, -62))
    ends = [[(-0.5, 0, 0), (0.5, 0, 0)], [(0, 0.5, 0), (0, -0.5, 0)], [(0, 0, -0.5), (0, 0, 0.5)],
            [(0.5, 0, 0), (-0.5, 0, 0)], [(0, -0.5, 0), (0, 0.5, 0)]]
    swap = [0, 2, 1]  # y is up
    for k, alpha in fades(frames(m, 0, 1.25, 5)):
        for i, (pair, colour) in enumerate(zip(ends, (BLUE, RED, GOLD, GREEN, INK))):
            draw(scene, m.points(f"rod_{i + 1}", pair, k)[:, swap] * [1, -1, 1], colour, alpha, 2.6)
    path = m.path("rod_2", (0, -0.5, 0))[:, swap] * [1, -1, 1]
    draw(scene, path, PALE, 1, 2, zorder=0)
    fit(scene, (-1, -1, -1.0), (1, 0.6, 0.1), 1.3)
    P3 = m.probe("P3")
    for axis, colour in zip("xyz", (BLUE, GOLD, RED)):
        plot.plot(P3["t"], P3[axis], color=colour, label=axis)
    plot.legend(frameon=False, ncol=3, loc="upper right", fontsize=8)
    plot.set_ylim(-1.1, 1.35)
    label(plot, "position of P3 [m]")
    return figure


def flyball_governor():
    m = Motion("flyball_governor", "output.every=5 ms")
    figure, scene, plot = sheet((14, -60))
    c = (0.3 * 0.5 + 5) / 5.3
    for name in "ab":
        draw(scene, m.path(f"rod_{name}", (1 - c, 0, 0))[m.t <= 1.0], PALE, 0.9, 1.0)
    for k, alpha in fades(frames(m, 0, 0.5, 4)):
        draw(scene, [[0, 0, 0], [0, 0, 1]], INK, alpha, 2)
        draw(scene, m.points("slider", box(0.1, 0.1, 0.1), k), RED, alpha, 1)
        for name, h in (("a", 0.05), ("b", -0.05)):
            draw(scene, m.points(f"rod_{name}", [(-c, 0, 0), (1 - c, 0, 0)], k), BLUE, alpha, 1.8)
            scene.scatter(*m.points(f"rod_{name}", [(1 - c, 0, 0)], k).T, color=BLUE, s=60, alpha=alpha)
            middle, hook = m.points(f"rod_{name}", [(0.5 - c, 0, 0)], k), m.points("slider", [(h, 0, 0)], k)
            draw(scene, np.vstack([middle, hook]), GOLD, alpha, 1, linestyle="--")
    fit(scene, (-1, -1, 0), (1, 1, 1.1), 1.6)
    plot.plot(m.t, m.place["slider"][:, 2], color=RED)
    label(plot, "height of the slider [m]")
    return figure


def gyroscope():
    m = Motion("gyroscope")
    figure, scene, plot = sheet((24, -35), wide=1.0)
    k = int(np.argmin(abs(m.t - 1.0)))
    draw(scene, [[0, 0, -0.12], [0, 0, -0.083]], PALE, 1, 5)
    for body, lines, colour in (("outer", tube(0.0825, 0.008, 0), INK), ("inner", tube(0.0675, 0.008, 2), BLUE),
                                ("rotor", tube(0.04, 0.01, 0), RED)):
        for line in lines[:2] if body != "rotor" else lines:
            draw(scene, m.points(body, line, k), colour, 1, 1.8)
    draw(scene, m.points("inner", [(-0.0675, 0, 0), (0.0675, 0, 0)], k), RED, 1, 1.2)
    for y in (-1, 1):
        draw(scene, m.points("inner", [(0, y * 0.0675, 0), (0, y * 0.0825, 0)], k), INK, 1, 3)
    for angle in np.linspace(0, np.pi, 7)[:-1]:
        r = 0.04 * np.array([0, np.cos(angle), np.sin(angle)])
        draw(scene, m.points("rotor", [-r, r], k), RED, 0.6, 0.8)
    scene.scatter(*m.place["weight"][k], color=GOLD, s=90)
    draw(scene, m.place["weight"], GOLD, 0.9, 1.0)
    fit(scene, (-0.085, -0.085, -0.12), (0.085, 0.085, 0.09), 1.35)
    phi, theta = m.probe("stand")["rz"], m.probe("gimbal")["rz"]
    part = m.t <= 0.5
    plot.plot(np.degrees(phi[part]), np.degrees(theta[part]), color=BLUE)
    plot.invert_yaxis()
    label(plot, "precession and nutation of the axle, 0.5 s", "rotation of the outer ring [deg]",
          "tilt of the inner ring [deg]")
    return figure


def reaction_wheels():
    m = Motion("reaction_wheels")
    figure, scene, plot = sheet((24, -50), wide=1.3)
    rims = [tube(0.22, 0.08, axis) for axis in range(3)]
    right = np.array([np.sin(np.radians(50)), np.cos(np.radians(50)), 0])  # in the picture
    for n, k in enumerate((0, 90, len(m.t) - 1)):
        shift = (1.75 * n - 2.15) * right
        draw(scene, m.points("satellite", box(1, 0.8, 0.9), k) + shift, INK, 1, 1.2)
        for axis, (rim, colour) in enumerate(zip(rims, (RED, GREEN, BLUE))):
            at = np.eye(3)[axis] * (0.62, 0.52, 0.57)[axis]
            for line in rim:
                draw(scene, m.points("satellite", line + at, k) + shift, colour, 1, 0.9)
    fit(scene, (-2, -2, -1), (2, 2, 1), 1.55)
    scene.set_title("at 0, 9 and 20 s; wheels drawn outside", loc="center", y=0.84)
    for name, colour in (("x", RED), ("y", GREEN), ("z", BLUE)):
        plot.plot(m.t, m.probe(name)["speed"], color=colour, label=f"wheel {name}")
    plot.legend(frameon=False, fontsize=8)
    label(plot, "speeds of the wheels [rad/s]")
    return figure


def door_on_two_hinges():
    m = Motion("door_on_two_hinges")
    figure, scene, plot = sheet((26, -40), wide=0.9)
    draw(scene, [(0, 0, 0), (0, 0, 2.08), (0.93, 0, 2.08), (0.93, 0, 0)], PALE, 1, 4)
    for k, alpha in fades(frames(m, 0, 1.0, 6)):
        draw(scene, m.points("door", box(0.9, 0.04, 2), k), BLUE, alpha, 1)
    draw(scene, m.path("door", (0.45, 0, 0))[m.t < 6], RED, 1, 1.2)
    for z in (0.25, 1.75):
        draw(scene, [(0, 0, z - 0.06), (0, 0, z + 0.06)], INK, 1, 6)
    fit(scene, (-0.1, -0.1, 0), (1.0, 1.0, 2.1), 1.3)
    lower, upper = m.probe("lower"), m.probe("upper")
    plot.plot(lower["t"], lower["fz"] + upper["fz"], color=INK, label="vertical, both hinges")
    plot.plot(lower["t"], np.hypot(lower["fx"], lower["fy"]), color=BLUE, label="horizontal, lower hinge")
    plot.plot(lower["t"], np.hypot(upper["fx"], upper["fy"]), color=RED, label="horizontal, upper hinge")
    plot.legend(frameon=False, fontsize=8, loc="center right")
    label(plot, "hinge forces [N]")
    return figure


def beam_roll_up():
    figure, scene, plot = sheet(wide=1.4, flat=True)
    m = Motion("beam_roll_up", "analysis.load_steps=8")
    for line, alpha in fades(list(m.beams["strip"])):
        draw(scene, line, BLUE, alpha, 1.6, marker="o", ms=3)
    angle = np.linspace(0, 2 * np.pi, 200)
    radius = 1 / (2 * np.pi)
    draw(scene, np.c_[radius * np.sin(angle), radius * (1 - np.cos(angle))], INK, 0.8, 0.7, linestyle="--")
    draw(scene, [[0, -0.06], [0, 0.06]], INK, 1, 3)
    label(scene, "eight load steps of the end moment; dashed: full circle", "x [m]", "y [m]")
    load, x = m.probe("tip")["t"], m.probe("tip")
    part = np.linspace(1e-3, 1, 200) * 2 * np.pi
    plot.plot(part / (2 * np.pi), np.sin(part) / part, color=PALE, linewidth=3, label="closed form")
    plot.plot(part / (2 * np.pi), (1 - np.cos(part)) / part, color=PALE, linewidth=3)
    plot.plot(load, x["x"], "o", color=BLUE, ms=4, label="x")
    plot.plot(load, x["y"], "o", color=RED, ms=4, label="y")
    label(plot, "position of the strip's end [m]", "fraction of the full moment [-]")
    plot.legend(frameon=False)
    return figure


def flexible_four_bar():
    figure, scene, plot = sheet(wide=1.4, flat=True, size=(9.6, 3.9))
    m, s = Motion("flexible_four_bar"), Motion("flexible_four_bar", model="model_solid.yaml")
    picks = frames(m, 0.0, 0.42, 7)
    for k, alpha in fades(picks):
        draw(scene, m.beams["coupler"][k], BLUE, alpha, 2.2)
        b, c = m.place["eye_B"][k], m.place["eye_C"][k]
        draw(scene, [[0, 0, 0], b], INK, alpha, 1.6, marker="o", ms=3)
        draw(scene, [[1.2, 0, 0], c], GREEN, alpha, 1.6, marker="o", ms=3)
        draw(scene, [b, c], PALE, alpha, 0.6, zorder=0)
    label(scene, "crank, coupler and rocker every 70 ms", "x [m]", "y [m]")

    def bending(run):
        b, c, middle = (np.array(run.points(n))[:, :2] for n in ("B", "C", "middle"))
        along, arm = c - b, middle - b
        return (along[:, 0] * arm[:, 1] - along[:, 1] * arm[:, 0]) / np.linalg.norm(along, axis=1)

    plot.plot(m.t, 1e3 * bending(m.run), color=BLUE, label="beam, 16 elements")
    plot.plot(s.t, 1e3 * bending(s.run), color=RED, linestyle="--", label="solid, 12 hex20")
    label(plot, "deflection at the coupler's midpoint [mm]")
    plot.legend(frameon=False)
    return figure
