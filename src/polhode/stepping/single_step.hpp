// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <polhode/newton/newton.hpp>
#include <polhode/newton/row_check.hpp>
#include <polhode/stepping/impact_resolver.hpp>
#include <polhode/stepping/ledger.hpp>

namespace polhode {

/// Single steps of generalised-α: predict, solve, accept, commit. Compositions and step control are
/// built on them.
class SingleStep {
 public:
  SingleStep(const System& system, std::unique_ptr<NewtonEngine> engine, const GeneralizedAlpha& ga,
             const LaneKernels& kernels, bool conserving);

  /// Single steps of another thread, with the same bits; null if the engine cannot be had twice.
  [[nodiscard]] std::unique_ptr<SingleStep> another() const;

  /// Prediction of the next trial from the mean velocities of past steps.
  struct Predictor {
    int degree = 3;            ///< Of the extrapolation in time; −1: the velocities at t_n.
    bool remember = false;     ///< Store the prediction for error_estimate().
    bool watch_stops = false;  ///< Find out whether a stop is active.
  };
  /// Takes one step of length dt. On failure the state is unchanged.
  NewtonReport take(State& state, double dt, const NewtonOptions& options, Predictor predictor);
  /// Largest difference of the last accepted trial from its prediction, with the phase error of the
  /// Cayley transform: an estimate of the step's error at order 2 [-].
  [[nodiscard]] double error_estimate() const { return error_; }
  /// Whether velocities jumped at the end of the last accepted trial, in an impact of a joint stop.
  [[nodiscard]] bool jumped() const { return jumped_; }
  /// Largest of these jumps, see ImpactResolver::largest_jump().
  [[nodiscard]] double jump() const { return impacts_.largest_jump(); }
  /// Whether a joint stop was active in the last accepted trial.
  [[nodiscard]] bool stopped() const { return stopped_; }

  /// Requires rows to hold to round-off: in shorter steps after one whose rows did not hold, which
  /// may be so short that any gap is below the tolerance.
  void hold_to_round_off(bool yes) { to_round_off_ = yes; }
  [[nodiscard]] bool holds_to_round_off() const { return to_round_off_; }
  /// The open row if the last trial was refused because not all rows hold.
  [[nodiscard]] const std::optional<OpenRow>& open_row() const { return open_; }
  /// Joints and drives that cannot all hold, if its rows showed that.
  [[nodiscard]] const std::vector<std::string>& contradicting() const { return contradicting_; }

  EnergyLedger& ledger() { return ledger_; }
  [[nodiscard]] const EnergyLedger& ledger() const { return ledger_; }
  [[nodiscard]] const NewtonEngine& engine() const { return *engine_; }
  [[nodiscard]] std::vector<std::pair<std::string, double>> phases() const;

 private:
  void predict(const State& state, const Predictor& predictor);
  /// Whether an interaction rejects the configuration reached; reports which and why.
  [[nodiscard]] bool refused(const State& state, NewtonReport& report) const;
  /// Whether a row of a converged trial does not hold; reports which.
  [[nodiscard]] bool is_open(const State& state, NewtonReport& report);
  void commit_histories(State& state, double rotation);
  void estimate_error();
  [[nodiscard]] bool meets_barrier(const State& state) const;

  const System* system_;
  std::unique_ptr<NewtonEngine> engine_;
  const LaneKernels* kernels_;
  EnergyLedger ledger_;
  ImpactResolver impacts_;
  std::optional<LeastReactions> reactions_;  ///< If friction depends on redundant ones.
  RowCheck rows_;
  Trial trial_;
  std::vector<TrialBlock> predicted_;
  std::vector<double> predicted_nodes_;
  std::vector<MassBlock> mass_;
  /// Interactions whose history is committed in every step, and those that only count turns.
  std::vector<int> eager_, lazy_;
  std::vector<int> always_queried_;  ///< Interactions whose acceptance is always queried.
  double error_ = 0.0;
  std::optional<OpenRow> open_;
  std::vector<std::string> contradicting_;
  bool to_round_off_ = false;
  bool jumped_ = false, stopped_ = false;
  double seconds_[3] = {0, 0, 0};  ///< Predictor, Newton, acceptance.
};

}  // namespace polhode
