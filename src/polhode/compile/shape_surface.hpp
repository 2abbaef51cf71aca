// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include <polhode/geometry/triangle_surface.hpp>
#include <polhode/model/model.hpp>

namespace polhode {

/// The surface of a shape in the shape's own coordinates, as it is weighed and drawn: closed and
/// outward but for a height field. Round shapes get `segments` triangles around; a plane, which has
/// no end, gets none.
/// @param where  Path of the shape in the user's model, first part of messages.
/// @throws InputError if a file cannot be read, a mesh is not closed, or a hull has no volume.
[[nodiscard]] TriangleSurface shape_surface(std::string_view where, const ShapeSpec& shape,
                                            int segments);

/// Points of a hull: those listed, or those of its file [m].
/// @throws InputError if the file cannot be read.
[[nodiscard]] std::vector<Vec3> hull_points(const ShapeSpec& shape);

}  // namespace polhode
