# SPDX-License-Identifier: Apache-2.0
"""Pictures of the examples with gears, bushings and events; tools/render_example.py makes them. `tools` is the module drawing."""
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
    plot.plot(motor["t"], motor["mz"], color=tools.RED, label="motor torque [N m]")
    plot.plot(teeth["t"], -teeth["effort_1"], color=tools.BLUE, label="torque of one planet on the sun [N m]")
    plot.legend(frameon=False)
    tools.label(plot, "full speed after 0.5 s")
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
    tools.label(scene, "arms on bushings, strut, tyre on the platform", "y [m]", "z [m]")
    for body, colour in (("chassis", tools.BLUE), ("wheel", tools.INK)):
        z = m.probe(body)["z"]
        plot.plot(m.t, 1e3 * (z - z[0]), color=colour, label=body)
    shaker = m.probe("shaker")
    plot.plot(shaker["t"], 1e3 * shaker["displacement"], color=tools.GOLD, label="shaker")
    plot.legend(frameon=False)
    tools.label(plot, "heave [mm]; shaker: 20 mm, 1.5 Hz")
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
    tools.label(scene, "table and sliding crate, 0.5 to 0.75 s", "x [m]", "z [m]")
    for body, colour, name in (("table", tools.INK, "table and crate, mu = 0.9"), ("slips", tools.RED, "crate, mu = 0.4")):
        probe = m.probe(body)
        plot.plot(probe["t"], probe["vx"], color=colour, label=name)
    plot.legend(frameon=False, loc="lower center", bbox_to_anchor=(0.6, 1), ncol=2)
    tools.label(plot, "velocity", "t [s]", "[m/s]")
    return figure


def stewart_platform(tools):
    m = tools.Motion("stewart_platform")
    figure, scene, plot = tools.sheet((14, -60), wide=0.9)
    for k, alpha in tools.fades(tools.frames(m, 0.0, 0.5, 3)):
        tools.draw(scene, m.points("platform", tools.circle(0.55), k), tools.BLUE, alpha, 2)
        for i in range(1, 7):
            tools.draw(scene, m.points(f"cylinder_{i}", [[0, 0, -0.3], [0, 0, 0.3]], k), tools.INK, alpha, 3)
            tools.draw(scene, m.points(f"rod_{i}", [[0, 0, -0.3], [0, 0, 0.3]], k), tools.RED, alpha, 1.5)
    tools.draw(scene, m.place["platform"], tools.GOLD, 1, 1)
    floor = tools.circle(0.85)
    tools.draw(scene, floor, tools.PALE, 1, 2)
    tools.fit(scene, (-0.85, -0.85, 0), (0.85, 0.85, 1.2), 1.25)
    for i, colour in zip((1, 2, 3), (tools.RED, tools.BLUE, tools.GOLD)):
        motor = m.probe(f"motor_{i}")
        force = motor["power"] / motor["rate"]
        force[abs(motor["rate"]) < 2e-2] = np.nan
        plot.plot(motor["t"], force, color=colour, label=f"leg {i}")
    plot.legend(frameon=False, ncol=3)
    tools.label(plot, "axial forces of three legs", y="[N]")
    return figure


def geneva_drive(tools):
    m = tools.Motion("geneva_drive")
    figure, scene, plot = tools.sheet(flat=True, wide=0.9)
    radius, slots = 0.05, [np.pi / 4 + k * np.pi / 2 for k in range(4)]
    for t, alpha in ((0.3, 0.2), (0.45, 0.45), (0.6, 1.0)):
        k = int(np.argmin(abs(m.t - t)))
        tools.draw(scene, m.points("crank", [[0, 0, 0], [0, -radius, 0]], k), tools.INK, alpha, 3)
        pin = m.points("crank", [[0, -radius, 0]], k)
        scene.plot(pin[:, 0], pin[:, 1], "o", color=tools.RED, alpha=alpha)
        tools.draw(scene, m.points("wheel", tools.circle(radius), k), tools.BLUE, alpha, 2)
        for s in slots:
            ends = [[r * np.cos(s), r * np.sin(s), 0] for r in (0.015, radius)]
            tools.draw(scene, m.points("wheel", ends, k), tools.BLUE, alpha, 2)
    tools.label(scene, "at 0.3, 0.45 and 0.6 s", "x [m]", "y [m]")
    axle, motor = m.probe("axle"), m.probe("motor")
    plot.plot(axle["t"], -axle["rz"], color=tools.BLUE, label="wheel angle [rad]")
    plot.plot(motor["t"], 100 * motor["mz"], color=tools.RED, label="motor torque [N cm]")
    plot.legend(frameon=False)
    tools.label(plot, "two quarter turns of the wheel", y="")
    return figure


def three_rrr(tools):
    m = tools.Motion("three_rrr")
    figure, scene, plot = tools.sheet(flat=True, wide=0.9)
    for k, alpha in tools.fades(tools.frames(m, 0.0, 1.0, 3)):
        tools.draw(scene, m.points("plate", tools.circle(0.15), k), tools.BLUE, alpha, 2)
        for i in (1, 2, 3):
            for name, colour in ((f"upper_{i}", tools.INK), (f"lower_{i}", tools.RED)):
                tools.draw(scene, m.points(name, [[-0.2, 0, 0], [0.2, 0, 0]], k), colour, alpha, 2.5)
    tools.draw(scene, m.place["plate"], tools.GOLD, 1, 1)
    tools.label(scene, "at 0, 0.5 and 1 s", "x [m]", "y [m]")
    for i, colour in zip((1, 2, 3), (tools.RED, tools.BLUE, tools.GOLD)):
        motor = m.probe(f"motor_{i}")
        plot.plot(motor["t"], motor["mz"], color=colour, label=f"motor {i}")
    plot.legend(frameon=False, ncol=3)
    tools.label(plot, "motor torques", y="[N m]")
    return figure


def delta_robot(tools):
    m = tools.Motion("delta_robot")
    figure, scene, plot = tools.sheet((16, -70), wide=0.9)
    for k, alpha in tools.fades(tools.frames(m, 0.0, 0.5, 3)):
        tools.draw(scene, m.points("platform", tools.circle(0.078), k), tools.BLUE, alpha, 3)  # Through the wrists.
        for i in (1, 2, 3):
            tools.draw(scene, m.points(f"arm_{i}", [[-0.125, 0, 0], [0.125, 0, 0]], k), tools.INK, alpha, 4)
            tools.draw(scene, m.points(f"arm_{i}", [[0.125, -0.05, 0], [0.125, 0.05, 0]], k), tools.INK, alpha, 3)
            for side in "ab":
                tools.draw(scene, m.points(f"rod_{i}{side}", [[-0.25, 0, 0], [0.25, 0, 0]], k), tools.RED, alpha, 1.5)
    tools.draw(scene, m.place["platform"], tools.GOLD, 1, 1.5)
    tools.draw(scene, tools.circle(0.2), tools.PALE, 1, 3)
    tools.fit(scene, (-0.4, -0.4, -0.55), (0.4, 0.4, 0.05), 1.2)
    for i, colour in zip((1, 2, 3), (tools.RED, tools.BLUE, tools.GOLD)):
        motor, angle = m.probe(f"motor_{i}"), 2 * np.pi * (i - 1) / 3
        plot.plot(motor["t"], np.cos(angle) * motor["my"] - np.sin(angle) * motor["mx"], color=colour, label=f"motor {i}")
    plot.legend(frameon=False, ncol=3)
    tools.label(plot, "motor torques", y="[N m]")
    return figure


def excavator(tools):
    m = tools.Motion("excavator")
    figure, scene, plot = tools.sheet(flat=True, wide=1.1)
    start = np.array([[0.2, 1.6], [3.7, 3.6], [5.0, 1.4], [4.6, 0.2]])
    for k, alpha in tools.fades(tools.frames(m, 0.0, 6.0, 3)):
        for name, a, b, colour in (("boom", 0, 1, tools.GOLD), ("stick", 1, 2, tools.GOLD), ("bucket", 2, 3, tools.INK)):
            half = 0.5 * np.linalg.norm(start[b] - start[a])
            line = m.points(name, [[-half, 0, 0], [half, 0, 0]], k)
            scene.plot(line[:, 0], line[:, 2], color=colour, alpha=alpha, lw=5, solid_capstyle="round")
        for name, half in (("boom", 1.1), ("stick", 0.83), ("bucket", 1.3)):
            for part, colour, width, ends in (("barrel", tools.BLUE, 4, (-0.6, 0.6)), ("rod", tools.RED, 2, (-0.6, 0.6))):
                length = np.linalg.norm(m.place[f"{name}_barrel"][0] - m.place[f"{name}_rod"][0]) / 0.4
                line = m.points(f"{name}_{part}", [[0, 0, e * 0.5 * length] for e in ends], k)
                scene.plot(line[:, 0], line[:, 2], color=colour, alpha=alpha, lw=width)
    tip = m.probe("tip")
    scene.plot(tip["x"], tip["z"], color=tools.GREEN, lw=1)
    scene.axhline(0, color=tools.PALE, lw=2)
    tools.label(scene, "at 0, 3 and 6 s", "x [m]", "z [m]")
    for name, colour in (("boom", tools.BLUE), ("stick", tools.RED), ("bucket", tools.INK)):
        motor = m.probe(f"{name}_motor")
        along = m.place[f"{name}_rod"] - m.place[f"{name}_barrel"]
        along /= np.linalg.norm(along, axis=1)[:, None]
        force = np.column_stack([motor["fx"], motor["fy"], motor["fz"]])
        plot.plot(motor["t"], 1e-3 * (force * along).sum(axis=1), color=colour, label=name)
    plot.legend(frameon=False, ncol=3)
    tools.label(plot, "cylinder forces", y="[kN]")
    return figure


def trebuchet(tools):
    m = tools.Motion("trebuchet", "output.every=5 ms", "analysis.duration=1.4")
    figure, scene, plot = tools.sheet(flat=True, wide=1.1)
    events = {e["event"]: e["time"] for e in m.run.figures["events"]}
    for k, alpha in tools.fades([int(np.argmin(abs(m.t - t))) for t in (0.2, events["lift"], 0.75, 0.92, events["throw"])]):
        arm = m.points("arm", [[-2, 0, 0], [2, 0, 0]], k)
        scene.plot(arm[:, 0], arm[:, 2], color=tools.GOLD, lw=3, alpha=alpha)
        block = m.points("counterweight", tools.box(0.6, 0.0, 0.6)[[0, 1, 5, 4, 0]], k)
        scene.plot(block[:, 0], block[:, 2], color=tools.INK, lw=1.5, alpha=alpha)
        ball = m.place["ball"][k]
        scene.plot([arm[1, 0], ball[0]], [arm[1, 2], ball[2]], color=tools.BLUE, lw=1, alpha=alpha)
        scene.plot(ball[0], ball[2], color=tools.RED, marker="o", ms=5, alpha=alpha)
    path = m.place["ball"][m.t < events["throw"] + 0.1]
    scene.plot(path[:, 0], path[:, 2], color=tools.RED, lw=0.8)
    scene.plot([0, 0], [0, 3], color=tools.PALE, lw=4)
    tools.label(scene, "throw until the sling opens", "x [m]", "z [m]")
    for name, column, colour in (("sling", "sling", tools.BLUE), ("trough", "trough", tools.GREEN)):
        probe = m.probe(name)
        force = 1e-3 * np.sqrt(probe["fx"] ** 2 + probe["fy"] ** 2 + probe["fz"] ** 2)
        plot.plot(probe["t"], force, color=colour, label=column)
    for name, t in events.items():
        if name != "land":
            plot.axvline(t, color=tools.PALE, lw=1)
            plot.annotate(name, (t, plot.get_ylim()[1]), ha="right", va="top", rotation=90, fontsize=8)
    plot.legend(frameon=False, loc="center left")
    tools.label(plot, "forces of sling and trough; vertical lines: events", y="[kN]")
    return figure


def cable_crane(tools):
    m = tools.Motion("cable_crane")
    figure, scene, plot = tools.sheet(flat=True, wide=0.8)
    for k, alpha in tools.fades(tools.frames(m, 0.0, 5.0, 4)):
        jib = m.points("jib", [[-3, 0, 0], [3, 0, 0]], k)
        scene.plot(jib[:, 0], jib[:, 2], color=tools.GOLD, lw=3, alpha=alpha)
        winch, hook = m.place["winch"][k], m.place["hook"][k]
        rope = np.array([winch, [0, 0, 8], jib[1], hook])
        scene.plot(rope[:, 0], rope[:, 2], color=tools.RED, lw=1.2, alpha=alpha)
        scene.plot(hook[0], hook[2], color=tools.INK, marker="s", ms=7, alpha=alpha)
        scene.plot(winch[0], winch[2], color=tools.BLUE, marker="s", ms=6, alpha=alpha)
    scene.plot([0, 0], [0, 8], color=tools.PALE, lw=4, zorder=0)
    scene.plot(m.place["hook"][:, 0], m.place["hook"][:, 2], color=tools.INK, lw=0.7)
    tools.label(scene, "lift and subsequent swing", "x [m]", "z [m]")
    rope = m.probe("rope")
    plot.plot(rope["t"], rope["tension"], color=tools.RED)
    plot.axhline(500 * 9.81 / 2, color=tools.PALE, lw=1)
    tools.label(plot, "rope tension; grey: half the weight", y="[N]")
    return figure


def trolley_on_bridge(tools):
    m = tools.Motion("trolley_on_bridge")
    figure, scene, plot = tools.sheet(flat=True, wide=1.0)
    scene.set_aspect("auto")
    for k, alpha in tools.fades(tools.frames(m, 0.12, 0.72, 4)):
        bridge, trolley = m.beams["bridge"][k], m.place["trolley"][k]
        scene.plot(bridge[:, 0], 1e3 * bridge[:, 2], color=tools.BLUE, lw=1.5, alpha=alpha)
        scene.plot(trolley[0], 1e3 * trolley[2], color=tools.RED, marker="s", ms=9, alpha=alpha)
    scene.plot(m.place["trolley"][:, 0], 1e3 * m.place["trolley"][:, 2], color=tools.INK, lw=0.7)
    tools.label(scene, "the bridge under the trolley, and the trolley's path", "x [m]", "z [mm]")
    wheel = m.probe("wheel")
    plot.plot(wheel["t"], 1e-3 * wheel["fz"], color=tools.RED)
    plot.axhline(600 * 9.81e-3, color=tools.PALE, lw=1)
    tools.label(plot, "force of the bridge on the trolley; grey: its weight", y="[kN]")
    return figure


def arm_with_muscles(tools):
    m = tools.Motion("arm_with_muscles")
    figure, scene, plot = tools.sheet(flat=True, wide=0.8)
    for k, alpha in tools.fades(tools.frames(m, 0.0, 0.8, 4)):
        bone = m.points("forearm", [[-0.15, 0, 0], [0.18, 0, 0]], k)
        scene.plot(bone[:, 0], bone[:, 2], color=tools.GOLD, lw=4, alpha=alpha)
        weight = m.place["weight"][k]
        scene.plot(weight[0], weight[2], color=tools.INK, marker="o", ms=13, alpha=alpha)
        end, back = m.points("forearm", [[-0.105, 0, 0.01], [-0.18, 0, -0.005]], k)
        scene.plot([0.02, end[0]], [0.3, end[2]], color=tools.RED, lw=2.5, alpha=alpha)
        scene.plot([-0.02, -0.025, back[0]], [0.28, 0.02, back[2]], color=tools.BLUE, lw=2.5, alpha=alpha)
    scene.plot([0, 0], [0, 0.32], color=tools.PALE, lw=5, zorder=0)
    tools.label(scene, "biceps (red), triceps (blue)", "x [m]", "z [m]")
    for name, colour in (("biceps", tools.RED), ("triceps", tools.BLUE)):
        probe = m.probe(name)
        plot.plot(probe["t"], probe["tension"], color=colour, label=name)
    elbow = m.probe("elbow")
    plot.plot(elbow["t"], 2 * np.degrees(elbow["rz"]), color=tools.INK, lw=0.8, label="twice the elbow angle [deg]")
    plot.legend(frameon=False)
    tools.label(plot, "muscle tensions", y="[N]")
    return figure


def elbow(tools):
    m = tools.Motion("elbow")
    figure, scene, plot = tools.sheet(flat=True, wide=0.8)
    around = np.linspace(0, 2 * np.pi, 60)
    scene.plot([0, 0], [0, 0.3], color=tools.PALE, lw=7, zorder=0)
    scene.fill(0.018 * np.cos(around), 0.018 * np.sin(around), color=tools.PALE, zorder=0)
    for k, alpha in tools.fades(tools.frames(m, 0.0, 0.8, 3)):
        bone = m.points("forearm", [[-0.15, 0, 0], [0.18, 0, 0]], k)
        scene.plot(bone[:, 0], bone[:, 2], color=tools.GOLD, lw=4, alpha=alpha)
        weight = m.place["weight"][k]
        scene.plot(weight[0], weight[2], color=tools.INK, marker="o", ms=13, alpha=alpha)
        for name, colour in (("biceps", tools.RED), ("triceps", tools.BLUE)):
            scene.plot(m.cables[name][k][:, 0], m.cables[name][k][:, 2], color=colour, lw=2, alpha=alpha)
    scene.set_xlim(-0.05, 0.4)
    tools.label(scene, "biceps (red), triceps (blue)", "x [m]", "z [m]")
    joint = m.probe("elbow")
    for name, colour in (("biceps", tools.RED), ("triceps", tools.BLUE)):
        probe = m.probe(name)
        moves = np.abs(joint["rate rz"]) > 0.3
        plot.plot(np.degrees(joint["rz"][moves]), 1e3 * np.abs(probe["rate"] / joint["rate rz"])[moves], color=colour, marker=".", ms=3, ls="none", label=name)
    plot.axhline(18, color=tools.PALE, lw=1)
    plot.legend(frameon=False)
    tools.label(plot, "moment arms [mm]; grey: the bone's radius", "angle of the elbow [deg]")
    return figure


def bicycle(tools):
    figure, scene, plot = tools.sheet((24, -60), wide=1.1)
    m = tools.Motion("bicycle")
    for k, alpha in tools.fades(tools.frames(m, 0.0, 1.6, 5)):
        for wheel, radius in (("rear_wheel", 0.3), ("front_wheel", 0.35)):
            tools.draw(scene, m.points(wheel, tools.circle(radius, 1), k), tools.INK, alpha, 1.5)
        rear, front = m.place["rear_wheel"][k], m.place["front_wheel"][k]
        head, seat = m.points("frame", [[0.55, 0, -0.1], [-0.1, 0, 0.1]], k)
        for line in ([rear, head], [rear, seat], [seat, head], [head, front]):
            tools.draw(scene, line, tools.BLUE, alpha, 2)
    tools.draw(scene, m.place["rear_wheel"][m.t < 2] * [1, 1, 0], tools.RED, 1, 0.8)
    low, high = np.array([-0.5, -2, 0]), np.array([9, 1, 1.2])
    tools.fit(scene, low, high, 1.35)
    for v, colour in ((3.5, tools.GOLD), (4.6, tools.BLUE), (6.5, tools.RED)):
        frame = tools.Motion("bicycle", f"variables.v={v}", "analysis.duration=2.5").probe("frame") if v != 4.6 else m.probe("frame")
        plot.plot(frame["t"], np.degrees(frame["euler2x"]), color=colour, label=f"{v} m/s")
    plot.set_xlim(0, 2.5), plot.set_ylim(-40, 40)
    plot.legend(frameon=False)
    tools.label(plot, "lean angle after the gust", y="[deg]")
    return figure


def falling_cat(tools):
    m = tools.Motion("falling_cat", "output.every=5 ms")
    figure, scene, plot = tools.sheet(flat=True, wide=1.25)
    flat = np.array([[1, 0], [0.4, 0.3], [0, 1]])             # view from the side and slightly from above
    legs = {"front": (-0.11, 0.11, -0.06, tools.BLUE), "rear": (-0.12, 0.12, 0.06, tools.RED)}
    for n, k in enumerate(tools.frames(m, 0.0, 0.6, 6)):
        away = np.array([0.6 * (n % 3), 0, 4.905 * m.t[k] ** 2 - 2 - 0.62 * (n // 3)])  # without the free fall; in two rows
        for body, (low, high, at, colour) in legs.items():
            lines = [([low, 0, 0], [high, 0, 0], 7)] + [([at, y, 0], [at, y, 0.16], 2.5) for y in (-0.05, 0.05)]
            for a, b, width in lines:
                scene.plot(*((m.points(body, [a, b], k) + away) @ flat).T, color=colour, lw=width, solid_capstyle="round")
        scene.plot(*((m.points("front", [[-0.15, 0, 0.02]], k) + away) @ flat).T, color=tools.BLUE, marker="o", ms=9)
        scene.text(0.6 * (n % 3), -0.3 - 0.62 * (n // 3), f"{m.t[k]:.2f} s", ha="center", fontsize=8)
    scene.set_xlim(-0.3, 1.5), scene.set_ylim(-0.98, 0.3), scene.set_axis_off()
    scene.set_title("shown without the free fall", loc="left")
    turn = np.degrees(np.unwrap(np.arctan2(m.turn["front"][:, 2, 1], m.turn["front"][:, 2, 2])))
    spine = m.probe("spine")
    plot.plot(m.t, turn, color=tools.BLUE, label="rotation of the front")
    bend = np.degrees(np.arccos(np.cos(spine["rx"]) * np.cos(spine["ry"])))
    plot.plot(spine["t"], bend, color=tools.GOLD, label="bend angle of the spine")
    plot.legend(frameon=False, loc="lower left")
    tools.label(plot, "zero angular momentum throughout", y="[deg]")
    return figure


def governor_on_motor(tools):
    m = tools.Motion("governor_on_motor", "output.every=2 ms")
    figure, scene, plot = tools.sheet(flat=True, wide=0.8)
    middle, half = (1 * 0.25 + 0.15 * 0.125) / 1.15, 0.125
    for t, alpha in ((1.0, 0.3), (2.0, 0.55), (4.0, 1.0)):
        k = int(np.argmin(abs(m.t - t)))
        back = m.turn["shaft"][k]                             # in axes that rotate with the shaft
        z = m.place["sleeve"][k][2]
        for name in "ab":
            arm = m.points(f"arm_{name}", [[-middle, 0, 0], [2 * half - middle, 0, 0]], k) @ back
            scene.plot(arm[:, 0], arm[:, 2], color=tools.BLUE, lw=2, alpha=alpha)
            scene.plot(arm[1, 0], arm[1, 2], color=tools.BLUE, marker="o", ms=13, alpha=alpha)
            scene.plot([arm[1, 0], 0], [arm[1, 2], z], color=tools.GOLD, lw=1.5, alpha=alpha)
        sleeve = np.array([[-0.05, 0, z - 0.03], [0.05, 0, z - 0.03], [0.05, 0, z + 0.03], [-0.05, 0, z + 0.03], [-0.05, 0, z - 0.03]])
        scene.plot(sleeve[:, 0], sleeve[:, 2], color=tools.RED, lw=2, alpha=alpha)
    scene.plot([0, 0], [0, 0.6], color=tools.INK, lw=3, zorder=3)
    tools.label(scene, "at 1, 2 and 4 s", "x [m]", "z [m]")
    motor, pin = m.probe("motor"), m.probe("pin_a")
    tilt = np.arccos((1 * 0.25 + 0.15 * 0.125 + 3 * 0.25) * 9.81 / ((0.0625 + 0.15 * 0.0625 / 3 - 2e-5) * 15**2))
    steady = np.arccos(np.cos(tilt) * (15 / motor["rate"]) ** 2)
    plot.plot(motor["t"], np.degrees(steady), color=tools.PALE, lw=3, label="steady tilt at this speed [deg]")
    plot.plot(pin["t"], np.degrees(tilt + pin["rz"]), color=tools.BLUE, label="tilt of the arms [deg]")
    plot.plot(motor["t"], motor["power"], color=tools.RED, label="motor power [W]")
    plot.set_xlim(0, 6)
    plot.legend(frameon=False, loc="center right")
    tools.label(plot, "motor speed from 15 to 20 rad/s")
    return figure


def stick_slip(tools):
    m = tools.Motion("stick_slip")
    figure, scene, plot = tools.sheet(flat=True, wide=1.0)
    block = m.probe("block")
    scene.plot(1e3 * block["x"], block["vx"], color=tools.BLUE)
    scene.axhline(0.1, color=tools.PALE, lw=3, zorder=0)
    scene.text(-0.5, 0.106, "velocity of the belt", fontsize=8)
    scene.set_aspect("auto")
    tools.label(scene, "straight line: sticks; arc: slides", "x [mm]", "velocity [m/s]")
    plot.plot(block["t"], 1e3 * block["x"], color=tools.BLUE, label="position of the block [mm]")
    drive = m.probe("drive")
    plot.plot(drive["t"], drive["fx"], color=tools.RED, label="friction [N]")
    plot.set_ylim(-1, 19)
    plot.legend(frameon=False, ncol=2, loc="upper center")
    tools.label(plot, "sticks for 0.098 s, slides for 0.237 s")
    return figure
