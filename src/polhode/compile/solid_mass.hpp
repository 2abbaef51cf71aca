// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/compile/build_solids.hpp>
#include <polhode/geometry/mass_properties.hpp>

namespace polhode {

/// Mass, centre of mass and inertia about it of a solid at the start, world axes, by its consistent
/// mass matrix.
[[nodiscard]] geometry::MassProperties solid_mass(const SolidMap& solid);

}  // namespace polhode
