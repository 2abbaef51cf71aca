// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include <polhode/joints/parts/orthogonal_axes.hpp>

namespace polhode {

/// Quadratic rows that vanish where both sides rotate equally about their own z axes.
///
/// With the quaternion (w, x, y, z) of the relative rotation they are −4wz, −4xz and −4yz, which
/// all vanish with z alone. @eq{joint-equal-turns}
struct TurnRow {
  OrthogonalAxes first, second;
  double of_first = 1.0, of_second = -1.0;

  [[nodiscard]] double value(const Configuration& q) const {
    double f = 0.0, s = 0.0;
    first.residual(q, &f);
    second.residual(q, &s);
    return of_first * f + of_second * s;
  }

  /// Moment m of ∂g = m·(∂θ_a − ∂θ_b).
  [[nodiscard]] Vec3 moment(const Configuration& q) const {
    const auto cross = [&](const OrthogonalAxes& of) {
      return q.R_a.col(of.of_a).cross(q.R_b.col(of.of_b));
    };
    return of_first * cross(first) + of_second * cross(second);
  }

  void add_wrench_tangent(const Configuration& q_alpha, const Configuration& q_n1, double alpha_f,
                          double lambda, PairTerms& t) const {
    const double f = of_first * lambda, s = of_second * lambda;
    first.add_wrench_tangent(q_alpha, q_n1, alpha_f, &f, t);
    second.add_wrench_tangent(q_alpha, q_n1, alpha_f, &s, t);
  }

  [[nodiscard]] double acceleration_term(const Configuration& q, const SideRates& w) const {
    double f = 0.0, s = 0.0;
    first.acceleration_terms(q, w, &f);
    second.acceleration_terms(q, w, &s);
    return of_first * f + of_second * s;
  }
};

inline constexpr std::array<TurnRow, 3> kTurnRows{
    {{{0, 1}, {1, 0}, 1.0, -1.0}, {{0, 2}, {2, 0}, -1.0, -1.0}, {{1, 2}, {2, 1}, -1.0, -1.0}}};

/// The vector 4 (w, x, y) ((w, x, y)·s) of the relative rotation, for a reference s: linear in the
/// entries of M = R_aᵀ R_b, and without the sign that a quaternion leaves open.
[[nodiscard]] inline Vec3 bend_along(const Mat3& M, const Vec3& s) {
  const double wx = M(2, 1) - M(1, 2), wy = M(0, 2) - M(2, 0), xy = M(0, 1) + M(1, 0);
  return {s[0] * (1.0 + M(0, 0) + M(1, 1) + M(2, 2)) + s[1] * wx + s[2] * wy,
          s[0] * wx + s[1] * (1.0 + M(0, 0) - M(1, 1) - M(2, 2)) + s[2] * xy,
          s[0] * wy + s[1] * xy + s[2] * (1.0 - M(0, 0) + M(1, 1) - M(2, 2))};
}

/// Unit vector along (w, x, y) on the side of s. Of averaged rotations, whose M is none, the second
/// product leaves a dependence on s of fourth order in the step.
[[nodiscard]] inline Vec3 bend_towards(const Mat3& M, const Vec3& s) {
  const Vec3 p = bend_along(M, bend_along(M, s));
  const double length = p.norm();
  return length > 0.0 ? Vec3(p / length) : s;
}

/// Unit vector along (w, x, y) without any reference: the first of its components that is large
/// is positive.
[[nodiscard]] inline Vec3 bend_of(const Mat3& M) {
  Vec3 largest = Vec3::Zero();
  for (int k = 0; k < 3; ++k) {
    const Vec3 p = bend_along(M, Vec3::Unit(k));
    if (p.norm() > 1.01 * largest.norm()) largest = p;
  }
  return largest.normalized();
}

/// Constraint of equal rotations of both sides about their own z axes, at any angle between the
/// shafts: g = c·(g₁, g₂, g₃) = 0 [-], with the rows of kTurnRows and c along (w, x, y), which
/// never vanishes. @eq{joint-equal-turns}
///
/// The rotation that takes the axes of a to those of b then has its axis in the plane that bisects
/// the angle between the two shafts: their speeds are equal in each position. The multiplier is
/// half the moment [N m] about the mean shaft. None of the three rows does work in a step whose
/// ends both satisfy them, and so no combination does.
struct EqualTurns {
  static constexpr int kRows = 1;

  static void residual(const Configuration& q, double* g) {
    const Vec3 c = weights(q);
    *g = 0.0;
    for (int i = 0; i < 3; ++i) *g += c[i] * kTurnRows[static_cast<std::size_t>(i)].value(q);
  }

  /// Rows of ∂g at an instant, where c·∂c = 0 and (g₁, g₂, g₃) is along c.
  static void gradient(const Configuration& q, int row, PairRows G) {
    const Vec3 m = moment(q, weights(q));
    G.set(row, Vec3::Zero(), m, Vec3::Zero(), -m);
  }

  static void add_wrench_tangent(const Configuration& q_alpha, const Configuration& q_n1,
                                 double alpha_f, const double* lambda, PairTerms& t) {
    const Mat3 M = q_alpha.R_a.transpose() * q_alpha.R_b;
    const Vec3 once = bend_along(M, q_alpha.bend);
    const double length = bend_along(M, once).norm();
    const Vec3 c = weights(q_alpha);
    Mat3 moments;  // m_i as columns
    for (int i = 0; i < 3; ++i) {
      const TurnRow& row = kTurnRows[static_cast<std::size_t>(i)];
      row.add_wrench_tangent(q_alpha, q_n1, alpha_f, c[i] * *lambda, t);
      moments.col(i) = row.moment(q_alpha);
    }
    if (!(length > 0.0)) return;
    Mat3 S;
    for (int k = 0; k < 3; ++k) S.col(k) = bend_along(M, Vec3::Unit(k));
    const BendRates first(q_alpha, q_n1, q_alpha.bend), second(q_alpha, q_n1, once);
    const Mat3 turned =
        alpha_f * *lambda / length * moments * (Mat3::Identity() - c * c.transpose());
    const Mat3 by_a = turned * (second.by_a + S * first.by_a);
    const Mat3 by_b = turned * (second.by_b + S * first.by_b);
    t.D_aa.bottomRightCorner<3, 3>() += by_a;
    t.D_ab.bottomRightCorner<3, 3>() += by_b;
    t.D_ba.bottomRightCorner<3, 3>() -= by_a;
    t.D_bb.bottomRightCorner<3, 3>() -= by_b;
  }

  /// γ where g and its rate vanish: changes of c contribute nothing.
  static void acceleration_terms(const Configuration& q, const SideRates& w, double* gamma) {
    const Vec3 c = weights(q);
    *gamma = 0.0;
    for (int i = 0; i < 3; ++i)
      *gamma += c[i] * kTurnRows[static_cast<std::size_t>(i)].acceleration_term(q, w);
  }

 private:
  [[nodiscard]] static Vec3 weights(const Configuration& q) {
    return bend_towards(q.R_a.transpose() * q.R_b, q.bend);
  }

  [[nodiscard]] static Vec3 moment(const Configuration& q, const Vec3& c) {
    return c[0] * kTurnRows[0].moment(q) + c[1] * kTurnRows[1].moment(q) +
           c[2] * kTurnRows[2].moment(q);
  }

  /// Derivatives of bend_along for a fixed s by the rotations at t_{n+1}, without α_f.
  struct BendRates {
    Mat3 by_a = Mat3::Zero(), by_b = Mat3::Zero();

    BendRates(const Configuration& q_alpha, const Configuration& q_n1, const Vec3& s) {
      const Vec3 constant = bend_along(Mat3::Zero(), s);
      for (int j = 0; j < 3; ++j)
        for (int l = 0; l < 3; ++l) {
          const Vec3 by_entry = bend_along(Vec3::Unit(j) * Vec3::Unit(l).transpose(), s) - constant;
          by_a += by_entry * q_n1.R_a.col(j).cross(q_alpha.R_b.col(l)).transpose();
          by_b += by_entry * q_n1.R_b.col(l).cross(q_alpha.R_a.col(j)).transpose();
        }
    }
  };
};

/// The three rows of equal turns as springs: their energy 8 k z² (1 − z²) is that of a spring whose
/// stiffness k does not depend on the angle between the shafts. @eq{joint-equal-turns}
struct EqualTurnsSprings {
  static constexpr int kRows = 3;

  static void residual(const Configuration& q, double* g) {
    for (const TurnRow& row : kTurnRows) *g++ = row.value(q);
  }
  static void gradient(const Configuration& q, int first, PairRows G) {
    for (const TurnRow& row : kTurnRows) {
      const Vec3 m = row.moment(q);
      G.set(first++, Vec3::Zero(), m, Vec3::Zero(), -m);
    }
  }
  static void add_wrench_tangent(const Configuration& q_alpha, const Configuration& q_n1,
                                 double alpha_f, const double* lambda, PairTerms& t) {
    for (const TurnRow& row : kTurnRows)
      row.add_wrench_tangent(q_alpha, q_n1, alpha_f, *lambda++, t);
  }
  static void acceleration_terms(const Configuration& q, const SideRates& w, double* gamma) {
    for (const TurnRow& row : kTurnRows) *gamma++ = row.acceleration_term(q, w);
  }
};

}  // namespace polhode
