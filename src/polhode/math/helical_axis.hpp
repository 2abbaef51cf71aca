// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/core/types.hpp>

namespace polhode {

/// The axis of a screw motion: a turn about it and a slide along it.
struct HelicalAxis {
  Vec3 direction = Vec3::Zero();  ///< Unit vector; zero where nothing turns.
  Vec3 point = Vec3::Zero();      ///< Of the axis, next to the origin [m].
  double turn = 0.0;              ///< Angle in [0, π] [rad], or its rate [rad/s].
  double slide = 0.0;             ///< Along the direction [m], or its rate [m/s].
};

/// Of a velocity field v(x) = v + ω × (x − r). Where it does not turn, direction and slide are
/// those of v. @eq{helical-rate}
[[nodiscard]] HelicalAxis helical_axis(const Vec3& r, const Vec3& v, const Vec3& omega);

/// Of a displacement x' = R x + d. Where it does not turn, direction and slide are those of d.
/// @eq{helical-finite}
[[nodiscard]] HelicalAxis finite_helical_axis(const Mat3& R, const Vec3& d);

}  // namespace polhode
