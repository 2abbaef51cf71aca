// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/dynamics/placement.hpp>
#include <polhode/system/pair_terms.hpp>

namespace polhode {

/// A pair's step in dual numbers with derivatives by its twelve increments, for constraints whose
/// tangents are long by hand.
class PairDuals {
 public:
  using Dual = contact::Dual;
  using Vector = contact::V3<Dual>;

  /// A vector or point at t_n and t_{n+1}.
  struct Moved {
    Vec3 at_n;
    Vector at_n1;
    /// Mean of both. @param weight  Of t_{n+1}.
    [[nodiscard]] Vector mean(double weight) const {
      return contact::v3((1.0 - weight) * at_n) + weight * at_n1;
    }
  };

  explicit PairDuals(const PairStep& step)
      : step_(step), a_(step.a.r_n1, step.a.Lambda_n1, 0), b_(step.b.r_n1, step.b.Lambda_n1, 6) {}

  [[nodiscard]] Moved vector_a(const Vec3& Z) const { return {step_.a.Lambda_n * Z, a_.vector(Z)}; }
  [[nodiscard]] Moved vector_b(const Vec3& Z) const { return {step_.b.Lambda_n * Z, b_.vector(Z)}; }
  [[nodiscard]] Moved point_a(const Vec3& Z) const {
    return {step_.a.r_n + step_.a.Lambda_n * Z, a_.point(Z)};
  }
  [[nodiscard]] Moved point_b(const Vec3& Z) const {
    return {step_.b.r_n + step_.b.Lambda_n * Z, b_.point(Z)};
  }
  /// Relative displacement over the step of the material points of b and of a at the same position,
  /// at mean lever arms from the centres of mass.
  [[nodiscard]] Vector slip(const Vector& arm_a, const Vector& arm_b) const {
    const contact::Motion<Dual> a(step_.a, 0), b(step_.b, 6);
    return (b.u + cross(b.theta, arm_b)) - (a.u + cross(a.theta, arm_a));
  }

  /// Adds a force on b at arm_b, and its opposite on a at arm_a, with all derivatives.
  void add(const Vector& force, const Vector& arm_a, const Vector& arm_b, PairTerms& t) const {
    add_side(force, cross(arm_b, force), 1.0, t.wrench_b, t.D_ba, t.D_bb);
    add_side(force, cross(arm_a, force), -1.0, t.wrench_a, t.D_aa, t.D_ab);
  }
  /// Adds a moment on b and its opposite on a.
  void add_couple(const Vector& moment, PairTerms& t) const {
    add_side({}, moment, 1.0, t.wrench_b, t.D_ba, t.D_bb);
    add_side({}, moment, -1.0, t.wrench_a, t.D_aa, t.D_ab);
  }
  /// Sets value, row and column of a constraint whose multiplier is a force along `direction` and a
  /// moment along `couple`.
  void set_row(int row, const Dual& g, const Vector& direction, const Vector& arm_a,
               const Vector& arm_b, PairTerms& t, const Vec3& couple = Vec3::Zero()) const {
    const Vec3 d = contact::value(direction);
    t.g[row] = g.v;
    t.B_a.col(row) << -d, -contact::value(arm_a).cross(d) - couple;
    t.B_b.col(row) << d, contact::value(arm_b).cross(d) + couple;
    if (!step_.context.tangents) return;
    for (int k = 0; k < 6; ++k) {
      t.G_a(row, k) = g.d[k];
      t.G_b(row, k) = g.d[6 + k];
    }
  }

 private:
  void add_side(const Vector& force, const Vector& moment, double sign, Vec6& wrench, Mat6& by_a,
                Mat6& by_b) const {
    const Dual* of[6] = {&force.x, &force.y, &force.z, &moment.x, &moment.y, &moment.z};
    for (int i = 0; i < 6; ++i) {
      wrench[i] += sign * of[i]->v;
      if (!step_.context.tangents) continue;
      for (int k = 0; k < 6; ++k) {
        by_a(i, k) += sign * of[i]->d[k];
        by_b(i, k) += sign * of[i]->d[6 + k];
      }
    }
  }

  const PairStep& step_;
  contact::Placement<Dual> a_, b_;
};

}  // namespace polhode
