// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/compile/build_contacts.hpp>
#include <polhode/simulation/contact_statistics.hpp>

namespace polhode {

/// What the surfaces of a pair of sides do to each other, at a state.
/// @param pair  Of ContactMap::pairs, one of its sides a solid or a cable.
[[nodiscard]] ContactReport surface_report(const System& system, const State& state,
                                           const ContactMap& map, const ContactMap::Pair& pair);
/// What all surfaces took since the start.
[[nodiscard]] ContactLosses surface_losses(const System& system, const State& state,
                                           const ContactMap& map);
/// The smallest gap after the last step [m], NaN without surfaces; and how many surfaces touch.
struct SurfaceFigures {
  double least_gap = 0.0;
  int touching = 0;
};
[[nodiscard]] SurfaceFigures surface_figures(const System& system, const State& state,
                                             const ContactMap& map);

}  // namespace polhode
