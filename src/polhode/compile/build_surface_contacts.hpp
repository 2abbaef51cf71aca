// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <polhode/compile/build_contacts.hpp>
#include <polhode/compile/build_solids.hpp>
#include <polhode/core/error.hpp>
#include <polhode/surface_contact/surface_contact.hpp>

namespace polhode {

/// A surface of a solid or a cable and a shape of a body, or two surfaces, that may be in contact.
struct SurfacePair {
  Side own;               ///< A solid or a cable.
  Side side;              ///< Opposite side: a body, another one of these or itself.
  std::size_t shape = 0;  ///< Of a body.
  ContactLawSpec law;
};

/// Pairs of surfaces of solids with shapes and with each other, and their laws.
/// @param faults  Receives unsupported shapes and laws; null: the first is thrown.
[[nodiscard]] std::vector<SurfacePair> plan_surface_contacts(
    const Model& model, std::vector<InputError>* faults = nullptr);

/// Adds the contacts of surfaces of solids with shapes of bodies and with each other, after solids
/// and bodies.
/// @param bodies  By Model::bodies: index into System::bodies(), kGround if fixed.
/// @param map  Receives pairs and surfaces.
void add_surface_contacts(System& system, const Model& model, const std::vector<int>& bodies,
                          const std::vector<SolidMap>& solids, ContactMap& map);

}  // namespace polhode
