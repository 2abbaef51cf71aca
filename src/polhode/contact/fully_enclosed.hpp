// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <polhode/dynamics/placement.hpp>
#include <polhode/geometry/shape.hpp>

namespace polhode::contact {

/// How far a shape has to go to leave what it lies in.
struct FullyEnclosed {
  double depth = 0.0;          ///< [m]
  Vec3 normal = Vec3::Zero();  ///< The way out, world.
};

/// Whether a shape lies within a closed surface, or below one with a border, and not on it:
/// features that are near each other cannot tell, as triangles have two sides.
/// @param b  A Solid::surface.
[[nodiscard]] std::optional<FullyEnclosed> buried(const Shape& a, const Shape& b,
                                                  const Placement<double>& at_a,
                                                  const Placement<double>& at_b);

}  // namespace polhode::contact
