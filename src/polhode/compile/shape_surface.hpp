// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include <polhode/geometry/triangle_surface.hpp>
#include <polhode/model/model.hpp>

namespace polhode {

/// Surface of a shape in its own coordinates, for mass properties and drawing: closed and outward
/// except for a height field. Round shapes have `segments` triangles around; an unbounded plane has
/// none.
/// @param where  Path of the shape in the user's model, first part of messages.
/// @throws InputError if a file cannot be read, a mesh is not closed, or a hull has no volume.
[[nodiscard]] geometry::TriangleSurface shape_surface(std::string_view where,
                                                      const ShapeSpec& shape, int segments);

/// Points of a hull: given ones, or those of its file [m].
/// @throws InputError if the file cannot be read.
[[nodiscard]] std::vector<Vec3> hull_points(const ShapeSpec& shape);

}  // namespace polhode
