// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/core/types.hpp>

namespace polhode {

/// Linear momentum p = m ṙ [kg m/s].
[[nodiscard]] inline Vec3 linear_momentum(double mass, const Vec3& r_dot) { return mass * r_dot; }

/// Rate of the linear momentum, ṗ = m r̈ [N]; equals the external force f^ext.
/// @eq{eq:rbm-linear-momentum-balance}
[[nodiscard]] inline Vec3 linear_momentum_rate(double mass, const Vec3& r_ddot) {
  return mass * r_ddot;
}

/// Angular momentum about the centre of mass, h = J·ω [N m s], all spatial.
[[nodiscard]] inline Vec3 angular_momentum(const Mat3& J, const Vec3& omega) { return J * omega; }

/// Rate of the angular momentum, ḣ = ω × h + J·α [N m]; equals the external moment m^ext about the
/// centre of mass. All spatial, J at the body's present orientation.
/// @eq{eq:rbm-angular-momentum-balance} @eq{ga-h-dot}
[[nodiscard]] inline Vec3 angular_momentum_rate(const Mat3& J, const Vec3& omega,
                                                const Vec3& alpha) {
  return omega.cross(J * omega) + J * alpha;
}

/// Angular momentum about the origin of space, r × p + h [N m s].
[[nodiscard]] inline Vec3 angular_momentum_about_origin(const Vec3& r, const Vec3& p,
                                                        const Vec3& h) {
  return r.cross(p) + h;
}

}  // namespace polhode
