# SPDX-License-Identifier: Apache-2.0
"""The limit load of Lee's frame by shooting along Reissner's plane beam, independent of Polhode.

S.-L. Lee, F. S. Manuel, E. C. Rossow: Large deflections and stability of elastic frames, Journal of the Engineering
Mechanics Division ASCE 94 (1968) 521-547. Two legs of 1.2 m at a right angle, hinged at both far ends; the load pushes
down on the second leg, a fifth of its length from the corner. Section 0.3 m wide and 20 mm high, E = 7.2 GPa,
nu = 0.3, so that nothing moves out of the plane.

    python3 tools/references/lee_frame.py
"""
import math

LEG, LOADED, STEPS = 1.2, 0.24, 400
E, NU, WIDE, HIGH = 7.2e9, 0.3, 0.3, 0.02
EA, EI = E * WIDE * HIGH, E * WIDE * HIGH**3 / 12
SHEAR_FACTOR = 10 * (1 + NU) / (12 + 11 * NU)  # Cowper, of a rectangle
GA = SHEAR_FACTOR * E / (2 * (1 + NU)) * WIDE * HIGH


def rate(state, force, turned):
    """Integration along the beam: position, angle and moment; `turned` is the leg's own direction, `force` the force of the far part."""
    _, _, angle, moment = state
    c, s = math.cos(angle + turned), math.sin(angle + turned)
    normal, shear = force[0] * c + force[1] * s, -force[0] * s + force[1] * c
    along, across = 1 + normal / EA, shear / GA
    dx, dz = along * c - across * s, along * s + across * c
    return dx, dz, moment / EI, force[0] * dz - force[1] * dx


def march(state, force, turned, length, steps):
    h = length / steps
    for _ in range(steps):
        k1 = rate(state, force, turned)
        k2 = rate([x + h / 2 * k for x, k in zip(state, k1)], force, turned)
        k3 = rate([x + h / 2 * k for x, k in zip(state, k2)], force, turned)
        k4 = rate([x + h * k for x, k in zip(state, k3)], force, turned)
        state = [x + h / 6 * (a + 2 * b + 2 * c + d) for x, a, b, c, d in zip(state, k1, k2, k3, k4)]
    return state


def shoot(unknowns, sinks):
    """Errors of the far end and of the load's displacement, as a function of the foot's angle and force and of the load."""
    angle, fx, fz, load = unknowns[0], *(1e4 * u for u in unknowns[1:])
    state = march([0.0, 0.0, angle, 0.0], (fx, fz), math.pi / 2, LEG, STEPS)
    state = march(state, (fx, fz), 0.0, LOADED, STEPS // 4)
    down = LEG - state[1]
    state = march(state, (fx, fz + load), 0.0, LEG - LOADED, STEPS)
    return [state[0] - LEG, state[1] - LEG, state[3] / EI, down - sinks]


def solve(guess, sinks):
    x = list(guess)
    for _ in range(30):
        r = shoot(x, sinks)
        if max(map(abs, r)) < 1e-13:
            break
        columns = []
        for k in range(4):
            y = list(x)
            y[k] += 1e-7
            columns.append([(a - b) / 1e-7 for a, b in zip(shoot(y, sinks), r)])
        rows = [[columns[k][i] for k in range(4)] + [-r[i]] for i in range(4)]
        for i in range(4):  # Gauss with pivots
            p = max(range(i, 4), key=lambda j: abs(rows[j][i]))
            rows[i], rows[p] = rows[p], rows[i]
            for j in range(4):
                if j != i:
                    f = rows[j][i] / rows[i][i]
                    rows[j] = [a - f * b for a, b in zip(rows[j], rows[i])]
        x = [a + rows[i][4] / rows[i][i] for i, a in enumerate(x)]
    return x


def main():
    x, path = [0.0, 0.0, 0.0, 0.0], []
    for k in range(1, 40):
        x = solve(x, 0.015 * k)
        path.append((1e4 * x[3], 0.015 * k))
        if len(path) > 2 and path[-1][0] < path[-2][0]:
            break
    low, high = path[-3][1], path[-1][1]
    for _ in range(40):  # golden section
        a, b = high - 0.618034 * (high - low), low + 0.618034 * (high - low)
        if solve(x, a)[3] > solve(x, b)[3]:
            high = b
        else:
            low = a
    print(f"limit load {1e4 * solve(x, 0.5 * (low + high))[3]:.2f} N, load down by {0.5 * (low + high):.5f} m")


if __name__ == "__main__":
    main()
