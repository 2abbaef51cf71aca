// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/core/types.hpp>

namespace polhode {

/// Kinetic energy ½ m ṙ·ṙ + ½ ω·J·ω [J]; J and ω either both spatial or both material.
[[nodiscard]] inline double kinetic_energy(double mass, const Mat3& J, const Vec3& r_dot,
                                           const Vec3& omega) {
  return 0.5 * mass * r_dot.squaredNorm() + 0.5 * omega.dot(J * omega);
}

/// Power of the rates of momentum, ṙ·ṗ + ω·ḣ [W]: the rate of the kinetic energy, and the power of
/// the external force and moment. With δr and δθ instead of the velocities it is the inertial part
/// of the virtual work. @eq{eq:rbm-virtual-work}
[[nodiscard]] inline double power(const Vec3& r_dot, const Vec3& omega, const Vec3& f,
                                  const Vec3& m) {
  return r_dot.dot(f) + omega.dot(m);
}

}  // namespace polhode
