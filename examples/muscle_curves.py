# SPDX-License-Identifier: Apache-2.0
"""Curves of muscles over the optimal length of fibres, for the checks of the examples: De Groote, Kinney, Rao, Fregly (2016)."""
import math

VMAX = 10.0                                                   # optimal lengths a second


def active(length):
    """De Groote et al. (2016), the force-length curve: a sum of three bell-shaped functions."""
    bells = ((0.815, 1.055, 0.162, 0.063), (0.433, 0.717, -0.030, 0.200), (0.100, 1.000, 0.354, 0.0))
    return sum(a * math.exp(-0.5 * ((length - b) / (c + d * length)) ** 2) for a, b, c, d in bells)


def passive(length):
    return math.expm1(4.0 * (length - 1) / 0.6) / math.expm1(4.0)


def speed_factor(v):
    """The same paper's force-velocity curve, scaled to be 1 at rest and 0 at full speed of shortening."""
    shape = lambda u: math.asinh(-8.149 * u - 0.374)  # noqa: E731
    return (shape(v) - shape(-1.0)) / (shape(0.0) - shape(-1.0))
