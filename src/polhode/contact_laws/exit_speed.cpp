// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <polhode/contact_laws/exit_speed.hpp>

namespace polhode::contact {

namespace {

/// Largest part of the approach speed that an overlapping point may return to separate. With at
/// most half of it the next step dissipates at least what this one adds.
constexpr double kComesFree = 0.5;

}  // namespace

/// A landing point is slowed down so that it reaches gap 0 in the next step. A rebounding point
/// does so in the step after which it would be too close. Both keep p_n (w_n + w_{n+1}) from being
/// positive.
double least_exit_speed(double gap, double w, double restitution, double dt, double slow) {
  const double land = -0.5 * w - gap / dt;
  if (w >= 0.0) return std::min(land, -w);
  const double back = -restitution * w;
  if (restitution == 0.0 || (restitution < 1.0 && back < slow))
    return std::min(land, -kComesFree * w);
  return gap < -(1.5 - 0.5 * restitution) * w * dt ? back : -w - 2.0 * gap / dt;
}

}  // namespace polhode::contact
