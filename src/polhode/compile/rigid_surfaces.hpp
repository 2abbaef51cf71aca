// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <polhode/model/model.hpp>
#include <polhode/surface_contact/rigid_surface.hpp>

namespace polhode {

/// Half the smallest extent of a shape [m]; infinite for a plane.
[[nodiscard]] double half_size(const ShapeSpec& shape);

/// The length that a tolerance of the gap is to be small against: half the smallest extent, of
/// surfaces of triangles their median edge [m].
[[nodiscard]] double smallest_detail(const ShapeSpec& shape);

/// The widest tolerance that does not reach through the triangles of a shape [m]; others have no
/// limit.
/// @param radius  Of a cable, which keeps that away beside it [m].
[[nodiscard]] double widest_tolerance(const ShapeSpec& shape, double radius = 0.0);

/// The widest tolerance of a cable of some radius against what has no inside [m].
[[nodiscard]] double widest_tolerance(double radius);

/// What a tolerance between a cable and a shape is to be small against, and the depth of the middle
/// of the shape, through which none is to go [m]. Surfaces of triangles may be thin anywhere.
struct CableSizes {
  double smallest, through;
};
[[nodiscard]] CableSizes cable_sizes(const ShapeSpec& shape, double radius);

/// A shape as surfaces of solids meet it, in its own coordinates. Its edges are rounded by the
/// tolerance of the gap, as far as the shape allows. A tube is round, but for cables that would
/// touch its bore on both sides: for them it is made of triangles.
/// @param radius  Of a cable [m].
[[nodiscard]] RigidSurface rigid_surface(const std::string& where, const ShapeSpec& shape,
                                         double tolerance, double radius = 0.0);

}  // namespace polhode
