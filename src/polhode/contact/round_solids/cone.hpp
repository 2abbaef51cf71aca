// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/contact/round_solids/round_solid.hpp>

namespace polhode::contact {

/// Base at −length/2, apex at +length/2 of z.
/// @param diameter, length  Full lengths [m].
/// @param rounding  Radius of rim and apex; 0: 1e-3 of the smallest half size.
/// @throws InputError if a size or the rounding is rejected.
[[nodiscard]] geometry::Shape cone(std::string_view where, double diameter, double length,
                                   const geometry::ShapePlace& place = {}, double rounding = 0.0);
[[nodiscard]] const RoundSolid& cone_solid();

}  // namespace polhode::contact
