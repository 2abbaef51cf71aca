// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <polhode/compile/build_contacts.hpp>
#include <polhode/compile/build_solids.hpp>
#include <polhode/core/error.hpp>
#include <polhode/simulation/contact_keeper.hpp>
#include <polhode/surface_contact/surface_contact.hpp>

namespace polhode {

/// The surface of a solid or a cable and a shape of a body, or two surfaces, that may meet.
struct SurfacePair {
  int own = 0;            ///< Side of a solid or of a cable, see contact_spec.hpp.
  int side = 0;           ///< What it meets: a body, another one of these or itself.
  std::size_t shape = 0;  ///< Of a body.
  ContactLawSpec law;
};

/// Which surfaces of solids may meet which shapes and which of one another, and by which law.
/// @param faults  Told of shapes and laws that surfaces do not know; null: the first is thrown.
[[nodiscard]] std::vector<SurfacePair> plan_surface_contacts(
    const Model& model, std::vector<InputError>* faults = nullptr);

/// Adds the contact of surfaces of solids with shapes of bodies and with one another, after solids
/// and bodies.
/// @param bodies  By Model::bodies: index into System::bodies(), kGround if fixed.
/// @param map     Gains pairs and surfaces.
void add_surface_contacts(System& system, const Model& model, const std::vector<int>& bodies,
                          const std::vector<SolidMap>& solids, ContactMap& map);

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
