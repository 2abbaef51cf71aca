# SPDX-License-Identifier: Apache-2.0
"""The examples without contact, at their step and at fractions of it, with the order of their model and with order two; those with a mesh
also on finer ones. Known solutions are in tests/validation/data (sources in docs/validation.md) or in closed form.

The constants C of errors C Δt² of order two are those of tests/validation/published_cases_test.cpp: twice the phase by which steps lag.
At higher orders the given error is that of the first step, and it decreases with the order down to rounding.
"""
import dataclasses
import math

from case import Case, Known, Variant, at, falling, last, table

WAVES = ("[m/s^2]", "[N]", "[N m]")  # Columns that show waves in elastic bodies that a step does not resolve.
SOUND = WAVES + ("[m/s]", "[rad/s]", "[-]", "[1/m]")  # Columns for waves that are fast enough to show in speeds, too.
WHY_WAVES = "Elastic bodies that are released undeformed have waves that the step does not resolve: positions are compared; a separate case has steps that resolve them."
ROUNDING = 1e-9  # Floor of differences relative to a column's range, also for accelerations and reactions, in which rounding of positions grows by 1/Δt.


def example(name, step, span, about, known=lambda order: (), orders=(2,), model="model", longer=1, asked=None, **more):
    """Variants by order; `known` returns the known numbers of one."""
    variants = tuple(Variant(f"order {order}", {"analysis.order": str(order)}, tuple(known(order)), asked or order, longer if order > 2 else 1) for order in orders)
    more = {"smooth": True, "floor": ROUNDING, **more}
    return Case(f"example_{name}{model[5:]}", about, f"examples/{name}/{model}.yaml", step, span, variants, **more)


def against(data, columns, step, time, quadratic, higher, start=None):
    """Known values at a time from a reference solution: (probe, column, column of the data)."""
    row = table(data)[time]

    def known(order):
        within = (lambda h: quadratic * h * h + 1e-9) if order == 2 else falling(higher, step, order, 1e-9)
        for probe, column, k in columns:
            shift = start[k] if start else 0.0
            yield Known(f"{probe} {column} at {time:g} s", at(probe, column, time), row[k] - shift, within)

    return known


def heavy_top():
    known = against("heavy_top", (("centre", "x", 0), ("centre", "y", 1), ("centre", "z", 2)), 1e-3, 0.03, 1280, 1e-5)
    return example("heavy_top", 1e-3, 0.03, "The top of Brüls and Cardona.", known, (2, 8))


def slider_crank():
    known = against("spatial_slider_crank", (("slider", "x", 0),), 2e-3, 0.1, 97, 1e-7)
    return example("spatial_slider_crank", 2e-3, 0.1, "Haug's slider-crank.", known, (2, 6))


def cat():
    # z of the front after both loops, from the equation that zero angular momentum makes of the shape (examples/falling_cat/check.py).
    axis = (("x", -0.011886614513911905), ("y", 8.790299690493484e-05), ("z", -0.9999293478384129))

    def known(order):
        within = (lambda h: 220 * h * h + 1e-9) if order == 2 else falling(2e-9, 1e-2, 6, 1e-11)
        for c, value in axis:
            yield Known(f"front_z {c} at the end", lambda run, c=c: run.probe("front_z")[c][-1] - run.probe("front")[c][-1], value, within)

    return example("falling_cat", 2e-3, 0.6, "A cat turns over without angular momentum.", known, (2, 6), longer=5, floor=1e-7)


def driven_governor():
    # Tilt, moment and power during the ramp, from the equation of the tilt (examples/governor_on_motor/check.py).
    numbers = (("pin_a", "rz", 0.8498858601558126 - 0.8270571817277367, 50), ("motor", "mz", 0.5093567311003615, 50), ("motor", "power", 8.01331879774613, 1000))
    known = lambda order: tuple(Known(f"{probe} {column} at 1.5 s", at(probe, column, 1.5), value, lambda h, size=size: size * h * h + 1e-9) for probe, column, value, size in numbers)  # noqa: E731
    return example("governor_on_motor", 2e-3, 1.6, "A motor speeds up a governor.", known)


def four_bar():
    known = against("n_four_bar_2", (("B0", "x", 0), ("B0", "y", 1)), 1e-2, 0.4, 121, 1e-7)
    return example("n_four_bar", 1e-2, 0.4, "Two four-bars that pass the position where all bars are on one line.", known, (2, 6),
                   skip=("foot_0.fx", "foot_0.fy", "foot_0.fz", "foot_0.mx", "foot_0.my", "foot_0.mz"),
                   because="Rows are redundant: the distribution of reactions among hinges depends on the solver.")


def squeezer():
    names = ("beta", "theta", "gamma", "phi", "delta", "omega", "epsilon")
    start = list(table("andrews_squeezer")[0.0])
    known = against("andrews_squeezer", tuple((name, "rz", k) for k, name in enumerate(names)), 5e-5, 0.002, 1.4e6, 1e-6, start)
    return example("andrews_squeezer", 5e-5, 0.002, "Seven plates, the first 2 ms.", known, (2, 6),
                   skip=tuple(f"{name}.{c}" for name in names for c in ("fz", "mx", "my")),
                   because="Reactions out of the plane are rounding errors.")


def bricard():
    known = against("bricard", (("P3", "x", 0), ("P3", "y", 1), ("P3", "z", 2)), 2e-2, 0.5, 6.4, 1e-8)
    return example("bricard", 2e-2, 0.5, "Five rods that are immobile by the count of freedoms.", known, (2, 6),
                   skip=tuple(f"P1.{c}" for c in ("fx", "fy", "fz", "mx", "my", "mz")), because="One row is redundant: the distribution of reactions depends on the solver.")


def governor():
    known = against("flyball_governor", (("slider", "z", 0),), 2.5e-3, 0.1, 36, 0)
    return example("flyball_governor", 2.5e-3, 0.1, "Springs so stiff that a step does not resolve their vibrations, with dampers.", known, skip=("shaft.mx", "shaft.my", "shaft.mz"),
                   because="Moments in the bearing are zero by symmetry.")


def door():
    # J φ'' + c φ' + k φ = 0 from φ = 0 with 2 rad/s: a linear oscillator with small or large damping.
    J, c, k, push = 30 * ((0.9**2 + 0.04**2) / 12 + 0.45**2), 8.0, 12.0, 2.0
    d, w = c / (2 * J), math.sqrt(k / J - (c / (2 * J)) ** 2)
    time = 0.2
    angle = push / w * math.exp(-d * time) * math.sin(w * time)
    rate = push * math.exp(-d * time) * (math.cos(w * time) - d / w * math.sin(w * time))
    # Steps of order two change phase and decay by (ω Δt)²/12 of them; ω t is 0.2, and the closer's force is evaluated once per step.
    known = lambda order: (Known("angle", at("lower", "rz", time), angle, lambda h: h * h + 1e-11), Known("rate", at("lower", "rate rz", time), rate, lambda h: h * h + 1e-11))  # noqa: E731
    return example("door_on_two_hinges", 5e-3, time, "A door with a closer: a damped oscillator in closed form.", known,
                   skip=tuple(f"{n}.{c}" for n in ("lower", "upper") for c in ("fx", "fy", "fz", "mx", "my", "mz")),
                   because="Each hinge alone would hold the door: the distribution of reactions depends on the solver.")


def beam_four_bar():
    meshes = tuple({"beams.coupler.elements": str(n)} for n in (32, 64))
    return example("flexible_four_bar", 1e-3, 0.03, "A soft coupler, as a beam.", asked=1.4, skip=SOUND, meshes=meshes, mesh_skip=("middle", "root"), mesh_floor=3e-3,
                   because=WHY_WAVES + " Probes of an element are at other positions on finer meshes.")


def beam_four_bar_resolved():
    return dataclasses.replace(example("flexible_four_bar", 1e-5, 5e-4, "A soft coupler, as a beam, its waves resolved.", fractions=(1, 0.5, 0.2, 0.05), skip=("pin_D.[N m]",)),
                               name="example_flexible_four_bar_resolved", because="The moments in pin D are zero by symmetry.")


def solid_four_bar():
    meshes = ({"solids.coupler.mesh.block.cells": "[24, 2, 2]"},)
    return example("flexible_four_bar", 1e-3, 0.01, "A soft coupler, as a solid.", asked=1.4, skip=SOUND, model="model_solid", meshes=meshes, mesh_floor=2e-2,
                   fractions=(1, 0.5, 0.2, 0.05), because=WHY_WAVES + " Finer steps take minutes.")


def spinning_bar():
    meshes = ({"solids.bar.mesh.block.cells": "[12, 2, 2]"},)
    return example("spinning_bar", 2e-2, 0.5, "A soft bar on a tumbling body.", skip=WAVES + ("tip.[m/s]",), meshes=meshes, mesh_floor=5e-2,
                   fractions=(1, 0.5, 0.2, 0.05), because=WHY_WAVES)


def spinning_bar_resolved():
    return dataclasses.replace(example("spinning_bar", 1e-3, 0.02, "A soft bar on a tumbling body, its waves resolved.", fractions=(1, 0.5, 0.2, 0.05)), name="example_spinning_bar_resolved")


def panel():
    meshes = ({"solids.panel.mesh.block.cells": "[12, 4, 1]"},)
    return example("flexible_panel", 0.1, 1.0, "A damped panel on a spinning craft.", skip=WAVES, meshes=meshes, mesh_floor=5e-2,
                   fractions=(1, 0.5, 0.2, 0.05), because=WHY_WAVES)


def panel_reaction():
    return Case("example_flexible_panel_reaction", "Reactions of a damped panel all of whose modes are overdamped by its viscosity.", "examples/flexible_panel/model.yaml", 0.1, 2.0, order=1.5, smooth=True,
                skip=("tip", "x_tip", "y_tip", "z_tip", "centre.[m]", "centre.[m/s]"), floor=1e-3)


def bushing():
    dynamic = {"analysis.type": "dynamics"}
    return Case("example_rubber_bushing", "Rubber with viscosity, released under 1.5 kN.", "examples/rubber_bushing/model.yaml", 5e-4, 2.5e-3,
                (Variant("", dynamic),), order=2, smooth=True, floor=1e-6, fractions=(1, 0.5, 0.2, 0.05), skip=("inner.[N m]", "outer.[N m]"),
                because="Moments are zero by symmetry. Finer steps take minutes.")


def bushing_at_rest():
    # Torsion shears every ring by torque/(2 π r² L G): no end effects, no change of volume.
    stiffness = 4 * math.pi * 0.8e6 * 0.04 / (1 / 0.01**2 - 1 / 0.02**2)
    angle = lambda run: math.atan2(last("arm", "y")(run), last("arm", "x")(run))  # noqa: E731
    known = (Known("turn under 0.1 N m [rad]", angle, 0.1 / stiffness, lambda h: 5e-3 * h**2 * 0.1 / stiffness),)
    return Case("example_rubber_bushing_twisted", "Torsion of a bonded tube in closed form.", "examples/rubber_bushing/model.yaml", 1, 1,
                (Variant("", {"radial": "0", "torque": "0.1 N m"}),), statics=True, floor=1e-8, mesh_known=known,
                fractions=(1, 0.5, 0.2), skip=("[N]",),
                meshes=({"solids.rubber.mesh.tube.cells": "[6, 40, 10]"},), mesh_floor=1e-2, because="Forces are zero by symmetry.")


def knee():
    return Case("example_knee", "Cartilage and ligaments at rest under loads.", "examples/knee/model.yaml", 1, 1, statics=True, floor=1e-7, fractions=(1, 0.5, 0.2, 0.05))


def roll_up():
    # A moment 2π EI/L bends the strip to a full circle: its end returns to its start, x = 0, for any mesh.
    known = tuple(Known(f"tip {c} [m]", last("tip", c), 0.0, 1e-9) for c in "xyz")
    return Case("example_beam_roll_up", "A strip bent to a full circle.", "examples/beam_roll_up/model.yaml", 1, 1, (Variant("", {}, known),), statics=True, floor=1e-8,
                skip=("tip", "middle.fx", "middle.fy", "middle.fz", "middle.strain x", "middle.strain y", "middle.strain z", "clamp.fx", "clamp.fy", "clamp.fz"),
                meshes=({"beams.strip.elements": "20"}, {"beams.strip.elements": "40"}), mesh_skip=("middle",), mesh_floor=1e-9, mesh_known=known,
                because="Skipped columns are zero: there are no forces, and the tip returns to the origin.")


# Forces in position rows carry rounding by 1/Δt²: it adds up in the work of the platform's legs and of the cat's motors, and shifts the time at which the trebuchet's
# trough carries nothing any more.
CASES = [example("tumbling_body", 1e-2, 0.4, "A T-handle that turns over in free fall.", orders=(2, 8)),
         example("double_pendulum", 1e-2, 0.4, "Two bars released horizontally.", orders=(2, 6)), example("gyroscope", 1e-3, 0.04, "Precession and nutation.", orders=(2, 6)),
         heavy_top(), slider_crank(), example("crank_rocker", 1e-3, 0.2, "A motor starts a crank-rocker."), example("planetary_gearbox", 1e-3, 0.1, "Gears, redundant planets, a motor.",
                 skip=("output.[N]", "output.[N s]", "teeth_1.[N or N m]", "teeth_1.[W]", "teeth_2.[N or N m]", "teeth_2.[W]"),
                 because="The bearings carry no load, and redundant planets share theirs to 1e-7 only."),
         example("suspension_corner", 1e-3, 0.1, "Bushings, strut and tyre on a shaker."),
         example("excavator", 5e-3, 0.5, "Three cylinders move an arm.", floor=1e-8), example("stewart_platform", 2e-3, 0.1, "Six legs move a platform.", floor=1e-7),
         example("three_rrr", 2e-3, 0.1, "Three motors carry a plate.", floor=1e-7),
         example("delta_robot", 2e-3, 0.1, "Three motors carry a platform by six rods.", floor=1e-7),
         example("geneva_drive", 2e-3, 0.3, "A pin enters a slot."),
         example("trebuchet", 2e-3, 0.3, "A latch opens and the sling's trough is left.", floor=1e-8), example("cable_crane", 5e-3, 0.4, "A rope runs over sheaves to a hook."),
         example("arm_with_muscles", 2e-3, 0.2, "Two muscles bend an elbow."), example("bicycle", 2e-3, 0.2, "Wheels that roll, steered to stay upright."), cat(), driven_governor(), four_bar(), squeezer(), bricard(), governor(), door(), beam_four_bar(), beam_four_bar_resolved(), solid_four_bar(), spinning_bar(), spinning_bar_resolved(), panel(), panel_reaction(),
         bushing(), bushing_at_rest(), knee(), roll_up()]
