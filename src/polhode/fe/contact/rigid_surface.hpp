// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include <polhode/contact/shape.hpp>

namespace polhode {

/// A rigid surface that points of solids meet, in coordinates y of its own.
///
/// Gaps are distances to a convex core (plane, point, segment, disc, box) less
/// a radius, so they and their gradients are continuous; edges are rounded by
/// `rounding`.
struct RigidSurface {
  enum class Kind : unsigned char {
    plane,          ///< z = 0, the free side above.
    sphere,         ///< About the origin.
    capsule,        ///< About the z axis, ends of its axis at ±half[2].
    cylinder,       ///< About the z axis, from −half[2] to half[2].
    box,            ///< From −half to half.
    hollow_sphere,  ///< What lies inside a sphere about the origin is free.
    convex          ///< `solid`: an ellipsoid, cone or convex hull.
  };
  Kind kind = Kind::plane;
  double radius = 0.0;       ///< [m]
  Vec3 half = Vec3::Zero();  ///< [m]
  double rounding = 0.0;     ///< Of the edges of boxes and cylinders [m].
  std::shared_ptr<const contact::Shape> solid = nullptr;

  /// Gap [m], its gradient [-] and Hessian [1/m].
  struct Gap {
    double value = 0.0;
    Vec3 normal = Vec3::UnitZ();
    Mat3 curvature = Mat3::Zero();
  };
  [[nodiscard]] Gap gap(const Vec3& y) const;
  /// The value alone.
  [[nodiscard]] double distance(const Vec3& y) const;
};

}  // namespace polhode
