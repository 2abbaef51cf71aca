// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include <polhode/stepping/ledger.hpp>
#include <polhode/system/system.hpp>

namespace polhode {

/// Consequence of interactions that were switched on or off at an instant.
struct SwitchReport {
  double lost = 0.0;      ///< Of kinetic energy, by impulses of rows that closed [J].
  double released = 0.0;  ///< Potential energy that went with what was switched off [J].
  double impulse = 0.0;   ///< Largest of a row that closed [N s or N m s].
  int worst = -1;         ///< Interaction whose rows are far from holding; -1: none.
  double gap = 0.0;       ///< How far [m or -].
  bool solved = true;     ///< False: the matrix of the impulses is singular.
};

/// Switches interactions at the instant of a state. Positions stay. Velocities stay too, unless
/// rows begin to act: then they jump onto G v = ċ of these by the least mass-weighted amount, with
/// the impulses of all rows that act. @eq{switch-impulse} @eq{switch-loss}
/// @param on, off  Indices into System::interactions(); those that are so already are left out.
/// @returns what happened; with `worst` or not `solved` the state is as it was.
SwitchReport switch_interactions(const System& system, State& state, std::span<const int> on,
                                 std::span<const int> off, EnergyLedger& ledger);

}  // namespace polhode
