// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/core/types.hpp>

namespace polhode {

/// Axis of a screw motion: a rotation about it and a translation along it.
struct HelicalAxis {
  Vec3 direction = Vec3::Zero();  ///< Unit vector; zero without motion.
  Vec3 point = Vec3::Zero();      ///< Point of the axis nearest to the origin [m].
  double turn = 0.0;              ///< Angle in [0, π] [rad], or its rate [rad/s].
  double slide = 0.0;             ///< Along the direction [m], or its rate [m/s].
};

/// Instantaneous helical axis of a velocity field v(x) = v + ω × (x − r). Without rotation,
/// direction and slide are those of v. @eq{helical-rate}
[[nodiscard]] HelicalAxis helical_axis(const Vec3& r, const Vec3& v, const Vec3& omega);

/// Finite helical axis of a displacement x' = R x + d. Without rotation, direction and slide are
/// those of d. @eq{helical-finite}
[[nodiscard]] HelicalAxis finite_helical_axis(const Mat3& R, const Vec3& d);

}  // namespace polhode
