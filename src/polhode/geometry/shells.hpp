// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <polhode/geometry/triangle_surface.hpp>

namespace polhode::geometry {

/// A corner of a shell that lies where its orientation is impossible: inside a solid although it
/// faces outward, or outside of all although it is a cavity. The volume between would count twice.
///
/// A shell is a connected part of the surface. Over all other shells, the winding number is 0
/// around one that faces outward and 1 around a cavity; several corners of the shell must agree
/// that it is not, so that shells that touch are allowed.
///
/// @param surface  Closed and consistently oriented, equal points joined.
[[nodiscard]] std::optional<Vec3> misplaced_shell(const TriangleSurface& surface);

}  // namespace polhode::geometry
