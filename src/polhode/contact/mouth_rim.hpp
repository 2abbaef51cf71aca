// SPDX-License-Identifier: Apache-2.0
// Gaps of the inner rims of a tube, which are circles.
#pragma once

#include <polhode/contact/tube.hpp>

namespace polhode::contact {

/// Numbers of arcs of both inner rims of a tube: halves 0 to 3, since a bar that lies across a
/// mouth touches the rim where it leaves the mouth and where it enters it, and whole rims 4 and 5,
/// for bars nearly along the axis, which have no such direction.
inline constexpr int kHalfRims = 4, kRimArcs = 6;
[[nodiscard]] constexpr bool is_whole_rim(int number) { return number >= kHalfRims; }
[[nodiscard]] constexpr bool is_upper_rim(int number) {
  return is_whole_rim(number) ? number > kHalfRims : number >= kHalfRims / 2;
}

/// Gap of an arc of an inner rim and edge j of b. The normal points from b to the tube.
/// @param number  Of the arc, below kRimArcs.
template <class T>
[[nodiscard]] Gap<T> rim_over_edge(const geometry::Shape& tube, int number,
                                   const geometry::Shape& b, int j, const Placement<T>& at_tube,
                                   const Placement<T>& at_b);

/// Gap of half an inner rim and a cylinder, likewise; below kHalfRims.
template <class T>
[[nodiscard]] Gap<T> rim_over_bar(const geometry::Shape& tube, int number,
                                  const geometry::Shape& bar, const Placement<T>& at_tube,
                                  const Placement<T>& at_bar);

/// Whether an edge of a shape stands for an arc of an inner rim.
[[nodiscard]] inline bool is_rim_arc(const geometry::Shape& s, int edge) {
  return is_tube(s) && s.edges[edge].convex && is_inner_edge(s, edge);
}

/// Gap of an arc of an inner rim and a convex solid, which may touch all of the rim at once. The
/// normal points from the solid to the tube.
template <class T>
[[nodiscard]] Gap<T> arc_over_solid(const geometry::Shape& tube, int arc,
                                    const geometry::Shape& solid, const Placement<T>& at_tube,
                                    const Placement<T>& at_solid);

/// Direction, at a point near an inner rim and in body coordinates, away from the tube: to its axis
/// and out of the mouth.
[[nodiscard]] Vec3 out_of_rim(const geometry::Shape& tube, const Vec3& X);

}  // namespace polhode::contact
