// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <polhode/dynamics/momentum_step.hpp>
#include <polhode/equations/constraint_check.hpp>
#include <polhode/equations/trial.hpp>
#include <polhode/linear/kkt.hpp>

namespace polhode {

/// ε of exact multiplier rows in the scaled system: G x + ε(λ̂ − λ̂_c) = 0 [-]. With a zero centre
/// it selects the smallest of the multipliers that redundant rows leave undetermined; with the
/// centre at the solution it has no effect.
inline constexpr double kProximal = 1e-12;

/// Block pattern of the linear system: a pair for each interaction that has multiplier rows or acts
/// between two moving bodies.
struct KktMap {
  linear::KktTopology topology;
  std::vector<int> pair;  ///< By interaction: its pair, or -1 (a load on one body).
};
[[nodiscard]] KktMap kkt_map(const System& system);

/// Whether a joint of the tree exerts forces besides those of its multipliers, which elimination
/// along the tree does not contain: stops, and friction that does not depend on the reaction. These
/// alone are the terms of a step without multipliers.
[[nodiscard]] bool acts_beside_rows(const System& system, int interaction);

/// Batched evaluation of interactions, one virtual call per batch of one group, whose terms are
/// passed to a visitor. It owns the only buffers needed and allocates once.
///
/// The residual of a row with several parts, and its proximal weight, are passed with its last
/// part; those of the others are zero. @eq{coupling-row}
class InteractionSweep {
 public:
  explicit InteractionSweep(const System& system);
  /// Evaluates only these interactions, in ascending order.
  InteractionSweep(const System& system, std::vector<int> interactions);

  [[nodiscard]] bool empty() const { return interactions_.empty(); }
  /// @param steps  By body, the ground last.
  /// @param lambda  Null for joints whose acts_beside_rows() is true.
  /// @param visit  visit(int interaction, const PairStep&, const PairTerms&).
  /// @param rows_only  Skip batches without multiplier rows.
  template <class Visit>
  void run(std::span<const BodyStep> steps, const StepContext& context, const double* lambda,
           const double* history, Visit&& visit, bool rows_only = false) {
    for (const Batch& batch : batches_) {
      if (rows_only && !batch.has_rows) continue;
      evaluate(batch, steps, context, lambda, history);
      for (int k = 0; k < batch.count; ++k)
        visit(interactions_[batch.first + k], static_cast<const PairStep&>(pair_steps_[k]),
              static_cast<const PairTerms&>(terms_[k]));
    }
  }

 private:
  struct Batch {
    int group = 0, first = 0, count = 0;  ///< Positions [first, first + count), of one group.
    bool has_rows = false;
    bool has_parts = false;  ///< Of rows with several parts.
  };
  void gather_parts(const Batch& batch);
  void evaluate(const Batch& batch, std::span<const BodyStep> steps, const StepContext& context,
                const double* lambda, const double* history);

  const System* system_;
  std::vector<int> interactions_;
  std::vector<Batch> batches_;
  std::vector<int> items_;
  std::vector<PairStep> pair_steps_;
  std::vector<PairTerms> terms_;
  double of_parts_ = 0.0;  ///< Sum of the values of a row's parts so far.
};

/// Adds the rows of an interaction to the constraint check, with tangents or without.
void add_rows(const InteractionRef& ref, const PairStep& step, const PairTerms& terms,
              const Trial& trial, double length_scale, ConstraintCheck& check);

/// Residual and tangent of one step, assembled and scaled.
///
///   [ s·K  −B ] [ Δ(r,θ) ]     [ s·R              ]      s = βΔt²/m_ref,  λ̂ = s λ
///   [ G     C ] [ Δλ̂     ] = − [ g + ε(λ̂ − λ̂_c)   ]      C = ε, or compliance/s
///
/// @eq{eq:ga-residual-vector} @eq{eq:ga-Newton-scheme}
class NewtonSystem {
 public:
  NewtonSystem(const System& system, MomentumRate form);
  [[nodiscard]] MomentumRate form() const { return form_; }

  /// Sets further coupled pairs of bodies: their blocks come last in values() and are filled by
  /// others. Replaces earlier ones.
  void couple(const std::vector<linear::KktPair>& more);
  /// Blocks of these pairs, set to zero.
  [[nodiscard]] std::span<linear::KktValues::Pair> cleared_couplings();
  /// Selects statics: bodies have no momentum rates.
  void set_static(bool yes) { static_ = yes; }
  /// Sets ε of exact rows; kProximal unless set.
  void set_proximal(double epsilon) { proximal_ = epsilon; }
  /// Computes right_hand_side() and the residuals; with `tangent` the values as well.
  void assemble(const State& state, const Trial& trial, bool tangent);
  /// Evaluates only the constraint values at the iterate.
  [[nodiscard]] ConstraintCheck check(const State& state, const Trial& trial);

  [[nodiscard]] const linear::KktTopology& topology() const { return map_.topology; }
  [[nodiscard]] const linear::KktValues& values() const { return values_; }
  /// Values, to which terms may be added after assemble().
  [[nodiscard]] linear::KktValues& values() { return values_; }
  /// Bodies (6 each, scaled by −s), then rows (negative).
  [[nodiscard]] const Vec& right_hand_side() const { return rhs_; }

  /// Momentum rate minus wrench at the iterate: (force [N], moment [N m]).
  [[nodiscard]] const Vec6& body_residual(int body) const { return body_residual_[body]; }
  /// Sum of the magnitudes of the terms of body_residual(): times round-off, its noise.
  [[nodiscard]] const Vec6& body_residual_scale(int body) const { return body_scale_[body]; }
  /// g + compliance·λ of a row [m or -].
  [[nodiscard]] double row_residual(int row) const { return row_residual_[row]; }
  /// Whether a row has a compliance, so that its multiplier is a spring force.
  [[nodiscard]] bool is_spring(int row) const { return is_spring_[row]; }
  [[nodiscard]] const System& system() const { return *system_; }

 private:
  void take_steps(const State& state, const Trial& trial);
  void add_pair(int interaction, const PairTerms& terms, const Trial& trial, double s,
                bool tangent);

  const System* system_;
  MomentumRate form_;
  bool static_ = false;
  double proximal_ = kProximal;
  KktMap map_;
  std::size_t own_pairs_ = 0;  ///< Of interactions, which come first.
  InteractionSweep sweep_;
  std::vector<BodyStep> steps_;  ///< By body, the ground last.
  linear::KktValues values_;
  Vec rhs_;
  std::vector<Vec6> body_residual_, body_scale_;
  std::vector<double> row_residual_;
  std::vector<bool> is_spring_;
};

/// Largest residual relative to round-off.
struct WorstResidual {
  int body = -1;            ///< Or -1: nothing to report.
  int component = 0;        ///< 0 to 2 force, 3 to 5 moment.
  double value = 0.0;       ///< [N or N m]
  double over_noise = 0.0;  ///< Multiples of its round-off scale [-].
  [[nodiscard]] std::string text(const System& system) const;
};
[[nodiscard]] WorstResidual worst_residual(const NewtonSystem& assembled);

}  // namespace polhode
