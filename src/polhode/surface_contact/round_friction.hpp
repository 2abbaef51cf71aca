// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/surface_contact/plane_friction.hpp>

namespace polhode {

/// Friction of what is round about a point, such as a cable, on a triangle: across the way to the
/// nearest place of the triangle, be that on its face, an edge or a corner.
/// @eq{cable-mesh-friction}
/// @param kept  The bristle at t_n; it turns with the triangle.
[[nodiscard]] FourSlide round_friction(const FourMoves& moves, double alpha, const SurfaceLaw& law,
                                       double pressure, const Vec3& kept, bool tangent);

}  // namespace polhode
