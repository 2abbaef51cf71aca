// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <polhode/compile/surface_overlaps.hpp>
#include <polhode/contact/contact_set.hpp>

namespace polhode {

/// A body or solid moved by separate_overlaps().
struct StartMove {
  std::string name;
  double distance = 0.0;  ///< [m]
};

/// Bodies of a state as steps for contacts: the ground last.
[[nodiscard]] std::vector<BodyStep> instants_of(const System& system, const State& state);

/// Names of the shapes that overlap at a state by more than their tolerance: "'a' in 'b' by 1 m".
/// @param contacts  Prepared for the system.
[[nodiscard]] std::vector<std::string> overlaps_at(const System& system,
                                                   contact::ContactSet& contacts,
                                                   const State& state);

/// Separates overlapping bodies and solids by translations: each pair along the normal at its
/// deepest point, distributed by inverse masses, in rounds. Solids and bodies bonded to them move
/// as one; parts bonded to the ground, with prescribed nodes, and cables are fixed. Ends after a
/// maximum number of rounds even with remaining overlaps.
std::vector<StartMove> separate_overlaps(const Model& model, const System& system,
                                         const SystemMap& map, State& state);

}  // namespace polhode
