// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include <polhode/surface_contact/rigid_mesh.hpp>

namespace polhode::surface_contact {

/// A rigid surface in contact with points of solids, in its own coordinates y.
///
/// Gaps are distances to a core (plane, point, segment, disc, box) minus a radius, so they and
/// their gradients are continuous; edges are rounded by `rounding`. A tube is a rectangle rotated
/// about its axis, near which both sides count. Other nonconvex shapes are surfaces of triangles,
/// see RigidMesh.
struct RigidSurface {
  enum class Kind : unsigned char {
    plane,     ///< z = 0, the free side above.
    sphere,    ///< About the origin.
    capsule,   ///< About the z axis, ends of its axis at ±half[2].
    cylinder,  ///< About the z axis, from −half[2] to half[2].
    box,       ///< From −half to half.
    tube,      ///< About the z axis, from −half[2] to half[2], with a bore of radius half[1].
    hollow_sphere,  ///< About the origin; its inside is free.
    convex,         ///< `solid`: an ellipsoid, cone or convex hull.
    mesh            ///< `triangles`: of a closed surface or a height field.
  };
  Kind kind = Kind::plane;
  double radius = 0.0;       ///< [m]
  Vec3 half = Vec3::Zero();  ///< [m]
  double rounding = 0.0;     ///< Of the edges of boxes, cylinders and tubes [m].
  std::shared_ptr<const geometry::Shape> solid = nullptr;
  std::shared_ptr<const RigidMesh> triangles = nullptr;

  using Gap = SurfaceGap;
  [[nodiscard]] Gap gap(const Vec3& y, const GapQuery& question) const;
  /// Distance to the surface: the gap, of several features the smallest one.
  /// @param at_most  As in GapQuery, like `sided`.
  [[nodiscard]] double distance(const Vec3& y,
                                double at_most = std::numeric_limits<double>::infinity(),
                                bool sided = false) const;
  /// Radius about the origin that contains the surface [m]; infinite for planes, height fields and
  /// where it is not known.
  [[nodiscard]] double extent() const;

 private:
  [[nodiscard]] Gap plain_gap(const Vec3& y) const;
  [[nodiscard]] Gap far_side(const Vec3& y) const;
};

}  // namespace polhode::surface_contact
