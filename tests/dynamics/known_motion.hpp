// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include <polhode/dynamics/point_motion.hpp>
#include <polhode/math/exp_map.hpp>

namespace polhode::test {

/// A smooth motion with everything known: the body turns by a(t) about a fixed axis and by b(t)
/// about an axis of its own, while its centre of mass runs along a curve.
struct KnownMotion {
  Vec3 n = Vec3(1.0, 2.0, -1.0).normalized();  ///< Fixed in space.
  Vec3 N = Vec3(-0.5, 0.3, 1.0).normalized();  ///< Fixed in the body.

  static double a(double t) { return 0.4 + 1.1 * t + 0.5 * std::sin(2.0 * t); }
  static double a_dot(double t) { return 1.1 + std::cos(2.0 * t); }
  static double a_ddot(double t) { return -2.0 * std::sin(2.0 * t); }
  static double b(double t) { return 1.3 * t - 0.2 * t * t * t; }
  static double b_dot(double t) { return 1.3 - 0.6 * t * t; }
  static double b_ddot(double t) { return -1.2 * t; }

  [[nodiscard]] Pose pose(double t) const {
    return {.r = {std::cos(t), 0.3 * t * t, std::sin(3.0 * t)},
            .Lambda = exp_map(a(t) * n) * exp_map(b(t) * N)};
  }
  [[nodiscard]] Velocities velocities(double t) const {
    // Λ = exp(a n̂) exp(b N̂): the second axis turns with the first rotation.
    const Vec3 carried = exp_map(a(t) * n) * N;
    return {.r_dot = {-std::sin(t), 0.6 * t, 3.0 * std::cos(3.0 * t)},
            .omega = a_dot(t) * n + b_dot(t) * carried};
  }
  [[nodiscard]] Accelerations accelerations(double t) const {
    const Vec3 carried = exp_map(a(t) * n) * N;
    return {.r_ddot = {-std::cos(t), 0.6, -9.0 * std::sin(3.0 * t)},
            .alpha = a_ddot(t) * n + b_ddot(t) * carried + b_dot(t) * a_dot(t) * n.cross(carried)};
  }
};

}  // namespace polhode::test
