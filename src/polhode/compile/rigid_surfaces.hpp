// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <polhode/model/model.hpp>
#include <polhode/surface_contact/rigid_surface.hpp>

namespace polhode {

/// Half the smallest extent of a shape [m]; infinite for a plane.
[[nodiscard]] double half_size(const ShapeSpec& shape);

/// Reference length of gap tolerances: half the smallest extent, for surfaces of triangles their
/// median edge [m].
[[nodiscard]] double smallest_detail(const ShapeSpec& shape);

/// Largest tolerance that does not extend through the triangles of a shape [m]; others have no
/// limit.
/// @param radius  Of a cable, which is kept away in addition [m].
[[nodiscard]] double widest_tolerance(const ShapeSpec& shape, double radius = 0.0);

/// Largest tolerance of a cable of this radius against surfaces without an inside [m].
[[nodiscard]] double widest_tolerance(double radius);

/// Reference length of the tolerance between a cable and a shape, and the depth of the middle of
/// the shape, which must not be passed [m]. Surfaces of triangles may be thin anywhere.
struct CableSizes {
  double smallest, through;
};
[[nodiscard]] CableSizes cable_sizes(const ShapeSpec& shape, double radius);

/// A shape for contact with surfaces of solids, in its own coordinates. Its edges are rounded by
/// the tolerance of the gap, as far as the shape allows.
/// @throws InputError if it has no form for a kind of shape.
[[nodiscard]] surface_contact::RigidSurface rigid_surface(const std::string& where,
                                                          const ShapeSpec& shape, double tolerance);

}  // namespace polhode
