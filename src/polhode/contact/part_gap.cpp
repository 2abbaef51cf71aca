// SPDX-License-Identifier: Apache-2.0
// Distances between a part of a round solid and features with faces. They are smooth, since one of
// both is strictly convex and the other convex; the rim of a tube is an exception, see ring.hpp.
#include <algorithm>
#include <limits>
#include <vector>

#include <polhode/contact/gap_parts.hpp>
#include <polhode/contact/round_solids/ellipsoid.hpp>
#include <polhode/contact/round_solids/ring.hpp>
#include <polhode/contact/seen_part.hpp>
#include <polhode/contact/surface_features.hpp>
#include <polhode/contact/tube.hpp>
#include <polhode/geometry/nearest.hpp>

namespace polhode::contact {

namespace {

/// Bulge of the disc at an end of a cylinder or cone, as a part of its radius.
constexpr double kBulge = 2e-3;

/// Data of each triangle, edge and corner of a surface for part_gap().
struct SeenSurface {
  const SeenPart& part;
  const geometry::Shape& b;
  double round;
  double reach;  ///< Edges with larger gaps need not be found [m].
  SeenPart::Sides sides = SeenPart::Sides::two;

  [[nodiscard]] SurfacePlace place(const Nearest& n) const {
    SurfacePlace at{0, n.index, n.distance - round, n.t, 0};
    if (n.kind == Nearest::none) at.gap = std::numeric_limits<double>::infinity();
    if (n.kind == Nearest::edge) at.kind = 1;
    if (n.kind == Nearest::corner) at.kind = 2;
    return at;
  }
  [[nodiscard]] SurfacePlace triangle(int t) const {
    Nearest best = within_reach();
    part.face(b, t, sides, best);
    if (best.kind != Nearest::face)
      for (const int e : b.triangle_edges[t]) part.edge(b, e, best);
    return place(best);
  }
  [[nodiscard]] SurfacePlace edge(int e) const {
    Nearest best = within_reach();
    part.edge(b, e, best);
    return place(best);
  }
  [[nodiscard]] Nearest within_reach() const {
    Nearest none;
    none.distance = reach + round;
    return none;
  }
  [[nodiscard]] SurfacePlace corner(int k) const {
    return place({Nearest::corner, k, 0.0, part.corner(b.corners[k])});
  }
};

/// Triangles that the part may reach.
SurfaceSearch& triangles_near(const SeenSurface& seen) {
  SurfaceSearch& search = SurfaceSearch::of_this_thread();
  search.triangles.clear();
  seen.b.tree->visit(
      [&](const auto& box) { return seen.part.bound(box.low, box.high) - seen.round < seen.reach; },
      [&](int t) { search.triangles.push_back(t); });
  return search;
}

/// Places of a surface that count, or the nearest one alone.
const std::vector<SurfacePlace>& places_or_nearest(const SeenSurface& seen) {
  SurfaceSearch& search = triangles_near(seen);
  find_places_that_count(seen.b, search, seen.reach, seen);
  std::vector<SurfacePlace>& places = search.places;
  if (!places.empty()) return places;
  SeenSurface all = seen;
  SurfacePlace best;
  best.gap = all.reach = std::numeric_limits<double>::infinity();
  all.b.tree->visit(
      [&](const auto& box) { return all.part.bound(box.low, box.high) - all.round < best.gap; },
      [&](int t) {
        const SurfacePlace one = all.triangle(t);
        if (one.gap < best.gap) best = one, all.reach = one.gap;
      });
  best.count = 1;
  places.push_back(best);
  return places;
}

Nearest nearest_of(const FeaturePair& pair, const geometry::Shape& b, const SeenPart& part) {
  Nearest best;
  if (pair.kind == GapKind::part_triangle) {
    part.face(b, pair.j, SeenPart::Sides::two, best);
    if (best.kind == Nearest::face) return best;
    for (const int e : b.triangle_edges[pair.j]) part.edge(b, e, best);
    return best;
  }
  Nearest shallowest{Nearest::face, 0, 0.0, -std::numeric_limits<double>::infinity()};
  bool inside = true;
  for (int t = 0; t < static_cast<int>(b.triangles.size()); ++t) {
    const double distance = part.face(b, t, SeenPart::Sides::one, best);
    inside = inside && b.planes[t].normal.dot(part.centre()) < b.planes[t].offset;
    if (distance > shallowest.distance) shallowest = {Nearest::face, t, 0.0, distance};
  }
  if (part.ring()) {
    if (const Nearest into = part.overlap(b); into.kind != Nearest::none) return into;
  } else if (inside) {
    return shallowest;
  }
  if (best.kind == Nearest::face) return best;
  for (int e = 0; e < static_cast<int>(b.edges.size()); ++e) part.edge(b, e, best);
  return best;
}

template <class T>
Gap<T> turned_round(Gap<T> g, int feature) {
  g.normal = -g.normal;
  g.feature = feature;
  return g;
}

template <class T>
Gap<T> over_face(const geometry::Shape& part, const geometry::Shape& b, int triangle, bool behind,
                 const Placement<T>& at_a, const Placement<T>& at_b) {
  const V3<T> n =
      at_b.vector(behind ? Vec3(-b.planes[triangle].normal) : b.planes[triangle].normal);
  return over_plane(extreme_point(part, 0, n, at_a),
                    at_b.point(b.corners[b.triangles[triangle][0]]), n, part.rounding, b.rounding);
}

/// Position along the edge with its derivatives, by a Newton step. The distance depends on neither
/// these nor the last digits of the position.
template <class T>
Gap<T> over_edge(const geometry::Shape& part, const geometry::Shape& b, int edge, double t,
                 const Placement<T>& at_a, const Placement<T>& at_b) {
  const Vec3 &P = b.corners[b.edges[edge].i], &Q = b.corners[b.edges[edge].j];
  const V3<T> p = at_b.point(P), v = at_b.between(P, Q);
  T at(t);
  if constexpr (std::is_same_v<T, Dual>) {
    const Mat3 no_turn = Mat3::Identity();
    const Placement<Dual> still(Vec3::Zero(), no_turn, 0);
    const Vec3 X = at_a.to_body(value(p)), V = at_a.to_body(value(p) + value(v)) - X;
    Dual along(t);
    along.d[11] = 1.0;
    const Gap<Dual> g =
        point_over_solid(constant<Dual>(X) + along * constant<Dual>(V), 0.0, part, still);
    const double curvature = dot(g.normal, constant<Dual>(V)).d[11];
    if (curvature > 0.0) {
      const T slope = dot(point_over_solid(p + t * v, 0.0, part, at_a).normal, v);
      at = t - (1.0 / curvature) * (slope - value(slope));
    }
  }
  return turned_round(point_over_solid(p + at * v, b.rounding, part, at_a), 1 + edge);
}

/// Point of the part farthest from the axis of a tube, where it is in contact with the inner side.
/// The extent n·x of a convex body is largest there over all n normal to the axis.
template <class T>
V3<T> farthest_from_axis(const geometry::Shape& part, const geometry::Shape& tube,
                         const Placement<T>& at_a, const Placement<T>& at_b) {
  const V3<T> e = at_b.vector(tube.axes.col(0)), f = at_b.vector(tube.axes.col(1));
  const V3<T> centre = at_a.point(part.centre), from = at_b.point(tube.centre);
  V3<T> axis[3];
  for (int i = 0; i < 3; ++i) axis[i] = at_a.vector(part.axes.col(i));
  const Vec3 squares = part.half.cwiseAbs2();
  const auto support = [&](const V3<T>& n) {
    T length(0.0);
    for (int i = 0; i < 3; ++i) {
      const T along = dot(axis[i], n);
      length = length + squares[i] * (along * along);
    }
    length = sqrt(length);
    V3<T> x = centre;
    for (int i = 0; i < 3; ++i) x = x + (squares[i] * dot(axis[i], n) / length) * axis[i];
    return x;
  };
  const Vec3 e_0 = value(e), f_0 = value(f), middle = value(centre - from);
  Mat3 shape = Mat3::Zero();
  for (int i = 0; i < 3; ++i) shape += squares[i] * value(axis[i]) * value(axis[i]).transpose();
  double angle = std::atan2(f_0.dot(middle), e_0.dot(middle)), curvature = 0.0;
  for (int k = 0; k < 100; ++k) {
    const Vec3 n = std::cos(angle) * e_0 + std::sin(angle) * f_0,
               t = std::cos(angle) * f_0 - std::sin(angle) * e_0;
    const double length = std::sqrt(n.dot(shape * n));
    const Vec3 s = shape * n / length, x = middle + s;
    curvature = t.dot(shape * t) / length - t.dot(s) * t.dot(s) / length - n.dot(x);
    const double slope = t.dot(x), newton = curvature < 0.0 ? -slope / curvature : 1.0;
    if (std::abs(slope) <= 1e-15 * x.norm()) break;
    angle += std::abs(newton) < 0.3 ? newton : std::atan2(slope, n.dot(x));
  }
  const V3<T> n = std::cos(angle) * e + std::sin(angle) * f,
              t = std::cos(angle) * f - std::sin(angle) * e;
  if (!(curvature < -1e-9 * part.half.maxCoeff())) return support(n);
  const T turn = (-1.0 / curvature) * dot(t, support(n) - from);
  return support(n + turn * t);
}

}  // namespace

namespace {

geometry::Shape ellipsoid_part(const geometry::Shape& a, const Vec3& centre, const Vec3& half) {
  geometry::Shape part;
  part.solid = geometry::Solid::round;
  part.round_solid = &ellipsoid_solid();
  part.rounding = a.rounding;
  part.axes = a.axes;
  part.centre = centre;
  part.half = half;
  return part;
}

}  // namespace

geometry::Shape end_disc(const geometry::Shape& a, int which) {
  const auto& [end, radius] = a.flat_ends[static_cast<std::size_t>(which)];
  // A tube ends in front of the disc, so that only its rims meet what lies in front of the mouth.
  const double half = is_tube(a) ? hull_of_tube(a).half[2] : std::abs(end);
  const double bulge = std::min(kBulge * radius, 0.5 * a.half[2]);
  const double middle = std::copysign(half - bulge, end);
  return ellipsoid_part(a, a.centre + middle * a.axes.col(2), {radius, radius, bulge});
}

geometry::Shape part_of(const geometry::Shape& a, int which) {
  if (is_tube(a)) return outer_rim(a, which);
  return a.flat_ends.empty() ? ellipsoid_part(a, a.centre, a.half) : end_disc(a, which);
}

namespace {

/// Gap of a part to a nearest place of b.
template <class T>
Gap<T> over_nearest(const geometry::Shape& part, const SeenPart& seen, const Nearest& n,
                    const geometry::Shape& b, const Placement<T>& at_a, const Placement<T>& at_b) {
  if (n.kind == Nearest::face) {
    const auto& plane = b.planes[n.index];
    const bool behind =
        b.solid == geometry::Solid::surface && plane.normal.dot(seen.centre()) < plane.offset;
    return over_face(part, b, n.index, behind, at_a, at_b);
  }
  if (n.kind == Nearest::overlap) {
    const Vec3 place = part.centre + part.half.x() * (std::cos(n.t) * part.axes.col(0) +
                                                      std::sin(n.t) * part.axes.col(1));
    return over_plane(at_a.point(place), at_b.point(b.corners[b.triangles[n.index][0]]),
                      at_b.vector(b.planes[n.index].normal), part.rounding, b.rounding);
  }
  if (n.kind == Nearest::edge) return over_edge(part, b, n.index, n.t, at_a, at_b);
  return turned_round(point_over_solid(at_b.point(b.corners[n.index]), b.rounding, part, at_a),
                      -1 - n.index);
}

/// The nearest place on a surface as one of a body with faces.
Nearest nearest_at(const SurfacePlace& p) {
  Nearest n;
  n.kind = p.kind == 0 ? Nearest::face : p.kind == 1 ? Nearest::edge : Nearest::corner;
  n.index = p.index;
  n.t = p.t;
  return n;
}

}  // namespace

template <class T>
Gap<T> part_over_end(const geometry::Shape& part, const geometry::Shape& tube,
                     const Placement<T>& at_a, const Placement<T>& at_tube) {
  const V3<T> axis = at_tube.vector(tube.axes.col(2));
  const V3<T> middle = at_tube.point(tube.centre);
  const double side = value(dot(axis, at_a.point(part.centre) - middle)) < 0.0 ? -1.0 : 1.0;
  const V3<T> lowest = extreme_point(part, 0, side * axis, at_a);
  Gap<T> g = point_over_solid(lowest, part.rounding, tube, at_tube);
  // Behind the end, in the tube, it is out of reach: there the part touches the inner side.
  const T behind = tube.half[2] - side * dot(axis, lowest - middle);
  if (value(g.distance) > -part.rounding - tube.rounding && value(behind) > 0.0)
    g.distance = g.distance + behind;
  return g;
}

template <class T>
Gap<T> part_gap(const geometry::Shape& part, double reach, const FeaturePair& pair,
                const geometry::Shape& b, const Placement<T>& at_a, const Placement<T>& at_b) {
  if (is_tube(b) && pair.kind == GapKind::part_solid)
    return point_over_solid(farthest_from_axis(part, b, at_a, at_b), part.rounding, b, at_b);
  const SeenPart seen(part, at_a, at_b);
  if (pair.kind != GapKind::part_surface)
    return over_nearest(part, seen, nearest_of(pair, b, seen), b, at_a, at_b);
  OneGap<T> sum(reach);
  for (const SurfacePlace& p : places_or_nearest({seen, b, part.rounding + b.rounding, reach}))
    sum.add(over_nearest(part, seen, nearest_at(p), b, at_a, at_b), p.count);
  return sum.gap();
}

void part_gaps(const geometry::Shape& part, double reach, const geometry::Shape& b,
               const Placement<double>& at_a, const Placement<double>& at_b,
               std::vector<Gap<double>>& gaps) {
  const SeenPart seen(part, at_a, at_b);
  const SeenSurface surface{seen, b, part.rounding + b.rounding, reach,
                            SeenPart::Sides::two_or_through};
  SurfaceSearch& search = triangles_near(surface);
  find_least_places(b, search, reach, surface);
  for (const SurfacePlace& p : search.places)
    add_from_outside(over_nearest(part, seen, nearest_at(p), b, at_a, at_b), p, b, at_b, gaps);
}

template Gap<double> part_over_end(const geometry::Shape&, const geometry::Shape&,
                                   const Placement<double>&, const Placement<double>&);
template Gap<Dual> part_over_end(const geometry::Shape&, const geometry::Shape&,
                                 const Placement<Dual>&, const Placement<Dual>&);
template Gap<Fine> part_over_end(const geometry::Shape&, const geometry::Shape&,
                                 const Placement<Fine>&, const Placement<Fine>&);
template Gap<double> part_gap(const geometry::Shape&, double, const FeaturePair&,
                              const geometry::Shape&, const Placement<double>&,
                              const Placement<double>&);
template Gap<Dual> part_gap(const geometry::Shape&, double, const FeaturePair&,
                            const geometry::Shape&, const Placement<Dual>&, const Placement<Dual>&);
template Gap<Fine> part_gap(const geometry::Shape&, double, const FeaturePair&,
                            const geometry::Shape&, const Placement<Fine>&, const Placement<Fine>&);

}  // namespace polhode::contact
