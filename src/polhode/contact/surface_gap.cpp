// SPDX-License-Identifier: Apache-2.0
#include <polhode/contact/gap_parts.hpp>
#include <polhode/contact/surface_features.hpp>

namespace polhode::contact {

namespace {

/// Offset, as a part of the rounding, at which the nearest features of a point are determined:
/// exactly over an edge or corner neighbouring points still agree on them.
constexpr double kAside = 1e-7;

/// A point as seen from a surface.
struct SeenPoint {
  const geometry::Shape& b;
  Vec3 y;
  double rho;

  [[nodiscard]] SurfacePlace place(int kind, int index, const Vec3& nearest) const {
    return {kind, index, (y - nearest).norm() - rho, 0.0, 0};
  }
  [[nodiscard]] SurfacePlace triangle(int t) const {
    const auto& c = b.triangles[t];
    const geometry::TriangleRegion r =
        geometry::nearest_on_triangle(y, b.corners[c[0]], b.corners[c[1]], b.corners[c[2]]);
    if (r.kind == geometry::TriangleRegion::face) return place(0, t, r.nearest);
    if (r.kind == geometry::TriangleRegion::edge)
      return place(1, b.triangle_edges[t][r.k], r.nearest);
    return place(2, c[r.k], r.nearest);
  }
  [[nodiscard]] SurfacePlace edge(int e) const {
    const Vec3& p = b.corners[b.edges[e].i];
    const Vec3 v = b.corners[b.edges[e].j] - p;
    const double t = (y - p).dot(v) / v.squaredNorm();
    if (t <= 0.0) return corner(b.edges[e].i);
    if (t >= 1.0) return corner(b.edges[e].j);
    return place(1, e, p + t * v);
  }
  [[nodiscard]] SurfacePlace corner(int k) const { return place(2, k, b.corners[k]); }
};

template <class T>
Gap<T> over_place(const V3<T>& x, double rho, const geometry::Shape& b, const SurfacePlace& place,
                  const Placement<T>& at_b) {
  if (place.kind == 0) return over_triangle(x, rho, b, place.index, {}, at_b);
  const geometry::Shape::Edge* edge = place.kind == 1 ? &b.edges[place.index] : nullptr;
  const V3<T> first = at_b.point(b.corners[edge ? edge->i : place.index]);
  const V3<T> y =
      edge ? on_line(x, first, at_b.between(b.corners[edge->i], b.corners[edge->j])) : first;
  Gap<T> g = between_points(x, y, rho, b.rounding);
  g.feature = edge ? 1 + place.index : -1 - place.index;
  return g;
}

/// Point, slightly beside y, at which the features near y are determined; coordinates of b.
Vec3 aside(const Vec3& y, const geometry::Shape& b) {
  return y + kAside * b.rounding * Vec3(0.618, -0.325, 0.716);
}

/// Triangles that a ball around the point y may reach.
SurfaceSearch& triangles_near(const Vec3& y, double round, double reach, const geometry::Shape& b) {
  SurfaceSearch& search = SurfaceSearch::of_this_thread();
  search.triangles.clear();
  const double near = (reach + round) * (reach + round);
  b.tree->visit([&](const auto& box) { return box.squared_distance(y) <= near; },
                [&](int t) { search.triangles.push_back(t); });
  return search;
}

}  // namespace

/// @eq{contact-one-gap}
template <class T>
Gap<T> point_over_surface(const V3<T>& x, double rho, double reach, const geometry::Shape& b,
                          const Placement<T>& at_b) {
  const double round = rho + b.rounding;
  const Vec3 y = aside(at_b.to_body(value(x)), b);
  const geometry::TriangleTree::Hit hit =
      b.tree->nearest(y, std::numeric_limits<double>::infinity());
  const auto nearest = [&] { return over_triangle(x, rho, b, hit.triangle, hit.region, at_b); };
  if (!(hit.distance - round < reach)) return nearest();
  SurfaceSearch& search = triangles_near(y, round, reach, b);
  find_places_that_count(b, search, reach, SeenPoint{b, y, round});
  const std::vector<SurfacePlace>& places = search.places;
  if (places.empty()) return nearest();
  if (places.size() == 1) return over_place(x, rho, b, places.front(), at_b);
  OneGap<T> sum(reach);
  for (const SurfacePlace& p : places) sum.add(over_place(x, rho, b, p, at_b), p.count);
  return sum.gap();
}

void point_gaps(const Vec3& x, double rho, double reach, const geometry::Shape& b,
                const Placement<double>& at_b, std::vector<Gap<double>>& gaps) {
  const V3<double> at = constant<double>(x);
  const double round = rho + b.rounding;
  const Vec3 y = aside(at_b.to_body(x), b);
  SurfaceSearch& search = triangles_near(y, round, reach, b);
  find_least_places(b, search, reach, SeenPoint{b, y, round});
  for (const SurfacePlace& p : search.places)
    add_from_outside(over_place(at, rho, b, p, at_b), p, b, at_b, gaps);
}

void add_from_outside(const Gap<double>& g, const SurfacePlace& place, const geometry::Shape& b,
                      const Placement<double>& at_b, std::vector<Gap<double>>& gaps) {
  if (place.count <= 0) return;
  if (place.kind < 2) {
    const Vec3 outward = place.kind == 0 ? b.planes[place.index].normal : b.edges[place.index].out;
    if (value(g.normal).dot(value(at_b.vector(outward))) < 0.0) return;
  }
  gaps.push_back(g);
}

template Gap<double> point_over_surface(const V3<double>&, double, double, const geometry::Shape&,
                                        const Placement<double>&);
template Gap<Dual> point_over_surface(const V3<Dual>&, double, double, const geometry::Shape&,
                                      const Placement<Dual>&);
template Gap<Fine> point_over_surface(const V3<Fine>&, double, double, const geometry::Shape&,
                                      const Placement<Fine>&);

}  // namespace polhode::contact
