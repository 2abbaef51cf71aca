// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/loads/load_description.hpp>
#include <polhode/model/model.hpp>

namespace polhode {

/// Adds the mass of an inerter, on a slide on the ground, and describes the row between its
/// displacement and the joint's coordinate.
/// @param size  A length of the size of the model's bodies [m].
/// @param d     The load with its joint's coordinate; the row's coordinates are written.
void add_inerter_mass(const LoadSpec& load, const Model& model, double size, System& system,
                      LoadDescription& d);

}  // namespace polhode
