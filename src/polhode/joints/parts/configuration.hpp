// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/math/hat.hpp>
#include <polhode/system/pair_terms.hpp>

namespace polhode {

/// Configuration of the two sides of a joint at one time: world components, all that a part needs.
///
/// At t_{n+αf} everything is the average of its values at t_n and t_{n+1}, so the directions
/// are shorter than one and not quite orthogonal; the parts are quadratic, and their gradients
/// at the averages do exactly the work of the step (docs/theory/joints.md).
struct Configuration {
  Vec3 u;         ///< Offset x_b − x_a between the joint points [m].
  Vec3 z_a, z_b;  ///< Lever arms from the centres of mass to the joint points [m].
  Mat3 R_a, R_b;  ///< Joint axes x, y, z of each side as columns [-].
  Vec3 bend =
      Vec3::UnitX();  ///< Of EqualTurns: (w, x, y) of the quaternion of an earlier position.

  /// From the centre of mass of a to the joint point of b [m].
  [[nodiscard]] Vec3 y() const { return u + z_a; }
};

/// Velocities of the sides of a joint at one instant, world components.
struct SideRates {
  Vec3 omega_a, omega_b;  ///< Angular velocities [rad/s].
  Vec3 u_dot;             ///< ẋ_b − ẋ_a [m/s].
};

/// Rows of the derivative of g, one row a 6-vector (Δr, Δθ) for each body.
///
/// The same rows evaluated at t_{n+αf} are the columns of B: wrench per unit of multiplier.
struct PairRows {
  double* a;  ///< 6 numbers per row, rows consecutive.
  double* b;

  void set(int row, const Vec3& a_r, const Vec3& a_theta, const Vec3& b_r, const Vec3& b_theta) {
    put(a + 6 * row, a_r, a_theta);
    put(b + 6 * row, b_r, b_theta);
  }

 private:
  static void put(double* to, const Vec3& r, const Vec3& theta) {
    to[0] = r.x(), to[1] = r.y(), to[2] = r.z();
    to[3] = theta.x(), to[4] = theta.y(), to[5] = theta.z();
  }
};

}  // namespace polhode
