// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/joints/parts/configuration.hpp>

namespace polhode {

/// Distance l = |u| of two points over a step with the derivatives that a force along it needs: by
/// Δ(l²) = (u_n + u_{n+1})·Δu its discrete gradient is n = (u_n + u_{n+1})/(l_n + l_{n+1}).
/// @eq{spring-gradient}
struct LinkLength {
  double at_n = 0.0, at_n1 = 0.0;  ///< [m]
  Vec3 n = Vec3::Zero();           ///< Discrete gradient by u; 0 where both lengths are 0.
  Vec3 e = Vec3::Zero();           ///< Direction at t_{n+1}.

  LinkLength(const Configuration& q_n, const Configuration& q_n1)
      : at_n(q_n.u.norm()), at_n1(q_n1.u.norm()) {
    if (at_n + at_n1 > 0.0) n = (q_n.u + q_n1.u) / (at_n + at_n1);
    if (at_n1 > 0.0) e = q_n1.u / at_n1;
  }

  /// Row of a direction d of u, with the lever arms of q.
  static void row(const Vec3& d, const Configuration& q, PairRows G) {
    G.set(0, -d, -q.z_a.cross(d), d, q.z_b.cross(d));
  }

  /// Adds the tangent of a constant force along l: n rotates with u, and the lever arms rotate.
  void add_wrench_tangent(const Configuration& q_alpha, const Configuration& q_n1, double alpha_f,
                          double force, PairTerms& t) const {
    if (!(at_n + at_n1 > 0.0)) return;
    const Mat3 P = force / (at_n + at_n1) * (Mat3::Identity() - n * e.transpose());
    Eigen::Matrix<double, 3, 6> U_a, U_b;
    U_a << -Mat3::Identity(), hat(q_n1.z_a);
    U_b << Mat3::Identity(), -hat(q_n1.z_b);
    Eigen::Matrix<double, 6, 3> on_a, on_b;
    on_a << -P, -hat(q_alpha.z_a) * P;
    on_b << P, hat(q_alpha.z_b) * P;
    t.D_aa += on_a * U_a;
    t.D_ab += on_a * U_b;
    t.D_ba += on_b * U_a;
    t.D_bb += on_b * U_b;
    t.D_aa.bottomRightCorner<3, 3>() -= alpha_f * force * hat_hat(n, q_n1.z_a);
    t.D_bb.bottomRightCorner<3, 3>() += alpha_f * force * hat_hat(n, q_n1.z_b);
  }
};

}  // namespace polhode
