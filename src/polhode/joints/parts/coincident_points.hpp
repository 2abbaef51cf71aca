// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/joints/parts/configuration.hpp>

namespace polhode {

/// Constraint that a point of a and a point of b coincide: g = x_b − x_a = 0 [m].
/// @eq{joint-coincident}
///
/// The multiplier is the force [N] on b at the joint point; its opposite acts on a.
struct CoincidentPoints {
  static constexpr int kRows = 3;

  static void residual(const Configuration& q, double* g) {
    for (int i = 0; i < 3; ++i) g[i] = q.u[i];
  }

  /// ∂g = −∂r_a + ẑ_a ∂θ_a + ∂r_b − ẑ_b ∂θ_b.
  static void gradient(const Configuration& q, int row, PairRows G) {
    for (int i = 0; i < 3; ++i) {
      const Vec3 e = Vec3::Unit(i);
      G.set(row + i, -e, -q.z_a.cross(e), e, q.z_b.cross(e));
    }
  }

  /// Adds the tangent of the lever arms, which rotate with their bodies. @eq{ga-moment-tangent}
  static void add_wrench_tangent(const Configuration&, const Configuration& q_n1, double alpha_f,
                                 const double* lambda, PairTerms& t) {
    const Vec3 f(lambda[0], lambda[1], lambda[2]);
    t.D_bb.bottomRightCorner<3, 3>() += alpha_f * hat_hat(f, q_n1.z_b);
    t.D_aa.bottomRightCorner<3, 3>() -= alpha_f * hat_hat(f, q_n1.z_a);
  }

  static Vec3 acceleration(const Configuration& q, const SideRates& w) {
    return w.omega_b.cross(w.omega_b.cross(q.z_b)) - w.omega_a.cross(w.omega_a.cross(q.z_a));
  }

  static void acceleration_terms(const Configuration& q, const SideRates& w, double* gamma) {
    const Vec3 a = acceleration(q, w);
    for (int i = 0; i < 3; ++i) gamma[i] = a[i];
  }
};

}  // namespace polhode
