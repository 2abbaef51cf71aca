// SPDX-License-Identifier: Apache-2.0
#include <stdexcept>

#include <polhode/contact/gap_parts.hpp>
#include <polhode/contact/mouth_rim.hpp>
#include <polhode/contact/round_solids/round_solid.hpp>
#include <polhode/contact/surface_features.hpp>
#include <polhode/contact/tube.hpp>
#include <polhode/geometry/nearest.hpp>

namespace polhode::contact {

template <class T>
Gap<T> over_triangle(const V3<T>& x, double rho_a, const geometry::Shape& b, int triangle,
                     const geometry::TriangleRegion& r, const Placement<T>& at_b) {
  const auto& c = b.triangles[triangle];
  Gap<T> g;
  const V3<T> first = at_b.point(b.corners[c[r.k]]);
  switch (r.kind) {
    case geometry::TriangleRegion::face: {
      // A surface has two sides; the solid of a polyhedron has one.
      const Vec3& normal = b.planes[triangle].normal;
      const bool behind = b.solid == geometry::Solid::surface &&
                          normal.dot(at_b.to_body(value(x))) < b.planes[triangle].offset;
      g = over_plane(x, first, at_b.vector(behind ? Vec3(-normal) : normal), rho_a, b.rounding);
      return g;
    }
    case geometry::TriangleRegion::edge: {
      const V3<T> along = at_b.between(b.corners[c[r.k]], b.corners[c[(r.k + 1) % 3]]);
      g = between_points(x, on_line(x, first, along), rho_a, b.rounding);
      g.feature = 1 + b.triangle_edges[triangle][r.k];
      return g;
    }
    case geometry::TriangleRegion::corner:
      g = between_points(x, first, rho_a, b.rounding);
      g.feature = -1 - c[r.k];
      return g;
  }
  return g;
}

namespace {

template <class T>
Gap<T> over_segment(const V3<T>& x, double rho_a, const geometry::Shape& b,
                    const Placement<T>& at_b) {
  const Vec3 &p = b.corners[b.edges[0].i], &q = b.corners[b.edges[0].j];
  const Vec3 v = q - p, X = at_b.to_body(value(x));
  const double t = (X - p).dot(v) / v.squaredNorm();
  const V3<T> y = t <= 0.0   ? at_b.point(p)
                  : t >= 1.0 ? at_b.point(q)
                             : on_line(x, at_b.point(p), at_b.between(p, q));
  Gap<T> g = between_points(x, y, rho_a, b.rounding);
  g.feature = t <= 0.0 ? -1 - b.edges[0].i : t >= 1.0 ? -1 - b.edges[0].j : 1;
  return g;
}

template <class T>
Gap<T> edges(const geometry::Shape& a, const geometry::Shape& b, int i, int j,
             const Placement<T>& at_a, const Placement<T>& at_b) {
  const geometry::Shape::Edge &e = a.edges[i], &f = b.edges[j];
  const V3<T> p = at_a.point(a.corners[e.i]), u = at_a.between(a.corners[e.i], a.corners[e.j]);
  const V3<T> q = at_b.point(b.corners[f.i]), v = at_b.between(b.corners[f.i], b.corners[f.j]);
  const geometry::SegmentsRegion r =
      geometry::nearest_on_segments(value(p), value(u), value(q), value(v));
  V3<T> x = p + r.s * u, y = q + r.t * v;
  if (r.s_free && r.t_free) {
    const V3<T> w = p - q;
    const T uu = dot(u, u), uv = dot(u, v), vv = dot(v, v), uw = dot(u, w), vw = dot(v, w);
    const T determinant = uu * vv - uv * uv;
    if (value(determinant) > 1e-10 * value(uu) * value(vv)) {
      const T s = (uv * vw - uw * vv) / determinant;
      x = p + s * u;
      y = q + ((uv * s + vw) / vv) * v;
    } else {
      y = on_line(x, q, v);
    }
  } else if (r.s_free) {
    x = on_line(y, p, u);
  } else if (r.t_free) {
    y = on_line(x, q, v);
  }
  return between_points(x, y, a.rounding, b.rounding);
}

}  // namespace

template <class T>
Gap<T> point_over_solid(const V3<T>& x, double rho_a, const geometry::Shape& b,
                        const Placement<T>& at_b) {
  switch (b.solid) {
    case geometry::Solid::ball:
      return between_points(x, at_b.point(b.centre), rho_a, b.rounding);
    case geometry::Solid::segment:
      return over_segment(x, rho_a, b, at_b);
    case geometry::Solid::polyhedron: {
      const geometry::PolyhedronRegion r =
          geometry::nearest_on_polyhedron(b, at_b.to_body(value(x)));
      return over_triangle(x, rho_a, b, r.triangle, r.region, at_b);
    }
    case geometry::Solid::round:
      return b.round_solid->formulas<T>().over(x, rho_a, b, at_b);
    case geometry::Solid::surface:
      if (is_tube(b)) return over_tube(x, rho_a, b, at_b);
      break;
    case geometry::Solid::half_space:
      return over_plane(x, at_b.point(b.centre), at_b.vector(b.axes.col(2)), rho_a, b.rounding);
  }
  throw std::logic_error("point_over_solid: a surface of triangles is no solid");
}

template <class T>
Gap<T> gap(const FeaturePair& pair, const geometry::Shape& a, const geometry::Shape& b,
           const Placement<T>& at_a, const Placement<T>& at_b) {
  const auto x = [&] { return at_a.point(a.corners[pair.i]); };
  switch (pair.kind) {
    case GapKind::point_solid:
      return point_over_solid(x(), a.rounding, b, at_b);
    case GapKind::point_triangle: {
      const V3<T> p = x();
      const auto& c = b.triangles[pair.j];
      const geometry::TriangleRegion r = geometry::nearest_on_triangle(
          at_b.to_body(value(p)), b.corners[c[0]], b.corners[c[1]], b.corners[c[2]]);
      return over_triangle(p, a.rounding, b, pair.j, r, at_b);
    }
    case GapKind::point_surface:
      return point_over_surface(x(), a.rounding, surface_reach(a, b), b, at_b);
    case GapKind::edge_edge:
      return edges(a, b, pair.i, pair.j, at_a, at_b);
    case GapKind::extreme_plane: {
      const V3<T> n = at_b.vector(b.axes.col(2));
      return over_plane(extreme_point(a, pair.i, n, at_a), at_b.point(b.centre), n, a.rounding,
                        b.rounding);
    }
    case GapKind::part_solid:
    case GapKind::part_triangle:
    case GapKind::part_surface:
      return part_gap(part_of(a, pair.i), surface_reach(a, b), pair, b, at_a, at_b);
    case GapKind::round_edge:
      return round_over_edge(a, b, pair.j, at_a, at_b);
    case GapKind::round_round:
      return round_over_round(a, b, at_a, at_b);
    case GapKind::end_round:
      return end_over_round(a, pair.i, b, at_a, at_b);
    case GapKind::part_end:
      return part_over_end(part_of(a, pair.i), b, at_a, at_b);
    case GapKind::rim_edge:
      return rim_over_edge(a, pair.i, b, pair.j, at_a, at_b);
    case GapKind::rim_bar:
      return rim_over_bar(a, pair.i, b, at_a, at_b);
  }
  return {};
}

template <class T>
FadeDirections<T> fade_directions(const FeaturePair& pair, const geometry::Shape& a,
                                  const geometry::Shape& b, const Placement<T>& at_a,
                                  const Placement<T>& at_b) {
  const auto edge = [](const geometry::Shape& s, int k) {
    return Vec3((s.corners[s.edges[k].j] - s.corners[s.edges[k].i]).normalized());
  };
  if (pair.kind == GapKind::edge_edge)
    return {at_a.vector(edge(a, pair.i)), at_b.vector(edge(b, pair.j))};
  if ((pair.kind == GapKind::round_edge && pair.fade != Fade::aligned) ||
      pair.kind == GapKind::rim_edge)
    return {at_a.vector(Vec3(a.axes.col(2))), at_b.vector(edge(b, pair.j))};
  // A rim faces along the axis to its own side.
  const bool low = pair.kind == GapKind::point_solid && pair.fade == Fade::flat &&
                   (a.corners[pair.i] - a.centre).dot(a.axes.col(2)) < 0.0;
  return {at_a.vector(low ? Vec3(-a.axes.col(2)) : Vec3(a.axes.col(2))),
          at_b.vector(b.axes.col(2))};
}

template Gap<double> gap(const FeaturePair&, const geometry::Shape&, const geometry::Shape&,
                         const Placement<double>&, const Placement<double>&);
template Gap<Dual> gap(const FeaturePair&, const geometry::Shape&, const geometry::Shape&,
                       const Placement<Dual>&, const Placement<Dual>&);
template Gap<Fine> gap(const FeaturePair&, const geometry::Shape&, const geometry::Shape&,
                       const Placement<Fine>&, const Placement<Fine>&);
template FadeDirections<double> fade_directions(const FeaturePair&, const geometry::Shape&,
                                                const geometry::Shape&, const Placement<double>&,
                                                const Placement<double>&);
template FadeDirections<Dual> fade_directions(const FeaturePair&, const geometry::Shape&,
                                              const geometry::Shape&, const Placement<Dual>&,
                                              const Placement<Dual>&);
template Gap<double> point_over_solid(const V3<double>&, double, const geometry::Shape&,
                                      const Placement<double>&);
template Gap<Fine> point_over_solid(const V3<Fine>&, double, const geometry::Shape&,
                                    const Placement<Fine>&);
template Gap<Dual> point_over_solid(const V3<Dual>&, double, const geometry::Shape&,
                                    const Placement<Dual>&);

template Gap<double> over_triangle(const V3<double>&, double, const geometry::Shape&, int,
                                   const geometry::TriangleRegion&, const Placement<double>&);

template Gap<Dual> over_triangle(const V3<Dual>&, double, const geometry::Shape&, int,
                                 const geometry::TriangleRegion&, const Placement<Dual>&);

template Gap<Fine> over_triangle(const V3<Fine>&, double, const geometry::Shape&, int,
                                 const geometry::TriangleRegion&, const Placement<Fine>&);

}  // namespace polhode::contact
