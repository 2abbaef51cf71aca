// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include <polhode/solve/instant.hpp>
#include <polhode/solve/trial.hpp>

namespace polhode {

/// Makes velocities jump where impacts of interactions, such as the stops of joints, ended in a
/// step: by impulses along them that leave G v = 0. @eq{joint-stop-exit}
class SettleImpacts {
 public:
  explicit SettleImpacts(const System& system) : system_(&system) {}

  /// Finds the impacts of an accepted step, the state and the histories still at t_n.
  void find(const State& state, const Trial& trial);
  [[nodiscard]] bool any() const { return !rows_.empty(); }
  /// Changes the velocities of the state, which has moved to t_{n+1}.
  void settle(State& state);

 private:
  struct Row {
    int a = kGround, b = kGround;
    Impact impact;
  };
  const System* system_;
  std::unique_ptr<InstantSolver> solver_;  ///< From the first impact on.
  std::vector<Row> rows_;
};

}  // namespace polhode
