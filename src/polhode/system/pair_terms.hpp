// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/core/types.hpp>
#include <polhode/dynamics/body_step.hpp>

namespace polhode {

/// Largest number of multiplier rows of an interaction.
inline constexpr int kMaxRows = 6;

/// Terms of an interaction between bodies a and b in the current trial step.
///
/// Wrenches are (force [N], moment about the centre of mass [N m]), world components, at t_{n+αf};
/// increments are (Δr, Δθ), world. Without StepContext::tangents, D and G are not used. A
/// constraint's force on body i is +λ times its column B_i, and is part of the wrench; so are other
/// terms that depend on λ, such as friction, with their derivative in the column. All terms of the
/// ground stay zero and unused.
struct PairTerms {
  Vec6 wrench_a, wrench_b;      ///< Total, multipliers included.
  Mat6 D_aa, D_ab, D_ba, D_bb;  ///< D_ij: wrench of i by the increment of j.
  /// Column k: derivative of the wrench by multiplier k.
  Eigen::Matrix<double, 6, 6> B_a, B_b;
  Eigen::Matrix<double, 6, 6, Eigen::RowMajor> G_a, G_b;  ///< Row k: derivative of g_k at t_{n+1}.
  Vec6 g;                                                 ///< Constraint values at t_{n+1}.
  Vec6 compliance;  ///< Row k means g_k + compliance_k·λ_k = 0; 0 is exact.
  /// Factor on the proximal ε of exact rows, by default 1: among redundant rows a larger weight
  /// takes a smaller share. @eq{augmented-rows}
  Vec6 weight;

  void set_zero();
  /// Zeroes all but B and G, whose columns and rows are filled by an interaction with multipliers.
  void set_sums_zero();
  void set_values_zero();  ///< Only wrenches, values and compliance.
};

/// View of the step for one interaction.
struct PairStep {
  const BodyStep& a;
  const BodyStep& b;
  const StepContext& context;
  const double* lambda;   ///< Current multipliers, rows() of them; null: see acts_beside_rows().
  const double* history;  ///< Stored by commit() at t_n.
};

/// Zeroes the terms of sides that are the ground, so that items need no special case.
void clear_ground_sides(const PairStep& step, PairTerms& terms);

/// Work of an interaction over the step just accepted.
struct Work {
  double stored = 0.0;      ///< Potential energy at t_{n+1} [J].
  double dissipated = 0.0;  ///< Over the step [J]; never negative.
  double put_in = 0.0;      ///< Work of loads over the step [J].

  Work& operator+=(const Work& w) {
    stored += w.stored;
    dissipated += w.dissipated;
    put_in += w.put_in;
    return *this;
  }
};

/// Relative velocity J v of an impact at the end of a step, where velocities may jump.
/// @eq{turn-law} @eq{impact-friction}
struct Impact {
  Vec6 on_a, on_b;  ///< J, by (v, ω) of a and b, world.
  /// Target of J v. NaN: the present value, of resting contact that reacts to impacts elsewhere.
  double wanted = 0.0;
  /// Normal impulse of the step, an upper bound of the impulse returned [N s].
  double given = 0.0;
  double mu = 0.0;         ///< Coefficient of friction, along `along` if it depends on direction.
  double mu_across = 0.0;  ///< Across `along` [-].
  Vec3 along = Vec3::Zero(), across = Vec3::Zero();  ///< Tangents, unit; zero without friction.
  /// On a in the step, part of the impulse bounded by mu [N s].
  Vec3 friction_impulse = Vec3::Zero();
  Vec3 arm_a = Vec3::Zero(), arm_b = Vec3::Zero();  ///< From the centres of mass [m].
};

/// Prescribed values of rows that follow functions of time c(t): g = q − c, G v = ċ. Zero for
/// others. @eq{drive-row}
struct PrescribedRows {
  Vec6 increment = Vec6::Zero();  ///< c_{n+1} − c_n.
  Vec6 rate = Vec6::Zero();       ///< ċ at t_{n+1} [1/s].
  Vec6 second = Vec6::Zero();     ///< c̈ there [1/s²].
};

/// Sum of impulses that an interaction keeps in its history: of its row [N s or N m s], or of its
/// wrench on one of its bodies, about the world's origin, six numbers [N s, N m s].
enum class ImpulseSum : unsigned char { none, of_row, on_a, on_b };

/// Adds the impulse of a wrench to such a sum. The ground's side has the opposite one.
/// @param sum  Of on_a or on_b. @param on_a, on_b  About the centres of mass; zero for the ground.
void add_impulse(ImpulseSum kind, const PairStep& step, const Vec6& on_a, const Vec6& on_b,
                 double* sum);

/// Bodies of an interaction; kGround for none. Single-body loads use b alone.
struct Participants {
  int a = kGround, b = kGround;
};

/// Dependence of the wrenches on a and b on the other body's motion, beyond the multipliers' own
/// columns: none; only as a couple, whose moments on a and b are equal and opposite and depend on
/// rotations alone; or arbitrary. In the first two cases all tangents are of moments by rotations.
/// Elimination along the tree supports no more than that.
enum class Coupling { none, couple, all };

/// Whether an interaction can be switched on and off during a run, and its initial state.
enum class Switching : unsigned char { never, starts_on, starts_off };

}  // namespace polhode
