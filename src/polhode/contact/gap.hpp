// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/dynamics/placement.hpp>
#include <polhode/geometry/shape.hpp>

namespace polhode::contact {

/// Kinds of feature pairs.
enum class GapKind {
  point_solid,     ///< Corner i of a, the whole convex solid of b.
  point_triangle,  ///< Corner i of a, triangle j of the surface b.
  point_surface,   ///< Corner i of a, the whole surface of triangles b.
  edge_edge,       ///< Edge i of a, edge j of b.
  extreme_plane,   ///< Extreme point i of the round a, the plane b.
  part_solid,      ///< Part i of the round a, the whole convex polyhedron b.
  part_triangle,   ///< Part i of the round a, triangle j of the surface b.
  part_surface,    ///< Part i of the round a, the whole surface of triangles b.
  round_edge,      ///< The round solid of a, or a tube from outside, edge j of b.
  round_round,     ///< The round solids of a and b, tubes from outside.
  end_round,       ///< Disc at end i of the round a or tube, the round solid, tube or segment b.
  part_end,        ///< Part i of the round a, the nearer end of the tube b.
  rim_edge,        ///< Arc i of the inner rims of the tube a, edge j of b.
  rim_bar,         ///< Arc i of the inner rims of the tube a, the cylinder b.
};

/// Whether side a of a feature pair is a corner.
[[nodiscard]] constexpr bool is_of_corner(GapKind kind) {
  return kind == GapKind::point_solid || kind == GapKind::point_triangle ||
         kind == GapKind::point_surface;
}

/// Whether side a of a feature pair is an inner rim of a tube.
[[nodiscard]] constexpr bool is_of_rim(GapKind kind) {
  return kind == GapKind::rim_edge || kind == GapKind::rim_bar;
}

/// Whether a feature pair may have a tube on a side, for which its hull stands.
[[nodiscard]] constexpr bool is_of_hull(GapKind kind) {
  return kind == GapKind::round_edge || kind == GapKind::round_round || kind == GapKind::end_round;
}

/// Weight of a feature pair's potential as a function of the angle between a direction of a and one
/// of b. The potential fades where the distance has no unique direction.
enum class Fade {
  none,
  parallel,  ///< Fades out as the directions become parallel: m = x(2 − x), x = sin²/fade_square.
  flank,     ///< The same as the flank of a cone becomes parallel to a side, an edge or a flank:
             ///< x = ((y − aligned)(y − opposed)/fade_square)², y the cosine of the angle.
  flat,      ///< Nonzero only while they are nearly opposite: 1 − m.
  aligned,   ///< Nonzero only while they are nearly parallel, in either sense: 1 − m.
};

/// Two features, of shapes a and b, that can be in contact. A contact point belongs to one pair;
/// the contact energy is the sum over all pairs, a function of the configuration alone.
struct FeaturePair {
  GapKind kind = GapKind::point_solid;
  int i = 0, j = 0;
  Fade fade = Fade::none;
  double fade_square = 1e-3;  ///< Square of the sine of the angle below which it fades.
  /// Square of the sine up to which the weight m is zero; x is then measured from it.
  double fade_from = 0.0;
  /// Cosines of the angle between the directions at which flanks are parallel.
  double aligned = 1.0, opposed = -1.0;
};

/// Distance of two features at an instant. The normal points from b to a.
template <class T>
struct Gap {
  T distance{};     ///< g, roundings subtracted; negative: they overlap [m].
  V3<T> normal;     ///< Unit.
  V3<T> point;      ///< Midway between the two surfaces, world [m].
  T slope{1.0};     ///< |∂g/∂x|; not 1 where several features count.
  T share{1.0};     ///< Resultant of the forces of all features over the force of the gap.
  int feature = 0;  ///< Nearest part of b: 0 its face, else an edge or corner; or kInMouth.
};

/// Gap::feature of kinds with is_of_hull() where one is in a tube or in front of its mouth.
inline constexpr int kInMouth = 1;

/// Distance, normal and point of a feature pair; with Dual also their derivatives.
template <class T>
[[nodiscard]] Gap<T> gap(const FeaturePair& pair, const geometry::Shape& a,
                         const geometry::Shape& b, const Placement<T>& at_a,
                         const Placement<T>& at_b);

/// Gap of a ball of radius rho around the point x against the whole convex solid of b.
template <class T>
[[nodiscard]] Gap<T> point_over_solid(const V3<T>& x, double rho, const geometry::Shape& b,
                                      const Placement<T>& at_b);

/// Part of the round solid a for contact with faces: an ellipsoid itself, a slightly convex disc at
/// the end `which` of a cylinder or cone, or the outer rim of a tube there.
[[nodiscard]] geometry::Shape part_of(const geometry::Shape& a, int which);

/// Directions compared by a Fade, fixed to a and b (of any constant length).
template <class T>
struct FadeDirections {
  V3<T> a, b;
};
template <class T>
[[nodiscard]] FadeDirections<T> fade_directions(const FeaturePair& pair, const geometry::Shape& a,
                                                const geometry::Shape& b, const Placement<T>& at_a,
                                                const Placement<T>& at_b);

}  // namespace polhode::contact
