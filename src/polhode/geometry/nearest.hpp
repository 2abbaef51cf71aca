// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/geometry/shape.hpp>

namespace polhode::geometry {

/// Part of a triangle nearest to a point: its face, edge k from corner k to k + 1, or corner k.
struct TriangleRegion {
  enum Kind { face, edge, corner } kind = face;
  int k = 0;
  Vec3 nearest = Vec3::Zero();
};
[[nodiscard]] TriangleRegion nearest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b,
                                                 const Vec3& c);

/// Part of a convex polyhedron nearest to a point; inside, the face of smallest depth.
struct PolyhedronRegion {
  int triangle = 0;
  TriangleRegion region;
  bool inside = false;
};
[[nodiscard]] PolyhedronRegion nearest_on_polyhedron(const Shape& shape, const Vec3& p);

/// Parameters of the nearest points of two segments p + s u and q + t v, each in [0, 1], and
/// whether they are at an end.
struct SegmentsRegion {
  double s = 0.0, t = 0.0;
  bool s_free = true, t_free = true;
};
[[nodiscard]] SegmentsRegion nearest_on_segments(const Vec3& p, const Vec3& u, const Vec3& q,
                                                 const Vec3& v);

/// Parameter t of the point of an ellipsoid nearest to y (in its principal axes): the point is
/// aᵢ² yᵢ/(aᵢ² + t); negative inside.
[[nodiscard]] double nearest_on_ellipsoid(const Vec3& half, const Vec3& y);

}  // namespace polhode::geometry
