// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <numbers>
#include <utility>

namespace polhode {

/// Angle plus the whole turns that bring it nearest to another one [rad].
inline double nearest_turn(double angle, double near) {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  return angle + kTurn * std::round((near - angle) / kTurn);
}

/// x / sin x, and its derivative.
inline std::pair<double, double> over_sine(double x) {
  if (std::abs(x) < 0.02) {
    const double y = x * x;
    return {1.0 + y * (1.0 / 6.0 + y * (7.0 / 360.0 + y * 31.0 / 15120.0)),
            x * (1.0 / 3.0 + y * (7.0 / 90.0 + y * 31.0 / 2520.0))};
  }
  const double s = std::sin(x);
  return {x / s, (s - x * std::cos(x)) / (s * s)};
}

}  // namespace polhode
