// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/joints/parts/coincident_points.hpp>

namespace polhode {

/// Constraint of a constant distance L of two points: g = (u·u − L²)/(2L) = 0 with u = x_b − x_a
/// [m]. @eq{joint-distance}
///
/// Quadratic, unlike |u| − L, and equal to it to first order. The multiplier is the repulsive force
/// [N] between the points (at |u| = L).
struct Distance {
  static constexpr int kRows = 1;
  double length = 1.0;  ///< L [m]; positive.

  void residual(const Configuration& q, double* g) const {
    *g = 0.5 * (q.u.squaredNorm() - length * length) / length;
  }

  /// ∂g = (u/L)·(∂x_b − ∂x_a).
  void gradient(const Configuration& q, int row, PairRows G) const {
    const Vec3 n = q.u / length;
    G.set(row, -n, -q.z_a.cross(n), n, q.z_b.cross(n));
  }

  /// Adds the tangent: the force F = λ u_α/L on b follows u, and the lever arms rotate.
  void add_wrench_tangent(const Configuration& q_alpha, const Configuration& q_n1, double alpha_f,
                          const double* lambda, PairTerms& t) const {
    const double l = alpha_f * *lambda / length;
    const Mat3 E = l * Mat3::Identity();
    const Mat3 a_n1 = hat(q_n1.z_a), b_n1 = hat(q_n1.z_b);
    const Mat3 a_alpha = l * hat(q_alpha.z_a), b_alpha = l * hat(q_alpha.z_b);
    t.D_bb.topLeftCorner<3, 3>() += E;
    t.D_ba.topLeftCorner<3, 3>() -= E;
    t.D_ab.topLeftCorner<3, 3>() -= E;
    t.D_aa.topLeftCorner<3, 3>() += E;
    t.D_bb.topRightCorner<3, 3>() -= l * b_n1;
    t.D_ba.topRightCorner<3, 3>() += l * a_n1;
    t.D_ab.topRightCorner<3, 3>() += l * b_n1;
    t.D_aa.topRightCorner<3, 3>() -= l * a_n1;
    t.D_bb.bottomLeftCorner<3, 3>() += b_alpha;
    t.D_ba.bottomLeftCorner<3, 3>() -= b_alpha;
    t.D_ab.bottomLeftCorner<3, 3>() -= a_alpha;
    t.D_aa.bottomLeftCorner<3, 3>() += a_alpha;
    t.D_bb.bottomRightCorner<3, 3>() += l * hat_hat(q_alpha.u, q_n1.z_b) - b_alpha * b_n1;
    t.D_ba.bottomRightCorner<3, 3>() += b_alpha * a_n1;
    t.D_ab.bottomRightCorner<3, 3>() += a_alpha * b_n1;
    t.D_aa.bottomRightCorner<3, 3>() -= l * hat_hat(q_alpha.u, q_n1.z_a) + a_alpha * a_n1;
  }

  void acceleration_terms(const Configuration& q, const SideRates& w, double* gamma) const {
    *gamma = (w.u_dot.squaredNorm() + q.u.dot(CoincidentPoints::acceleration(q, w))) / length;
  }
};

}  // namespace polhode
