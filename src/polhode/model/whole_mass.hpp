// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/geometry/mass_properties.hpp>
#include <polhode/model/model.hpp>

namespace polhode {

/// Mass, centre of mass and inertia about it of all rigid bodies at the start, world axes; fixed
/// ones with the mass that is given for them.
[[nodiscard]] geometry::MassProperties whole_mass(const Model& model);

/// Number of independent loops: joints in addition to those of a tree over bodies and ground.
[[nodiscard]] int loop_count(const Model& model);

}  // namespace polhode
