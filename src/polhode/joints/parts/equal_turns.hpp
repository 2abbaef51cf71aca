// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/joints/parts/orthogonal_axes.hpp>

namespace polhode {

/// Constraint of equal rotations of both sides about their own z axes: g = x_a·y_b − y_a·x_b = 0
/// [-]. @eq{joint-equal-turns}
///
/// The rotation that takes the axes of a to those of b then has its axis in the plane that bisects
/// the angle between the two shafts: their speeds are equal in each position. The multiplier is
/// half the moment [N m] about the mean shaft, at aligned shafts.
struct EqualTurns {
  static constexpr int kRows = 1;

  static void residual(const Configuration& q, double* g) {
    double other = 0.0;
    kFirst.residual(q, g);
    kSecond.residual(q, &other);
    *g -= other;
  }

  /// ∂g = (x_a × y_b − y_a × x_b)·(∂θ_a − ∂θ_b).
  static void gradient(const Configuration& q, int row, PairRows G) {
    const Vec3 m = q.R_a.col(0).cross(q.R_b.col(1)) - q.R_a.col(1).cross(q.R_b.col(0));
    G.set(row, Vec3::Zero(), m, Vec3::Zero(), -m);
  }

  static void add_wrench_tangent(const Configuration& q_alpha, const Configuration& q_n1,
                                 double alpha_f, const double* lambda, PairTerms& t) {
    const double opposite = -*lambda;
    kFirst.add_wrench_tangent(q_alpha, q_n1, alpha_f, lambda, t);
    kSecond.add_wrench_tangent(q_alpha, q_n1, alpha_f, &opposite, t);
  }

  static void acceleration_terms(const Configuration& q, const SideRates& w, double* gamma) {
    double other = 0.0;
    kFirst.acceleration_terms(q, w, gamma);
    kSecond.acceleration_terms(q, w, &other);
    *gamma -= other;
  }

 private:
  static constexpr OrthogonalAxes kFirst{0, 1}, kSecond{1, 0};
};

}  // namespace polhode
