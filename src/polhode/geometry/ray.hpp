// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/core/types.hpp>

namespace polhode::geometry {

/// Crossing of a triangle by a ray from the origin, corners counterclockwise seen from outside: 1
/// on its way out, −1 on its way in, 0 for none. Over a closed surface the sum is the winding
/// number about the origin, provided that the ray meets no edge.
[[nodiscard]] inline int crossing(const Vec3& ray, const Vec3& a, const Vec3& b, const Vec3& c) {
  const double p = ray.dot(a.cross(b)), q = ray.dot(b.cross(c)), r = ray.dot(c.cross(a));
  const double ahead = a.dot(b.cross(c));
  if (p >= 0.0 && q >= 0.0 && r >= 0.0 && p + q + r > 0.0) return ahead > 0.0 ? 1 : 0;
  if (p <= 0.0 && q <= 0.0 && r <= 0.0 && p + q + r < 0.0) return ahead < 0.0 ? -1 : 0;
  return 0;
}

/// Generic direction, not aligned with typical model geometry; all its coordinates are positive.
inline const Vec3 kAnyRay(0.3127, 0.5471, 0.7766);

}  // namespace polhode::geometry
