// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/contact/round_solids/round_solid.hpp>

namespace polhode::contact {

/// Lengths are those of the model file: diameter and full length, along z of the placement.
/// @throws InputError if a size is not positive and finite.
[[nodiscard]] geometry::Shape cylinder(std::string_view where, double diameter, double length,
                                       const geometry::ShapePlace& place = {});
[[nodiscard]] const RoundSolid& cylinder_solid();

}  // namespace polhode::contact
