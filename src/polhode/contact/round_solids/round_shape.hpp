// SPDX-License-Identifier: Apache-2.0
// Parts of which the kinds of round solids are made.
#pragma once

#include <algorithm>

#include <polhode/contact/round_solids/round_solid.hpp>

namespace polhode::contact {

/// A shape of that kind without rounding, ends and bounds.
/// @param half  From its centre to the ends of its extent, along its axes [m].
[[nodiscard]] geometry::Shape round_shape(const RoundSolid& kind, const Vec3& half,
                                          const geometry::ShapePlace& place);

/// Adds a flat end, the points of its rim, and those that support it when it stands on a face:
/// slightly inside, so that a tilted rim rolls on its disc.
void add_flat_end(geometry::Shape& s, double height, double radius);

/// Ratio of two components of a direction, over the blur, beyond which the support point of a
/// straight side is near its end.
inline constexpr double kFar = 30.0;

/// Bulge of an end, as a part of its radius. An edge may lie on an end, which is rounded therefore;
/// it is flat to the disc of another solid, which is strictly convex.
[[nodiscard]] inline double bulge_of_end(bool flat, double blur) {
  constexpr double kRounded = 1e-2, kFlat = 1e-5;
  return flat ? std::max(kFlat, blur) : kRounded;
}

/// x = centre + Σ B²n/|Bn|, the support point of a sum of ellipsoids with semi-axes B along `axes`.
/// @eq{contact-round-support}
template <class T>
[[nodiscard]] V3<T> of_ellipsoid(const Vec3& B, const V3<T>* axes, const T* n) {
  const T length =
      sqrt(B[0] * B[0] * (n[0] * n[0]) + B[1] * B[1] * (n[1] * n[1]) + B[2] * B[2] * (n[2] * n[2]));
  V3<T> x = constant<T>(Vec3::Zero());
  for (int i = 0; i < 3; ++i) x = x + (B[i] * B[i] * n[i] / length) * axes[i];
  return x;
}

/// Support point of that sum for a direction n in the world.
template <class T>
[[nodiscard]] V3<T> of_ellipsoid(const Vec3& B, const V3<T>* axes, const V3<T>& n) {
  const T components[3] = {dot(axes[0], n), dot(axes[1], n), dot(axes[2], n)};
  return of_ellipsoid(B, axes, components);
}

/// Like `of_ellipsoid`, along the axes. The derivative of B²n/|Bn| is (B² − x xᵀ)/|Bn|.
[[nodiscard]] CurvedSupport curved_ellipsoid(const Vec3& B, const Vec3& n);

}  // namespace polhode::contact
