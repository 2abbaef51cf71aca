// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/dynamics/placement.hpp>
#include <polhode/geometry/shape.hpp>

namespace polhode::contact {

/// Which two features meet.
enum class GapKind {
  point_solid,     ///< Corner i of a, the whole convex solid of b.
  point_triangle,  ///< Corner i of a, triangle j of the surface b.
  point_edge,      ///< Corner i of a, edge j of the surface b.
  point_corner,    ///< Corner i of a, corner j of the surface b.
  point_surface,   ///< Corner i of a, the whole surface of triangles b.
  edge_edge,       ///< Edge i of a, edge j of b.
  extreme_plane,   ///< Extreme point i of the round a, the plane b.
  part_solid,      ///< Part i of the round a, the whole convex polyhedron b.
  part_triangle,   ///< Part i of the round a, triangle j of the surface b.
  part_edge,       ///< Part i of the round a, edge j of the surface b.
  part_corner,     ///< Part i of the round a, corner j of the surface b.
  part_surface,    ///< Part i of the round a, the whole surface of triangles b.
  round_edge,      ///< The round solid of a, edge j of b.
  round_round,     ///< The round solids of a and b.
};

/// How the potential of a feature pair is weighted, by the angle between a direction of a and one
/// of b, so that it fades where its distance has no unique direction.
enum class Fade {
  none,
  parallel,  ///< Fades out as the directions become parallel: m = x(2 − x), x = sin²/1e-3.
  flat,      ///< Is there only while they are nearly opposite: 1 − m.
};

/// Two features that can touch: of shapes a and b. A contact point belongs to one of these; the
/// energy of contact is the sum over all of them, a function of the configuration alone.
struct FeaturePair {
  GapKind kind = GapKind::point_solid;
  int i = 0, j = 0;
  double weight = 1.0;  ///< −1 for what two triangles count twice: their common edge.
  Fade fade = Fade::none;
};

/// Distance of two features at an instant. The normal points from b to a.
template <class T>
struct Gap {
  T distance{};     ///< g, roundings subtracted; negative: they overlap [m].
  V3<T> normal;     ///< Unit.
  V3<T> point;      ///< Midway between the two surfaces, world [m].
  T slope{1.0};     ///< |∂g/∂x|: below or above 1 where several features count.
  T share{1.0};     ///< Of forces of all features, by size, over that of the gap.
  int feature = 0;  ///< Which part of b was nearest: 0 its face, else an edge or corner.
};

/// Distance, normal and point of a feature pair; with Dual their derivatives as well.
template <class T>
[[nodiscard]] Gap<T> gap(const FeaturePair& pair, const Shape& a, const Shape& b,
                         const Placement<T>& at_a, const Placement<T>& at_b);

/// A point x with a ball of radius rho around it against the whole convex solid of b.
template <class T>
[[nodiscard]] Gap<T> point_over_solid(const V3<T>& x, double rho, const Shape& b,
                                      const Placement<T>& at_b);

/// What of the round solid a comes near to faces, an ellipsoid: all of an ellipsoid, or of a
/// cylinder or cone the disc at its end `which`, which bulges a little to the outside.
[[nodiscard]] Shape part_of(const Shape& a, int which);

/// The directions that a Fade compares, carried by a and b (of any length, not changing).
template <class T>
struct FadeDirections {
  V3<T> a, b;
};
template <class T>
[[nodiscard]] FadeDirections<T> fade_directions(const FeaturePair& pair, const Shape& a,
                                                const Shape& b, const Placement<T>& at_a,
                                                const Placement<T>& at_b);

}  // namespace polhode::contact
