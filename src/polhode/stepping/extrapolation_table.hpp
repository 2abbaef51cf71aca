// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include <polhode/stepping/single_step.hpp>
#include <polhode/system/system.hpp>

namespace polhode {

class InstantSolver;

/// A step as the extrapolation of members that divide it into 2, 4, ... equal steps: order 4 to 12
/// by steps forward in time alone, also where the model dissipates. @eq{extrapolated-step}
class ExtrapolationTable {
 public:
  /// @param order  4, 6, 8, 10 or 12.
  ExtrapolationTable(const System& system, int order);
  ~ExtrapolationTable();

  /// Takes extrapolated steps of the lengths parts·H; on failure the state is not restored.
  /// @param fresh  Predict the first single steps from the velocities at t_n.
  NewtonReport advance(State& state, const std::vector<double>& parts, double H, SingleStep& single,
                       const NewtonOptions& newton, bool fresh);
  /// Difference of the last two columns in the last step, positions and velocities over H: the
  /// error of the column that is less accurate by two orders [-].
  [[nodiscard]] double difference() const { return difference_; }
  [[nodiscard]] int substeps() const;  ///< Single steps in a step.

 private:
  NewtonReport advance(State& state, double H, SingleStep& single, const NewtonOptions& newton,
                       bool fresh);
  /// Combines the members' motions and internal variables. @param first  First member used.
  void combine(const std::vector<double>& weights, std::size_t first, State& out) const;
  /// Sums of the ledger over the step, by the same weights.
  void combine_ledger(const State& before, State& out) const;

  const System* system_;
  std::vector<int> counts_;
  std::vector<double> weights_, weights_before_;  ///< Of the last column and the one before.
  std::vector<char> combined_history_;            ///< By entry of State::history.
  std::vector<State> members_;
  State result_, other_;  ///< The last column and the one before.
  std::unique_ptr<InstantSolver> solver_;
  double difference_ = 0.0;
};

}  // namespace polhode
