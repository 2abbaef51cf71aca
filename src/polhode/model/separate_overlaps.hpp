// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <polhode/contact/contact_set.hpp>

namespace polhode {

/// What separate_overlaps() did.
struct SeparationReport {
  std::vector<std::pair<int, double>> moves;  ///< Body, distance [m]; those that moved.
  int rounds = 0;
};

/// Names of the shapes that overlap at a state by more than their tolerance: "'a' in 'b' by 1 m".
/// @param contacts  Prepared for the system.
[[nodiscard]] std::vector<std::string> overlaps_at(const System& system,
                                                   contact::ContactSet& contacts,
                                                   const State& state);

/// Moves bodies apart until nothing overlaps, without turning them: each pair along the normal at
/// its deepest point, the two bodies by the inverse of their masses, round after round. Ends after
/// so many rounds even if something still overlaps.
SeparationReport separate_overlaps(const System& system, contact::ContactSet& contacts,
                                   State& state);

}  // namespace polhode
