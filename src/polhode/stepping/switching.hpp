// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include <polhode/stepping/ledger.hpp>
#include <polhode/system/system.hpp>

namespace polhode {

/// Result of switching interactions on or off at an instant.
struct SwitchReport {
  double lost = 0.0;      ///< Kinetic energy lost by impulses of rows that closed [J].
  double released = 0.0;  ///< Potential energy of interactions that were switched off [J].
  double impulse = 0.0;   ///< Largest of a row that closed [N s or N m s].
  int worst = -1;         ///< Interaction whose rows are violated too far; -1: none.
  double gap = 0.0;       ///< Its violation [m or -].
  bool solved = true;     ///< False: the matrix of the impulses is singular.
};

/// Switches interactions at the instant of a state. Positions are unchanged, and velocities too,
/// unless rows become active: then they jump onto G v = ċ of these by the smallest mass-weighted
/// amount, with the impulses of all active rows. @eq{switch-impulse} @eq{switch-loss}
/// @param on, off  Indices into System::interactions(); those already in that state are ignored.
/// @returns the result; with `worst` or not `solved` the state is unchanged.
SwitchReport switch_interactions(const System& system, State& state, std::span<const int> on,
                                 std::span<const int> off, EnergyLedger& ledger);

}  // namespace polhode
