// SPDX-License-Identifier: Apache-2.0
// Distance formulas of parts of features, for the gap sources and their tests.
#pragma once

#include <polhode/contact/gap.hpp>
#include <polhode/geometry/nearest.hpp>

namespace polhode::contact {

/// Gap from the nearest points x of core a and y of core b.
template <class T>
[[nodiscard]] Gap<T> between_points(const V3<T>& x, const V3<T>& y, double rho_a, double rho_b) {
  const V3<T> w = x - y;
  const T length = norm(w);
  Gap<T> g;
  g.normal = (T(1.0) / length) * w;
  g.distance = length - (rho_a + rho_b);
  g.point = 0.5 * (x + y + (rho_b - rho_a) * g.normal);
  return g;
}

/// Signed gap from a point x of core a and a plane of core b through y with outward unit normal n.
template <class T>
[[nodiscard]] Gap<T> over_plane(const V3<T>& x, const V3<T>& y, const V3<T>& n, double rho_a,
                                double rho_b) {
  const T height = dot(n, x - y);
  Gap<T> g;
  g.normal = n;
  g.distance = height - (rho_a + rho_b);
  g.point = x - (0.5 * (height + (rho_a - rho_b))) * n;
  return g;
}

/// Nearest point of the line through q along v.
template <class T>
[[nodiscard]] V3<T> on_line(const V3<T>& x, const V3<T>& q, const V3<T>& v) {
  return q + (dot(x - q, v) / dot(v, v)) * v;
}

/// Gaps with a round solid on side a.
template <class T>
[[nodiscard]] V3<T> extreme_point(const geometry::Shape& a, int which, const V3<T>& n,
                                  const Placement<T>& at_a);
/// @param part  See part_of(); moves with a.
/// @param reach  See surface_reach().
template <class T>
[[nodiscard]] Gap<T> part_gap(const geometry::Shape& part, double reach, const FeaturePair& pair,
                              const geometry::Shape& b, const Placement<T>& at_a,
                              const Placement<T>& at_b);
/// Gap of the lowest point of a part in front of an end of a tube.
template <class T>
[[nodiscard]] Gap<T> part_over_end(const geometry::Shape& part, const geometry::Shape& tube,
                                   const Placement<T>& at_a, const Placement<T>& at_tube);
/// Gap of a ball of radius rho around the point x against the whole surface of b.
/// @param reach  Features with larger gaps than this do not count besides a nearer one [m].
template <class T>
[[nodiscard]] Gap<T> point_over_surface(const V3<T>& x, double rho, double reach,
                                        const geometry::Shape& b, const Placement<T>& at_b);
/// Appends the gaps of that ball at the places of the surface where the distance is least, if below
/// `reach` and seen from outside.
void point_gaps(const Vec3& x, double rho, double reach, const geometry::Shape& b,
                const Placement<double>& at_b, std::vector<Gap<double>>& gaps);
/// Appends the gaps of a part at such places.
void part_gaps(const geometry::Shape& part, double reach, const geometry::Shape& b,
               const Placement<double>& at_a, const Placement<double>& at_b,
               std::vector<Gap<double>>& gaps);
/// Gap of a point against a triangle of b whose nearest part is known.
template <class T>
[[nodiscard]] Gap<T> over_triangle(const V3<T>& x, double rho_a, const geometry::Shape& b,
                                   int triangle, const geometry::TriangleRegion& r,
                                   const Placement<T>& at_b);
template <class T>
[[nodiscard]] Gap<T> round_over_edge(const geometry::Shape& a, const geometry::Shape& b, int edge,
                                     const Placement<T>& at_a, const Placement<T>& at_b);
template <class T>
[[nodiscard]] Gap<T> round_over_round(const geometry::Shape& a, const geometry::Shape& b,
                                      const Placement<T>& at_a, const Placement<T>& at_b);
/// Slightly convex disc at an end of a cylinder, cone or tube, an ellipsoid.
[[nodiscard]] geometry::Shape end_disc(const geometry::Shape& a, int which);
template <class T>
[[nodiscard]] Gap<T> end_over_round(const geometry::Shape& a, int which, const geometry::Shape& b,
                                    const Placement<T>& at_a, const Placement<T>& at_b);

}  // namespace polhode::contact
