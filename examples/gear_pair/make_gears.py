# SPDX-License-Identifier: Apache-2.0
"""Writes the meshes of the two gears, pinion.stl and wheel.stl, in millimetres. Change the numbers and run it again."""
import math

MODULE, PRESSURE = 6.0, math.radians(20)
ADDENDUM, DEDENDUM = 0.8 * MODULE, 1.25 * MODULE
BACKLASH = 0.1  # At the pitch circle, of both teeth together.
POINTS = 4  # On each flank.


def involute(radius, base):
    a = math.acos(min(1.0, base / radius))
    return math.tan(a) - a


def profile(teeth):
    """The outline of a gear, counterclockwise, a tooth centred on +x."""
    pitch = 0.5 * MODULE * teeth
    base, tip, root = pitch * math.cos(PRESSURE), pitch + ADDENDUM, pitch - DEDENDUM
    half = (math.pi * MODULE / 2 - BACKLASH / 2) / (2 * pitch)  # Half the tooth's angle at the pitch circle.
    flank = []
    for k in range(POINTS):
        r = base + (tip - base) * k / (POINTS - 1)
        flank.append((r, half + involute(pitch, base) - involute(r, base)))
    foot = 1.03 * flank[0][1]  # Slightly wider than the base, so that no side is radial.
    right = [(root, -foot)] + [(r, -a) for r, a in flank]
    left = [(r, a) for r, a in reversed(flank)] + [(root, foot)]
    return [(r * math.cos(a + 2 * math.pi * n / teeth), r * math.sin(a + 2 * math.pi * n / teeth))
            for n in range(teeth) for r, a in right + left]


def triangles(outline, width):
    """The outline extruded along z, closed by fans from the middle, from which the whole outline is visible."""
    low, high = -width / 2, width / 2
    for (x0, y0), (x1, y1) in zip(outline, outline[1:] + outline[:1]):
        a, b, c, d = (x0, y0, low), (x1, y1, low), (x1, y1, high), (x0, y0, high)
        yield from ((a, b, c), (a, c, d), ((0, 0, low), b, a), ((0, 0, high), d, c))


def write(name, teeth, width):
    with open(name, "w") as file:
        file.write(f"solid gear of {teeth} teeth\n")
        for corners in triangles(profile(teeth), width):
            u, v = ([b - a for a, b in zip(corners[0], corners[k])] for k in (1, 2))
            n = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
            size = math.sqrt(sum(x * x for x in n))
            file.write("facet normal {:.6f} {:.6f} {:.6f}\nouter loop\n".format(*(x / size for x in n)))
            for p in corners:
                file.write("vertex {:.6f} {:.6f} {:.6f}\n".format(*p))
            file.write("endloop\nendfacet\n")
        file.write("endsolid\n")


if __name__ == "__main__":
    write("pinion.stl", 18, 18)
    write("wheel.stl", 27, 20)
