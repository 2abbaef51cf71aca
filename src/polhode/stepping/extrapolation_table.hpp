// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include <polhode/stepping/single_step.hpp>
#include <polhode/system/system.hpp>

namespace polhode {

class InstantSolver;
class MemberThreads;

/// A step as the extrapolation of members that divide it into 2, 4, ... equal steps: order 4 to 12
/// by steps forward in time alone, also where the model dissipates. @eq{extrapolated-step}
class ExtrapolationTable {
 public:
  /// @param order  The highest one: 4, 6, 8, 10 or 12.
  /// @param threads  Largest number of members that are computed at a time, which needs an engine
  /// for each; results have the same bits with any number.
  ExtrapolationTable(const System& system, int order, const SingleStep& single, int threads = 1);
  ~ExtrapolationTable();

  /// How a step is taken.
  struct Way {
    int columns = 2;  ///< Number of members: half of the order.
    /// Error above which the step is given up, also before its last member [-]; 0: never.
    double allowed = 0.0;
    bool fresh = false;     ///< Predict the first single steps from the velocities at t_n.
    bool to_break = false;  ///< The step ends at a break of a function of time.
  };
  /// Takes extrapolated steps of the lengths parts·H; on failure, and where a step is given up, the
  /// state is not restored.
  NewtonReport advance(State& state, const std::vector<double>& parts, double H, SingleStep& single,
                       const NewtonOptions& newton, const Way& way);
  /// Difference of the last two columns in the last step, positions and velocities over H: the
  /// error of the column that is less accurate by two orders [-]. Expected, if it was given up.
  [[nodiscard]] double difference() const { return difference_; }
  /// The same with one member fewer; of two members, the difference of the first from the result.
  [[nodiscard]] double difference_before() const { return difference_before_; }
  /// Part of these that may be the members' rounding: that of increments that Newton's method
  /// accepted above its tolerance, as near singular positions [-].
  [[nodiscard]] double rounding() const { return rounding_; }
  /// The body with the largest difference; −1: not known.
  [[nodiscard]] int worst_body(double H) const;
  /// Time spent waiting for members of other threads [s].
  [[nodiscard]] double waited() const;
  /// End of a step that was given up for its estimate, as far as it was computed; else null.
  [[nodiscard]] const State* given_up_at() const { return gave_up_ ? &result_ : nullptr; }
  /// Whether a joint stop was met; then the step was given up.
  [[nodiscard]] bool met_stop() const { return met_stop_; }
  [[nodiscard]] int most_columns() const { return static_cast<int>(counts_.size()); }
  /// Single steps in a step of so many members.
  [[nodiscard]] static int substeps(int columns) { return columns * (columns + 1); }

 private:
  NewtonReport advance(State& state, double H, SingleStep& single, const NewtonOptions& newton,
                       const Way& way);
  /// Combines motions and internal variables of members first to last−1, about member last−1.
  void combine(std::size_t first, std::size_t last, State& out) const;
  /// Difference between the columns of members 0 to last−1 and 1 to last−1. Both results are kept.
  double compare_columns(std::size_t last, double H);
  /// Sums of the ledger over the step, by the same weights.
  void combine_ledger(const State& before, std::size_t members, State& out) const;
  /// Renews memories of coordinates, which the combination of the members' ones misses by the
  /// step's error.
  void remember_coordinates(State& state) const;
  /// Puts bodies back onto the constraints, from which the result is off by the step's error.
  NewtonReport project(State& state, NewtonReport report, bool to_break);

  const System* system_;
  std::vector<int> counts_;
  std::vector<char> combined_history_;    ///< By entry of State::history.
  std::vector<int> coordinate_memories_;  ///< Interactions that remember coordinates.
  std::vector<State> members_;
  State result_, other_;  ///< The last column and the one before.
  std::unique_ptr<InstantSolver> solver_;
  std::unique_ptr<MemberThreads> threads_;  ///< Null: one thread.
  double difference_ = 0.0, difference_before_ = 0.0, rounding_ = 0.0;
  bool met_stop_ = false, gave_up_ = false;
};

}  // namespace polhode
