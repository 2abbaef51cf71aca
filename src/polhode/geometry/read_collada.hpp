// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include <polhode/geometry/triangle_surface.hpp>

namespace polhode::geometry {

/// Reads the surfaces of a COLLADA file (.dae) where its scene has them, in metres by its unit.
///
/// Triangles, strips, fans and polygons without holes are read, polygons as fans of triangles. The
/// direction that the file calls up is ignored, as robots' programs do: coordinates are taken as
/// they are. Without a scene all geometries are taken.
///
/// @param name  First part of messages.
/// @throws InputError with the line if something is missing, no number or out of range, or where a
/// geometry is deformed by bones.
[[nodiscard]] TriangleSurface parse_collada(const std::string& name, std::string_view text);

}  // namespace polhode::geometry
