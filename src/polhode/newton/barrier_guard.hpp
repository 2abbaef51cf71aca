// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <polhode/equations/iterate_snapshot.hpp>
#include <polhode/system/barrier_constraint.hpp>

namespace polhode {

/// Keeps iterates on the admissible side of barriers, such as the stops of a joint: an iteration
/// that would use more than nine tenths of a clearance is repeated with a smaller damping factor.
/// It works with any engine.
class BarrierGuard {
 public:
  BarrierGuard(const System& system, const State& state, Trial& trial, NewtonEngine& engine);

  /// Shortens a prediction that crosses a barrier; before begin_step().
  void hold_prediction();
  /// Stores the start of an iteration.
  void before();
  /// After an iteration that was solved: repeats it with a smaller damping factor if necessary.
  Iteration hold(Iteration done, bool refactor, double damping);
  /// Whether a barrier is close: increments may grow for a while.
  [[nodiscard]] bool near() const { return near_; }

 private:
  void measure(std::vector<double>& clearance) const;
  /// Measures clearances and stores node positions at the start of an iteration.
  void measure_start();
  /// Largest fraction of the increment that leaves a tenth of each clearance, along it and at its
  /// end.
  [[nodiscard]] double part() const;

  const System& system_;
  const State& state_;
  Trial& trial_;
  NewtonEngine& engine_;
  struct Watched {
    const BarrierConstraint* points;
    const double* history;
  };
  std::vector<Watched> points_;    ///< Groups of elements, at t_n.
  bool idle_ = true;               ///< There are no barriers.
  std::vector<double> from_, to_;  ///< Clearances.
  std::vector<double> from_x_;     ///< Positions of nodes [m].
  IterateSnapshot iterate_;
  bool near_ = false;
};

}  // namespace polhode
