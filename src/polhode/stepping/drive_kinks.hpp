// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include <polhode/stepping/instant.hpp>
#include <polhode/stepping/ledger.hpp>

namespace polhode {

/// Velocity jumps at kinks of drives, which are prescribed components of nodes and rows that follow
/// functions of time. At the end of a step their velocities jump to those of the next one, and
/// those of free nodes and bodies follow by the impulses of the drive. @eq{prescribed-kink}
/// @eq{drive-kink}
class DriveKinks {
 public:
  explicit DriveKinks(const System& system) : system_(&system) {}

  /// Applies the velocity jumps of kinks at the end of a step, and adds their work to the ledger.
  void pass(State& state, EnergyLedger& ledger);

 private:
  /// Compares the velocities of drives before and after the instant.
  /// @returns whether one jumps.
  [[nodiscard]] bool find(const State& state);
  /// Applies the jumps found to the velocities of the state.
  void settle(State& state);

  const System* system_;
  std::unique_ptr<InstantSolver> solver_;  ///< From the first kink on.
  std::vector<double> given_;              ///< Jumps of nodes, three each [m/s]; may be empty.
  std::vector<double> rows_;               ///< Jumps of G v by row; may be empty.
};

}  // namespace polhode
