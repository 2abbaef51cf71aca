// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <polhode/compile/surface_overlaps.hpp>
#include <polhode/contact/contact_set.hpp>

namespace polhode {

/// A body or solid that separate_overlaps() moved.
struct StartMove {
  std::string name;
  double distance = 0.0;  ///< [m]
};

/// Bodies at a state as contacts want them: the ground last.
[[nodiscard]] std::vector<BodyStep> instants_of(const System& system, const State& state);

/// Names of the shapes that overlap at a state by more than their tolerance: "'a' in 'b' by 1 m".
/// @param contacts  Prepared for the system.
[[nodiscard]] std::vector<std::string> overlaps_at(const System& system,
                                                   contact::ContactSet& contacts,
                                                   const State& state);

/// Moves bodies and solids apart until nothing overlaps, without turning them: each pair along the
/// normal at its deepest point, the two by the inverse of their masses, round after round. Solids
/// and what they are bonded to move as one; what is held, by bonds to the ground or prescribed
/// nodes, and cables stay where they are. Ends after so many rounds even if something still
/// overlaps.
std::vector<StartMove> separate_overlaps(const Model& model, const System& system,
                                         const SystemMap& map, State& state);

}  // namespace polhode
