// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <polhode/dynamics/placement.hpp>
#include <polhode/geometry/shape.hpp>

namespace polhode::contact {

/// Displacement that takes a shape out of the surface that encloses it.
struct FullyEnclosed {
  double depth = 0.0;          ///< [m]
  Vec3 normal = Vec3::Zero();  ///< Direction of exit, world.
};

/// Whether a shape lies inside a closed surface, or below one with a border, without intersecting
/// it. Nearby features cannot decide this, as triangles have two sides.
/// @param b  A Solid::surface.
[[nodiscard]] std::optional<FullyEnclosed> fully_enclosed(const geometry::Shape& a,
                                                          const geometry::Shape& b,
                                                          const Placement<double>& at_a,
                                                          const Placement<double>& at_b);

}  // namespace polhode::contact
