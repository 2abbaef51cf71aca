// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <polhode/joints/joint.hpp>
#include <polhode/loads/registry.hpp>
#include <polhode/model/model.hpp>

namespace polhode {

/// A body in the model's start, at rest.
[[nodiscard]] BodyStep start_of(const BodySpec& body);

/// Adds the function of a load on bodies that is given in code.
/// @param where  Path for messages, such as loads.drive.
/// @throws InputError if this kind of load takes none, or not such a one.
void add_function(const std::string& where, const LoadSpec& load, const LoadKind& kind,
                  LoadDescription& d);

/// Inertia about their axes of the rotors on a body, body axes [kg m²]; a body's own is without.
/// @param body    Its index in the model.
/// @param driven  Of those with a given speed only, which turn with the body.
[[nodiscard]] Mat3 rotor_inertia(const Model& model, int body, bool driven);

/// The coordinates of a coupling. Of its turns at the start the first one has as many as bring it
/// nearest to the row, the others none.
/// @param joints  By their index in the model.
/// @throws InputError if a joint does not have the coordinate.
[[nodiscard]] std::vector<CoupledCoordinate> coupled_coordinates(const std::string& where,
                                                                 const LoadSpec& load,
                                                                 const Model& model,
                                                                 const std::vector<Joint>& joints);

}  // namespace polhode
