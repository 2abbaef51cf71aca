// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <polhode/simulation/simulation.hpp>

namespace polhode {

/// Bodies of a probe of momentum: the one of this name, or those whose names have the beginning
/// before a star, as those of a part; without fixed ones.
/// @param where  Path for messages.
/// @throws InputError if there are none, or if there are nodes of beams or cables, which share
///         their mass.
[[nodiscard]] std::vector<int> bodies_with_momentum(const Model& model, const std::string& name,
                                                    const std::string& where);

/// Names of the columns of a probe of momentum, without the time.
[[nodiscard]] std::vector<std::string> momentum_columns();

/// Values of these columns at the present state: linear momentum [kg m/s] of the bodies and their
/// rotors, angular momentum about their common centre of mass [N m s], kinetic energy [J].
/// @param in_body  Along the axes of the only body, else of the world.
[[nodiscard]] std::vector<double> momentum_numbers(const Simulation& simulation,
                                                   const std::vector<int>& bodies, bool in_body);

}  // namespace polhode
