// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include <polhode/solve/instant.hpp>

namespace polhode {

/// Kinks of prescribed motions: at the end of a step their velocities jump to those of the next
/// one, and the velocities of free nodes and bodies with them as impulses of the drive make them.
/// @eq{prescribed-kink}
class PrescribedKinks {
 public:
  explicit PrescribedKinks(const System& system) : system_(&system) {}

  /// Compares the velocities of prescribed components with those that they go on with.
  /// @returns whether one jumps.
  [[nodiscard]] bool find(const State& state);
  /// Makes the velocities of the state jump as found.
  void settle(State& state);

 private:
  const System* system_;
  std::unique_ptr<InstantSolver> solver_;  ///< From the first kink on.
  std::vector<double> given_;              ///< Jumps found, three a node [m/s].
};

}  // namespace polhode
