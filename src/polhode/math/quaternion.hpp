// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include <polhode/core/types.hpp>

namespace polhode {

/// Unit quaternion of cay[chi]. It contains half of the angle 2 atan(χ/2), and needs no
/// trigonometry: q = (1, χ/2) / sqrt(1 + χ²/4). @eq{ga-cay-as-exp}
[[nodiscard]] inline Quat quaternion_from_cayley(const Vec3& chi) {
  const double w = 1.0 / std::sqrt(1.0 + 0.25 * chi.squaredNorm());
  const Vec3 v = 0.5 * w * chi;
  return {w, v.x(), v.y(), v.z()};
}

/// Unit quaternion of the rotation by |chi| [rad] about chi.
[[nodiscard]] inline Quat quaternion_from_rotation_vector(const Vec3& chi) {
  const double half = 0.5 * chi.norm();
  const double sinc_half = half < 1e-4 ? 1.0 - half * half / 6.0 : std::sin(half) / half;
  const Vec3 v = 0.5 * sinc_half * chi;
  return {std::cos(half), v.x(), v.y(), v.z()};
}

/// Rotation vector [rad] of a unit quaternion, angle in [0, π].
[[nodiscard]] inline Vec3 rotation_vector(const Quat& q) {
  const double sine = q.vec().norm();
  const double sign = q.w() < 0.0 ? -1.0 : 1.0;
  if (sine < 1e-8) return 2.0 * sign * q.vec();  // next term: sine³/3
  return 2.0 * std::atan2(sine, sign * q.w()) / sine * sign * q.vec();
}

/// The same rotation with w >= 0, the form used in results.
[[nodiscard]] inline Quat shown(const Quat& q) {
  return q.w() < 0.0 ? Quat(-q.w(), -q.x(), -q.y(), -q.z()) : q;
}

}  // namespace polhode
