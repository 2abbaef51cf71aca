// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/joints/parts/configuration.hpp>

namespace polhode {

/// Constraint that a joint axis d of a is orthogonal to an axis e of b: g = d·e = 0 [-].
/// @eq{joint-orthogonal}
///
/// The multiplier is a moment [N m] about d × e, positive on a.
struct OrthogonalAxes {
  static constexpr int kRows = 1;
  int of_a = 0, of_b = 1;  ///< Columns of R_a and of R_b.

  void residual(const Configuration& q, double* g) const { *g = d(q).dot(e(q)); }

  /// ∂g = (d × e)·(∂θ_a − ∂θ_b).
  void gradient(const Configuration& q, int row, PairRows G) const {
    const Vec3 m = d(q).cross(e(q));
    G.set(row, Vec3::Zero(), m, Vec3::Zero(), -m);
  }

  void add_wrench_tangent(const Configuration& q_alpha, const Configuration& q_n1, double alpha_f,
                          const double* lambda, PairTerms& t) const {
    const double l = alpha_f * *lambda;
    const Mat3 by_a = l * hat_hat(e(q_alpha), d(q_n1));
    const Mat3 by_b = l * hat_hat(d(q_alpha), e(q_n1));
    t.D_aa.bottomRightCorner<3, 3>() += by_a;
    t.D_ab.bottomRightCorner<3, 3>() -= by_b;
    t.D_ba.bottomRightCorner<3, 3>() -= by_a;
    t.D_bb.bottomRightCorner<3, 3>() += by_b;
  }

  void acceleration_terms(const Configuration& q, const SideRates& w, double* gamma) const {
    const Vec3 d_dot = w.omega_a.cross(d(q)), e_dot = w.omega_b.cross(e(q));
    *gamma = 2.0 * d_dot.dot(e_dot) + w.omega_a.cross(d_dot).dot(e(q)) +
             d(q).dot(w.omega_b.cross(e_dot));
  }

 private:
  [[nodiscard]] Vec3 d(const Configuration& q) const { return q.R_a.col(of_a); }
  [[nodiscard]] Vec3 e(const Configuration& q) const { return q.R_b.col(of_b); }
};

}  // namespace polhode
