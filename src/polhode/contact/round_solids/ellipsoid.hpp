// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/contact/round_solids/round_solid.hpp>

namespace polhode::contact {

/// @param size  Full lengths of the axes [m].
/// @throws InputError if a size is not positive and finite.
[[nodiscard]] geometry::Shape ellipsoid(std::string_view where, const Vec3& size,
                                        const geometry::ShapePlace& place = {});
[[nodiscard]] const RoundSolid& ellipsoid_solid();

}  // namespace polhode::contact
