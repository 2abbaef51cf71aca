// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>

#include <polhode/geometry/triangle_surface.hpp>

namespace polhode::geometry {

/// Convex hull of points, as outward triangles whose corners are some of the points.
///
/// Points are added one after the other; each replaces the triangles visible from it by a fan from
/// their horizon. Points closer to the hull than 1e-10 of its size do not become corners.
///
/// @param where  Path of the shape in the user's model, first part of the message.
/// @throws InputError if the points lie in a plane, on a line or in one place, or are not finite.
[[nodiscard]] TriangleSurface convex_hull(std::string_view where, std::span<const Vec3> points);

}  // namespace polhode::geometry
