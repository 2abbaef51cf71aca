// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/core/types.hpp>
#include <polhode/dynamics/body_step.hpp>

namespace polhode {

/// Most multiplier rows one interaction may have.
inline constexpr int kMaxRows = 6;

/// What one interaction between bodies a and b gives for the current trial step.
///
/// Wrenches are (force [N], moment about the centre of mass [N m]), world components, at
/// t_{n+αf}; increments are (Δr, Δθ), world. Without StepContext::tangents, D and G are not read. A
/// constraint's force on body i is +λ times its column B_i, and belongs to the wrench; so does
/// what else depends on λ, as friction does, with its derivative in the column. Everything about
/// the ground stays zero and unread.
struct PairTerms {
  Vec6 wrench_a, wrench_b;      ///< Of everything, multipliers included.
  Mat6 D_aa, D_ab, D_ba, D_bb;  ///< D_ij: wrench of i by the increment of j.
  /// Column k: derivative of the wrench by multiplier k.
  Eigen::Matrix<double, 6, 6> B_a, B_b;
  Eigen::Matrix<double, 6, 6, Eigen::RowMajor> G_a, G_b;  ///< Row k: derivative of g_k at t_{n+1}.
  Vec6 g;                                                 ///< Constraint values at t_{n+1}.
  Vec6 compliance;  ///< Row k asks g_k + compliance_k·λ_k = 0; 0 is exact.
  /// Times the proximal ε of exact rows, 1 where nothing is said: of redundant ones a larger weight
  /// takes less. @eq{augmented-rows}
  Vec6 weight;

  void set_zero();
  /// All but B and G, whose columns and rows an interaction with multipliers fills.
  void set_sums_zero();
  void set_values_zero();  ///< Wrenches, values and compliance only.
};

/// One interaction's view of the step.
struct PairStep {
  const BodyStep& a;
  const BodyStep& b;
  const StepContext& context;
  const double* lambda;   ///< Current multipliers, rows() of them.
  const double* history;  ///< What commit() stored at t_n.
};

/// Zeroes what was computed for a side that is the ground: items need not ask while they compute.
void clear_ground_sides(const PairStep& step, PairTerms& terms);

/// What an interaction did over the step that was just accepted.
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

/// A relative velocity J v of an impact at the end of a step, where velocities may jump.
/// @eq{turn-law} @eq{impact-friction}
struct Impact {
  Vec6 on_a, on_b;  ///< J, by (v, ω) of a and b, world.
  /// J v afterwards. NaN: as it is, of lasting contact that is no impact but carries others on.
  double wanted = 0.0;
  double given = 0.0;      ///< Normal impulse of the step; no more than this is taken back [N s].
  double mu = 0.0;         ///< Coefficient of friction, along `along` if it depends on direction.
  double mu_across = 0.0;  ///< Across `along` [-].
  Vec3 along = Vec3::Zero(), across = Vec3::Zero();  ///< Tangents, unit; zero without friction.
  Vec3 friction_impulse = Vec3::Zero();  ///< On a in the step, part of what mu bounds [N s].
  Vec3 arm_a = Vec3::Zero(), arm_b = Vec3::Zero();  ///< From the centres of mass [m].
};

/// Demands of rows that follow functions of time c(t): g = q − c, G v = ċ. Zero for others.
/// @eq{drive-row}
struct PrescribedRows {
  Vec6 increment = Vec6::Zero();  ///< c_{n+1} − c_n.
  Vec6 rate = Vec6::Zero();       ///< ċ at t_{n+1} [1/s].
  Vec6 second = Vec6::Zero();     ///< c̈ there [1/s²].
};

/// Which bodies an interaction acts on; kGround for none. Single-body loads use b alone.
struct Participants {
  int a = kGround, b = kGround;
};

/// How the wrenches on a and b depend on the other body's motion, beyond the multipliers' own
/// columns: not at all; only as a couple, whose moments on a and b are equal and opposite and
/// depend on rotations alone; or in any way. In the first two cases all tangents are of moments by
/// rotations. Elimination along the tree carries no more than that.
enum class Coupling { none, couple, all };

/// Whether an interaction may be switched off and on during a run, and how it begins.
enum class Switching : unsigned char { never, starts_on, starts_off };

}  // namespace polhode
