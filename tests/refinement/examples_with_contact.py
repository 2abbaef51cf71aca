# SPDX-License-Identifier: Apache-2.0
"""The examples with contact, stops or friction, at their step and at fractions of it, over spans in which they converge.

Bodies that touch at the start settle into their band by about a twentieth of it, 1e-3 of the smallest half size: for
√(2 δ/g) they fall freely. By that much of the span, the impulse of contact differs from weight times time
at any step: `settles`.
"""
from case import Case, Known, Variant, at, fall, last, rise

G = 9.81
ENDS = "An impact ends its step: its time errs by up to a step, as the phase of the impact in it has it, so that the order is seen on average only."


def settles(half, span):
    """Part of the impulse over a span that is missing while a body of a smallest half size settles."""
    return (2 * 0.05e-3 * half / G) ** 0.5 / span


def example(name, step, span, about, known=(), **more):
    return Case(f"example_{name}", about, f"examples/{name}/model.yaml", step, span, (Variant("", {}, known),), **more)


def bouncing_ball():
    fallen = (2 / G) ** 0.5  # Fall to the floor, 1 m below; then up and down with e times the speed.
    speed = (2 * G) ** 0.5
    known = tuple(Known(f"{name}: height at the end", last(name, "z"), 0.05 + e * speed * (0.8 - fallen) - G / 2 * (0.8 - fallen) ** 2, lambda h, e=e: 1e-4 + (1 + e) * speed * h)
                  for name, e in (("elastic", 1), ("lively", 0.8), ("dull", 0.5)))
    return example("bouncing_ball", 5e-3, 0.8, "Three balls with e = 1, 0.8 and 0.5, up to their second impact; height by the law of fall.", known, skip=("touch",), order=0.6,
                   because="The impulse of contact jumps at the impact; for each ball it follows from the speeds. " + ENDS)


def stick_slip():
    # It slips at 0.5 of its weight, oscillates about 0.3 of it with D = 4.9 mm to v = 0.1 m/s, and is as fast as the belt again at -D: examples/stick_slip/check.py.
    # A patch slips at 0.999 of its static friction or later (contact-patch): `early`.
    k, v, far, near, period = 800.0, 0.1, 0.014361714802531404, 0.000353285197468596, 0.3346785311712788
    held = 0.5 * 2 * G / k
    early = 1e-3 * held
    nearest = lambda run: min(x for t, x in zip(run.probe("block")["t"], run.probe("block")["x"]) if t > held / v)  # noqa: E731
    known = (Known("farthest place [m]", lambda run: max(run.probe("block")["x"]), far, lambda h: v * h + early),
             Known("nearest place [m]", nearest, near, lambda h: v * h + early),
             # On the belt again, after the second slide; each transition is up to a step late.
             Known("place at 0.75 s [m]", at("block", "x", 0.75), held - 2 * (held - 0.3 * 2 * G / k) + v * (0.75 - held / v - 2 * period + 0.0981), lambda h: 4 * v * h + 4 * early))
    return example("stick_slip", 2e-3, 0.75, "A block on a belt: two periods of stick and slip in closed form.", known, floor=1e-3)


def incline():
    down = G * (0.5 - 0.5 * 3**0.5 / 2)
    way = 0.5 * 0.5 + down / 2 * 0.5**2
    moved = lambda run: ((run.probe("slides")["x"][-1] - run.probe("slides")["x"][0]) ** 2 + (run.probe("slides")["z"][-1] - run.probe("slides")["z"][0]) ** 2) ** 0.5  # noqa: E731
    known = (Known("way of the one that slides", moved, way, 1e-4 * way),
             # Friction sticks on springs that carry the weight within a tenth of the band.
             Known("way of the one that holds", lambda run: ((run.probe("holds")["x"][-1] - run.probe("holds")["x"][0]) ** 2 + (run.probe("holds")["z"][-1] - run.probe("holds")["z"][0]) ** 2) ** 0.5,
                   0, 2e-5, below=True))
    return example("incline", 1e-2, 0.5, "One block holds, one slides with g (sin - μ cos).", known, skip=("holds.speeds",), floor=settles(0.1, 0.5),
                   because="One is at rest: its impulses are compared.")


def incline_at_rest():
    known = tuple(Known(f"{name}: speed off the incline at the end", lambda run, n=name: abs(0.5 * last(n, "vx")(run) + 0.5 * 3**0.5 * last(n, "vz")(run)), 0, 1e-4, below=True) for name in ("holds", "slides"))
    return Case("incline_at_rest", "Blocks that touch at the start come to rest in their band.", "examples/incline/model.yaml", 1e-2, 0.5, (Variant("", {}, known),),
                compare=False, because="The expected state is rest.")


def card_house():
    known = (Known("way of a foot's card [m]", lambda run: max(abs(run.probe("right")[c][-1] - run.probe("right")[c][0]) for c in "xz"), 0, 1e-4, below=True),)
    return example("card_house", 5e-3, 0.3, "Two cards lean against each other and stand.", known, skip=("right.speeds",), floor=5 * settles(0.01, 0.3),
                   because="They are at rest, so impulses are compared; that of the apex is a fifth of a weight.")


def stack():
    height = 0.95
    # The foot carries ten reference loads, as deep as 0.35 of its band, the others less.
    known = (Known("sinks [m]", fall("top", "z"), 0, 10 * 0.35 * 5e-5, below=True), Known("rises [m]", rise("top", "z"), 0, 1e-6, below=True),
             Known("height", last("top", "z"), height, 2e-4))
    return example("stack", 2e-2, 0.3, "Ten boxes stand.", known, skip=("top.speeds",), floor=(2 * 10 * 0.35 * 5e-5 / G) ** 0.5 / 0.3,
                   because="They are at rest, so impulses are compared. These are smaller by the free fall of the boxes until they have settled.")


CASES = [bouncing_ball(), stick_slip(), incline(), incline_at_rest(), card_house(), stack(),
         example("newtons_cradle", 5e-4, 0.4, "Five balls 2 mm apart: the impact is transmitted.", fractions=(1, 0.5, 0.2, 0.05), order=0.4, because=ENDS),
         example("rattleback", 2e-3, 0.2, "A stone with askew axes."), example("rolling_coin", 5e-4, 0.05, "A coin wobbles."),
         example("tippe_top", 1e-3, 0.1, "A top begins to turn over."),
         example("spheres_in_a_bin", 2e-3, 0.095, "100 balls that fall, until the second layer lands on the first.", until=0.09, drift=1e-6,
                 because="The contact CG solver has a residual of 1e-6 of each weight. A pile is chaotic: differences grow where the next layer lands on the balls below."),
         example("gear_pair", 1e-3, 0.02, "Teeth of triangle meshes that drive each other.", fractions=(1, 0.5, 0.2, 0.05), skip=("pinion.impulses", "wheel.impulses"),
                 because="Teeth rattle within the backlash: loads of the axles depend on the times of impacts. Finer steps take minutes."),
         Case("example_crossed_lines", "A heavy line sags onto a tight one, at rest.", "examples/crossed_lines/model.yaml", 1, 1, statics=True, floor=1e-6, fractions=(1, 0.5, 0.2, 0.05),
              because="The force between the lines is known to the gap's band."),
         example("tyre_on_kerb", 4e-3, 0.05, "A soft tyre is set down and rolls.", fractions=(1, 0.5, 0.2, 0.05), because="Finer steps and the kerb take minutes."),
         example("soft_rings", 4e-3, 0.09, "Rings of rubber that collide and are pressed on each other.", fractions=(1, 0.5, 0.2, 0.05), because="Finer steps take minutes."),
         example("ironing", 2e-3, 0.05, "A cylinder pressed into soft rubber.", fractions=(1, 0.5, 0.2, 0.05), skip=("base",),
                 because="Reactions of an instant jump with the prescribed velocity. Finer steps take minutes.")]
