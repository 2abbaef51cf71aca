// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <polhode/equations/iterate_snapshot.hpp>
#include <polhode/system/barrier_constraint.hpp>

namespace polhode {

/// Keeps iterates on the allowed side of barriers, such as the stops of a joint: of an iteration
/// that would take more than nine tenths of what is left in front of one, only a part is applied.
/// Whatever the engine: it repeats the iteration with less.
class BarrierGuard {
 public:
  BarrierGuard(const System& system, const State& state, Trial& trial, NewtonEngine& engine);

  /// Takes back as much of the prediction as leads through a barrier; before begin_step().
  void hold_prediction();
  /// Before an iteration: remembers where it starts.
  void before();
  /// After an iteration that was solved: repeats it with less damping factor if need be.
  Iteration hold(Iteration done, bool refactor, double damping);
  /// Something is close to a barrier: increments may grow for a while.
  [[nodiscard]] bool near() const { return near_; }

 private:
  void measure(std::vector<double>& clearance) const;
  /// The same with where nodes are: whence iterates go.
  void measure_start();
  /// The largest part of the way to the trial that leaves a tenth of what there was, on the way and
  /// at its end.
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
  bool idle_ = true;               ///< Nothing has barriers.
  std::vector<double> from_, to_;  ///< Clearances.
  std::vector<double> from_x_;     ///< Positions of nodes [m].
  IterateSnapshot iterate_;
  bool near_ = false;
};

}  // namespace polhode
