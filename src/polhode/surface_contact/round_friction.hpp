// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/surface_contact/plane_friction.hpp>

namespace polhode::surface_contact {

/// Friction of a round section about a point, such as a cable, on a triangle: normal to the
/// connection with the nearest point of the triangle, be that on its face, an edge or a corner.
/// @eq{cable-mesh-friction}
/// @param kept  The bristle at t_n; it rotates with the triangle.
[[nodiscard]] FourSlide round_friction(const FourMoves& moves, double alpha, const SurfaceLaw& law,
                                       double pressure, const Vec3& kept, bool tangent);

}  // namespace polhode::surface_contact
