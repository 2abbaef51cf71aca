// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/joints/parts/coincident_points.hpp>

namespace polhode {

/// Constraint that the point of b lies in the plane through the point of a with normal d fixed to
/// a: g = d·(x_b − x_a) = 0 [m]. @eq{joint-plane}
///
/// The multiplier is the force [N] on b along d.
struct PointInPlane {
  static constexpr int kRows = 1;
  int normal = 2;  ///< Column of R_a.

  void residual(const Configuration& q, double* g) const { *g = d(q).dot(q.u); }

  /// ∂g = d·(∂r_b − ∂r_a) + (z_b × d)·∂θ_b − (y × d)·∂θ_a with y = x_b − r_a.
  void gradient(const Configuration& q, int row, PairRows G) const {
    const Vec3 n = d(q);
    G.set(row, -n, -q.y().cross(n), n, q.z_b.cross(n));
  }

  void add_wrench_tangent(const Configuration& q_alpha, const Configuration& q_n1, double alpha_f,
                          const double* lambda, PairTerms& t) const {
    const double l = alpha_f * *lambda;
    const Vec3 d_alpha = d(q_alpha), d_n1 = d(q_n1);
    const Mat3 l_d_alpha = l * hat(d_alpha), l_d_n1 = l * hat(d_n1);
    t.D_bb.bottomRightCorner<3, 3>() += l * hat_hat(d_alpha, q_n1.z_b);
    t.D_ba.topRightCorner<3, 3>() -= l_d_n1;
    t.D_ba.bottomRightCorner<3, 3>() -= l * hat_hat(q_alpha.z_b, d_n1);
    t.D_aa.topRightCorner<3, 3>() += l_d_n1;
    t.D_aa.bottomLeftCorner<3, 3>() -= l_d_alpha;
    t.D_aa.bottomRightCorner<3, 3>() += l * hat_hat(q_alpha.y(), d_n1);
    t.D_ab.bottomLeftCorner<3, 3>() += l_d_alpha;
    t.D_ab.bottomRightCorner<3, 3>() -= l * hat_hat(d_alpha, q_n1.z_b);
  }

  void acceleration_terms(const Configuration& q, const SideRates& w, double* gamma) const {
    const Vec3 d_dot = w.omega_a.cross(d(q));
    *gamma = w.omega_a.cross(d_dot).dot(q.u) + 2.0 * d_dot.dot(w.u_dot) +
             d(q).dot(CoincidentPoints::acceleration(q, w));
  }

 private:
  [[nodiscard]] Vec3 d(const Configuration& q) const { return q.R_a.col(normal); }
};

}  // namespace polhode
