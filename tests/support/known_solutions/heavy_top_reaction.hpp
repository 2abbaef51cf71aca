// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/core/types.hpp>

namespace polhode::test {

/// Force of the ground on a body that turns about a fixed point, from its state: Euler's equations
/// about that point give the angular acceleration, Newton's the force.
///
/// @param q, W     Orientation and angular velocity in body axes.
/// @param J_fixed  Inertia about the fixed point, body axes.
/// @param Z        Centre of mass from the fixed point, body axes.
inline Vec3 fixed_point_reaction(const Quat& q, const Vec3& W, double mass, const Mat3& J_fixed,
                                 const Vec3& Z, const Vec3& gravity) {
  const Vec3 g = q.conjugate() * gravity;
  const Vec3 A = J_fixed.inverse() * (mass * Z.cross(g) - W.cross(J_fixed * W));
  const Vec3 acceleration = A.cross(Z) + W.cross(W.cross(Z));
  return q * (mass * (acceleration - g));
}

}  // namespace polhode::test
