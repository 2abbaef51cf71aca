// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include <polhode/contact/gap.hpp>

namespace polhode::contact {

/// A hollow round bar along z of the placement, with exact round sides and rims.
///
/// @param outer, inner  Diameters [m].
/// @param polygon  Closed polyhedral approximation; the corners of its rims lie on their circles.
/// @throws InputError as mesh() does.
[[nodiscard]] geometry::Shape tube(std::string_view where, double outer, double inner,
                                   double length, const geometry::TriangleSurface& polygon,
                                   const geometry::ShapePlace& place = {}, double rounding = 0.0);

/// Whether a shape is a tube, a surface with round faces. Its `half` are the outer and inner radius
/// of the core and half its length, along the third of its axes.
[[nodiscard]] inline bool is_tube(const geometry::Shape& s) {
  return s.solid == geometry::Solid::surface && s.half[0] > 0.0;
}

/// Outer rim of a tube, a ring slightly behind its end: it stands on the corners of its inner rims.
[[nodiscard]] geometry::Shape outer_rim(const geometry::Shape& tube, int which);

/// Cylinder between the outer rims, which stands for the tube to what lies outside it.
[[nodiscard]] geometry::Shape hull_of_tube(const geometry::Shape& tube);

/// Whether a corner of a tube's polygon lies on the inner side.
[[nodiscard]] inline bool on_inner_side(const geometry::Shape& tube, int corner) {
  const Vec3 x = tube.axes.transpose() * (tube.corners[corner] - tube.centre);
  return std::hypot(x.x(), x.y()) < 0.5 * (tube.half[0] + tube.half[1]);
}
/// Whether an edge of it is one of the inner side or its rims.
[[nodiscard]] inline bool is_inner_edge(const geometry::Shape& tube, int edge) {
  return on_inner_side(tube, tube.edges[edge].i) && on_inner_side(tube, tube.edges[edge].j);
}

/// Gap of a ball of radius rho around the point x against a tube with round faces.
template <class T>
[[nodiscard]] Gap<T> over_tube(const V3<T>& x, double rho, const geometry::Shape& b,
                               const Placement<T>& at_b);

}  // namespace polhode::contact
