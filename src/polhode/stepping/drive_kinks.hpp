// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include <polhode/stepping/instant.hpp>
#include <polhode/stepping/ledger.hpp>

namespace polhode {

/// Kinks of drives, which are prescribed components of nodes and rows that follow functions of
/// time: at the end of a step their velocities jump to those of the next one, and those of free
/// nodes and bodies with them as impulses of the drive make them. @eq{prescribed-kink}
/// @eq{drive-kink}
class DriveKinks {
 public:
  explicit DriveKinks(const System& system) : system_(&system) {}

  /// At the end of a step: makes velocities jump where drives have kinks, and adds what that puts
  /// in to the ledger.
  void pass(State& state, EnergyLedger& ledger);

 private:
  /// Compares the velocities of drives with those that they go on with.
  /// @returns whether one jumps.
  [[nodiscard]] bool find(const State& state);
  /// Makes the velocities of the state jump as found.
  void settle(State& state);

  const System* system_;
  std::unique_ptr<InstantSolver> solver_;  ///< From the first kink on.
  std::vector<double> given_;              ///< Jumps of nodes, three each [m/s]; may be empty.
  std::vector<double> rows_;               ///< Jumps of G v by row; may be empty.
};

}  // namespace polhode
