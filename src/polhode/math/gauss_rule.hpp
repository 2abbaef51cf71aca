// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <utility>

namespace polhode {

/// Gauss's rule of five points on [0, 1], as positions and weights: exact to degree nine
/// (Abramowitz and Stegun, Handbook of Mathematical Functions, 1964, table 25.4).
inline constexpr std::array<std::pair<double, double>, 5> kGauss{
    {{0.046910077030668004, 0.118463442528094544},
     {0.230765344947158454, 0.239314335249683234},
     {0.5, 0.284444444444444444},
     {0.769234655052841546, 0.239314335249683234},
     {0.953089922969331996, 0.118463442528094544}}};

}  // namespace polhode
