// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <limits>

#include <polhode/stepping/step_control.hpp>

namespace polhode::step_control {

/// Shortest length that is taken as a step. In a step τ the round-off of positions and of time has
/// the relative error ε T/τ in velocities, T the time in which a body covers its distance from the
/// origin: the time so far, or kFarAway steps where it was far at the start. Not to move for a time
/// τ has the error τ/H in the mean velocity of the next step. Both are equal at τ² = ε T H.
/// @eq{shortest-step}
/// @param t  Present time [s]. @param H  Usual length of steps [s].
[[nodiscard]] inline double shortest_step(double t, double H) {
  return std::sqrt(std::numeric_limits<double>::epsilon() * H * (std::abs(t) + kFarAway * H));
}

/// Length of at most dt, or a thousandth more, that divides a short remaining time into equal
/// parts. A tiny remainder is thus avoided, in which multipliers of the size of round-off/Δt² would
/// leak energy.
[[nodiscard]] inline double part_of(double way, double dt) {
  if (way > 2.0 * dt || std::abs(way - dt) <= kSameTime * dt) return dt;
  const double parts = std::ceil(way / dt - kStretch);
  const double part = parts > 1.0 ? way / parts : way;
  // equal to the last bit at any end time
  return std::abs(part - dt) <= kSameTime * dt ? dt : part;
}

/// End of a fixed step: t, or the multiple of H there if that is after the step's start.
[[nodiscard]] inline double on_grid(double t, double H, double start) {
  const double grid = std::round(t / H) * H;
  return std::abs(t - grid) < kSameTime * H && grid > start ? grid : t;
}

}  // namespace polhode::step_control
