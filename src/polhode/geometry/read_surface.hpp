// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include <polhode/geometry/triangle_surface.hpp>

namespace polhode::geometry {

/// Reads a triangle surface; the format follows from the file name: .stl (text or binary), .obj,
/// .dae (COLLADA), or .msh of MuJoCo.
///
/// Corners with equal coordinates are merged. Polygons of an .obj become fans of triangles. Nothing
/// else is repaired: see check_closed() and orient_outward().
///
/// @throws InputError with the file, and its line or triangle, when the file cannot be read, is
/// truncated, has a coordinate that is no finite number, or has no triangles.
[[nodiscard]] TriangleSurface read_surface(const std::string& path);

/// Reads a triangle surface like read_surface(), from the bytes of a file in memory.
/// @param name  First part of messages; its ending chooses the format.
[[nodiscard]] TriangleSurface parse_surface(const std::string& name, std::string_view bytes);

}  // namespace polhode::geometry
