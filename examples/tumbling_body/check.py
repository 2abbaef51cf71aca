# SPDX-License-Identifier: Apache-2.0
"""The angular velocity against Jacobi's elliptic functions (Landau and Lifshitz, Mechanics, section 37)."""
import math
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from support import ROUND_OFF, Report, Run, angular_velocity, dot, step_error, subtract  # noqa: E402

SPIN, NUDGE = 10.0, 0.1


def moments():
    """About x, y, z through the centre of mass: two cylinders of one density, whose volumes may overlap."""
    r, bar, shaft = 0.005, 0.08, 0.05
    m_bar, m_shaft = (7800 * math.pi * r**2 * length for length in (bar, shaft))
    c = m_shaft * shaft / 2 / (m_bar + m_shaft)

    def across(m, length):
        return m * (3 * r**2 + length**2) / 12

    def along(m):
        return m * r**2 / 2

    off = m_bar * c**2 + m_shaft * (shaft / 2 - c) ** 2
    return (across(m_bar, bar) + along(m_shaft), along(m_bar) + across(m_shaft, shaft) + off,
            across(m_bar, bar) + across(m_shaft, shaft) + off)


def means(m):
    """Arithmetic and geometric means of 1 and sqrt(1 - m), until they agree."""
    a, b = [1.0], [math.sqrt(1 - m)]
    while abs(a[-1] - b[-1]) > 1e-16 * a[-1] and len(a) < 12:
        a, b = a + [(a[-1] + b[-1]) / 2], b + [math.sqrt(a[-1] * b[-1])]
    return a, b


def quarter_period(m):
    return math.pi / 2 / means(m)[0][-1]


def first_kind(phi, m):
    """Incomplete elliptic integral F(phi | m)."""
    a, b = means(m)
    for x, y in zip(a, b[:-1]):
        phi += math.atan(y / x * math.tan(phi)) + math.pi * math.floor(phi / math.pi + 0.5)
    return phi / (2 ** (len(a) - 1) * a[-1])


def amplitude(u, m):
    """Jacobi's am(u | m); sn and cn are its sine and cosine."""
    a, b = means(m)
    phi = 2 ** (len(a) - 1) * a[-1] * u
    for k in range(len(a) - 1, 0, -1):
        c = (a[k - 1] - b[k - 1]) / 2
        phi = (phi + math.asin(c / a[k] * math.sin(phi))) / 2
    return phi


def closed_form(J, times):
    """Angular velocities in body axes, the time of one turn-over, and the delay of the motion per turn-over by a
    relative change of the energy. Axis x is that of the middle moment."""
    Jx, Jy, Jz = J
    assert Jy < Jx < Jz
    T2 = Jx * SPIN**2 + (Jy + Jz) * NUDGE**2
    h2 = (Jx * SPIN) ** 2 + (Jy * NUDGE) ** 2 + (Jz * NUDGE) ** 2
    assert h2 > T2 * Jx  # The angular velocity circles about the axis of the largest moment, z.
    Ax = math.sqrt((T2 * Jz - h2) / (Jx * (Jz - Jx)))
    Ay = math.sqrt((T2 * Jz - h2) / (Jy * (Jz - Jy)))
    Az = math.sqrt((h2 - T2 * Jy) / (Jz * (Jz - Jy)))
    m = (Jx - Jy) * (T2 * Jz - h2) / ((Jz - Jx) * (h2 - T2 * Jy))
    rate = math.sqrt((Jz - Jx) * (h2 - T2 * Jy) / (Jx * Jy * Jz))
    # Ωy grows where Ωx and Ωz are positive: Jy Ωy' = (Jz - Jx) Ωz Ωx. So Ωx is cn-like from the other side: take
    # Ωx = Ax sn, Ωy = -Ay cn, Ωz = Az dn, for which (-cn)' = sn dn.
    u0 = first_kind(math.atan2(SPIN / Ax, -NUDGE / Ay), m)
    list_ = []
    for t in times:
        phi = amplitude(u0 + rate * t, m)
        list_.append((Ax * math.sin(phi), -Ay * math.cos(phi), Az * math.sqrt(1 - m * math.sin(phi) ** 2)))
    # Close to m = 1 a quarter period is log(4/sqrt(1 - m)), and m changes at most as the energy does, times h2/(..).
    change = h2 / abs(T2 * Jz - h2) + h2 / abs(h2 - T2 * Jy)
    return list_, 2 * quarter_period(m) / rate, change / (1 - m) / rate


def in_body_axes(run):
    tips = ("x_tip", "y_tip", "z_tip")
    omega = angular_velocity(run, "origin", tips)
    origin = run.points("origin")
    axes = [[subtract(a, b) for a, b in zip(run.points(tip), origin)] for tip in tips]
    return [tuple(dot(axis[i], w) for axis in axes) for i, w in enumerate(omega)]


def turn_over(times, omega_x):
    """Mean time between changes of sign of Ωx."""
    changes = [t0 + (t1 - t0) * a / (a - b)
               for t0, t1, a, b in zip(times, times[1:], omega_x, omega_x[1:]) if a * b < 0]
    return (changes[-1] - changes[0]) / (len(changes) - 1)


def main():
    report = Report()
    run = Run(HERE / "model.yaml")
    coarse = in_body_axes(Run(HERE / "model.yaml", "analysis.step=20 ms"))
    fine = in_body_axes(run)
    times = run.probe("origin")["t"]
    exact, time, delay = closed_form(moments(), times)
    # Rounding: the energy's drift times the delay, at every turn-over, times the largest rate of change.
    change = max(abs(b - a) for u, v in zip(exact, exact[1:]) for a, b in zip(u, v)) / (times[1] - times[0])
    drift = run.figures["energy_drift"] + run.figures["angular_momentum_drift"]
    tolerance = step_error(coarse, fine, 8, change * drift * delay * times[-1] / time)
    for i, axis in enumerate("xyz"):
        worst = max(range(len(times)), key=lambda k: abs(fine[k][i] - exact[k][i]))
        report.near(f"angular velocity about {axis} at {times[worst]:.2f} s [rad/s]", fine[worst][i], exact[worst][i],
                    tolerance)
    # The changes of sign are interpolated linearly in a table: h^2/8 of its curvature, which is small there.
    report.near("time of a turn-over [s]", turn_over(times, [w[0] for w in fine]), time, 1e-3)
    for figure in ("energy_drift", "angular_momentum_drift"):
        report.below(figure.replace("_", " "), run.figures[figure], ROUND_OFF)
    report.end()


main()
