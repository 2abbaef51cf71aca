// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <polhode/equations/iterate_snapshot.hpp>
#include <polhode/equations/newton_engine.hpp>
#include <polhode/system/barrier_constraint.hpp>

namespace polhode {

/// Globalisation of Newton's method for any engine. Keeps iterates on the admissible side of
/// barriers, such as the stops of a joint: an iteration that would use more than nine tenths of a
/// clearance is repeated with a smaller damping factor. Returns to the previous iterate after a
/// large increment that grew, and takes less of it. Engines that have a merit reduce it themselves,
/// see search_along().
class Globalization {
 public:
  /// @param undoes_growth  Whether large increments that grow are undone.
  Globalization(const System& system, const State& state, Trial& trial, NewtonEngine& engine,
                bool undoes_growth);

  /// Shortens a prediction that crosses a barrier; before begin_step().
  void limit_prediction();
  /// One iteration of the engine. @param last  Increment of the previous one, 0 in the first.
  Iteration iterate(double last, bool refactor);
  /// Whether the last iteration was undone: its increment does not count.
  [[nodiscard]] bool undone() const { return undone_; }
  /// Whether a barrier is close: increments may grow for a while.
  [[nodiscard]] bool near() const { return near_; }

 private:
  /// Stores the start of an iteration where it may be needed.
  void keep(double last);
  /// Repeats an iteration that was solved with a smaller damping factor if barriers require it.
  Iteration limit(Iteration done, bool refactor);
  void undo_growth(double increment, double last);
  void go_back();
  void measure(std::vector<double>& clearance) const;
  /// Measures clearances and stores node positions at the start of an iteration.
  void measure_start();
  /// Largest fraction of the increment that leaves a tenth of each clearance, along it and at its
  /// end.
  [[nodiscard]] double admissible_part() const;

  const System& system_;
  const State& state_;
  Trial& trial_;
  NewtonEngine& engine_;
  struct Watched {
    const BarrierConstraint* points;
    const double* history;
  };
  std::vector<Watched> points_;    ///< Groups of elements, at t_n.
  bool barriers_ = false;          ///< There are any.
  std::vector<double> from_, to_;  ///< Clearances.
  std::vector<double> from_x_;     ///< Positions of nodes [m].
  IterateSnapshot iterate_;
  bool near_ = false;
  bool undoes_growth_;
  bool large_ = false;  ///< The last increment was large.
  bool undone_ = false;
  double damping_ = 1.0;
};

}  // namespace polhode
