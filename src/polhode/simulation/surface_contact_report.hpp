// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/compile/build_contacts.hpp>
#include <polhode/simulation/contact_statistics.hpp>

namespace polhode {

/// Contact between the surfaces of a pair of sides, at a state.
/// @param pair  Of ContactMap::pairs, one of its sides a solid or a cable.
[[nodiscard]] ContactReport surface_report(const System& system, const State& state,
                                           const ContactMap& map, const ContactMap::Pair& pair);
/// Losses of all surface contacts since the start.
[[nodiscard]] ContactLosses surface_losses(const System& system, const State& state,
                                           const ContactMap& map);
/// Smallest gap after the last step [m], NaN without surfaces; and number of surfaces in contact.
struct SurfaceFigures {
  double least_gap = 0.0;
  int touching = 0;
};
[[nodiscard]] SurfaceFigures surface_figures(const System& system, const State& state,
                                             const ContactMap& map);

}  // namespace polhode
