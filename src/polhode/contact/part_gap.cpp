// SPDX-License-Identifier: Apache-2.0
// Distances between a part of a round solid and features with faces. They are smooth, since one of
// both is strictly convex and the other convex; the rim of a tube is an exception, see ring.hpp.
#include <algorithm>
#include <array>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include <polhode/contact/gap_parts.hpp>
#include <polhode/contact/round_solids/ellipsoid.hpp>
#include <polhode/contact/round_solids/ring.hpp>
#include <polhode/contact/surface_features.hpp>
#include <polhode/contact/tube.hpp>
#include <polhode/geometry/nearest.hpp>

namespace polhode::contact {

namespace {

/// Bulge of the disc at an end of a cylinder or cone, as a part of its radius.
constexpr double kBulge = 2e-3;

/// Half thickness of a ring, as a part of its radius.
constexpr double kThin = 1e-6;
/// Number of places along an edge at which its distance from a ring, which may have two minima, is
/// compared.
constexpr int kPlaces = 32;

/// Feature of b nearest to a part.
struct Nearest {
  enum Kind { none, face, edge, corner, overlap } kind = none;
  int index = 0;
  double t = 0.0;  ///< Along an edge; with an overlap, the angle of a place on the ring.
  double distance = std::numeric_limits<double>::infinity();
};

/// A part as seen from a body b with faces.
class SeenPart {
 public:
  template <class T>
  SeenPart(const Shape& part, const Placement<T>& at_a, const Placement<T>& at_b)
      : ring_(is_ring(part)),
        half_(part.half),
        centre_(at_b.to_body(value(at_a.point(part.centre)))),
        farthest_(part.half.maxCoeff()) {
    const Vec3 origin = at_b.to_body(Vec3::Zero());
    for (int i = 0; i < 3; ++i)
      axes_.col(i) = at_b.to_body(value(at_a.vector(part.axes.col(i)))) - origin;
  }
  [[nodiscard]] const Vec3& centre() const { return centre_; }
  [[nodiscard]] bool ring() const { return ring_; }

  /// Nearest point of a plane if it lies in its triangle; where the part penetrates the plane, the
  /// middle of the section.
  /// @param sides  2: a two-sided triangle.
  /// @returns the signed distance of the part from the plane.
  double face(const Shape& b, int triangle, int sides, Nearest& best) const {
    const auto& c = b.triangles[triangle];
    const Vec3 &p = b.corners[c[0]], &q = b.corners[c[1]], &r = b.corners[c[2]];
    Vec3 n = b.planes[triangle].normal;
    double height = n.dot(centre_ - p);
    if (sides == 2 && height < 0.0) n = -n, height = -height;
    Vec3 to_nearest;
    const double reach = extent(n, to_nearest), distance = height - reach;
    // The lowest place of a ring below the plane may lie beyond the solid, within the ring.
    if (height < 0.0 || (ring_ && distance < 0.0)) return distance;
    const Vec3 x = centre_ + std::min(1.0, height / reach) * to_nearest;
    const Vec3 u = q - p, v = r - p, w = x - p, m = u.cross(v);
    const double size = m.squaredNorm(), s = w.cross(v).dot(m) / size, t = u.cross(w).dot(m) / size;
    if (s < 0.0 || t < 0.0 || s + t > 1.0) return distance;
    // Of several penetrated faces, the one with the shortest exit.
    if (best.kind != Nearest::face || !(best.distance > distance))
      best = {Nearest::face, triangle, 0.0, distance};
    return distance;
  }

  /// Overlap of a ring and the convex polyhedron b: the face through which the arcs of it that lie
  /// below all planes leave on the shortest way, and the angle of their deepest place.
  [[nodiscard]] Nearest overlap(const Shape& b) const {
    using Arc = std::pair<double, double>;
    constexpr double kTurn = 2.0 * std::numbers::pi;
    std::vector<Arc> inside{{0.0, kTurn}}, left;
    for (const auto& plane : b.planes) {
      const Height h = height_above(plane);
      if (h.middle >= h.most) return {};
      if (h.middle <= -h.most) continue;
      // Angles of negative height.
      const double half = std::acos(-h.middle / h.most);
      double first = h.highest + half;
      first -= kTurn * std::floor(first / kTurn);
      const double last = first + kTurn - 2.0 * half;
      left.clear();
      for (const Arc& arc : inside)
        for (const double shift : {0.0, kTurn}) {
          const double low = std::max(arc.first, first - shift),
                       high = std::min(arc.second, last - shift);
          if (low < high) left.emplace_back(low, high);
        }
      inside.swap(left);
      if (inside.empty()) return {};
    }
    Nearest best;
    best.distance = -std::numeric_limits<double>::infinity();
    for (int f = 0; f < static_cast<int>(b.planes.size()); ++f) {
      const Height h = height_above(b.planes[f]);
      double lowest = std::numeric_limits<double>::infinity(), angle = 0.0;
      for (const Arc& arc : inside)
        for (double at : {arc.first, arc.second, h.highest + 0.5 * kTurn}) {
          at = arc.first + std::remainder(at - arc.first - 0.5 * kTurn, kTurn) + 0.5 * kTurn;
          if (at > arc.second) at = arc.second;
          const double height = h.middle + h.most * std::cos(at - h.highest);
          if (height < lowest) lowest = height, angle = at;
        }
      if (lowest > best.distance) best = {Nearest::overlap, f, angle, lowest};
    }
    return best;
  }

  /// Lower bound of the distance: convex bodies lie behind their tangent planes, so no point of a
  /// box is nearer.
  [[nodiscard]] double bound(const Vec3& low, const Vec3& high) const {
    const Vec3 y = axes_.transpose() * (0.5 * (low + high) - centre_);
    const double root = nearest_on_ellipsoid(half_, y);
    const Vec3 n = y.cwiseQuotient((half_.cwiseAbs2().array() + root).matrix()).normalized();
    if (!n.allFinite()) return -farthest_ - (high - low).norm();
    return n.dot(y) - half_.cwiseProduct(n).norm() - 0.5 * (axes_ * n).cwiseAbs().dot(high - low);
  }

  /// Distance of a point from the part. @param n  Direction in which it grows, in axes of the part.
  [[nodiscard]] double from(const Vec3& y, Vec3& n) const {
    if (ring_) {
      const Vec3 outward = across(y);
      n = y - half_.x() * outward;
      const double distance = n.norm();
      n = distance > 0.0 ? Vec3(n / distance) : outward;
      return distance;
    }
    const double root = nearest_on_ellipsoid(half_, y);
    n = y.cwiseQuotient((half_.cwiseAbs2().array() + root).matrix()).normalized();
    return n.dot(y) - half_.cwiseProduct(n).norm();
  }

  [[nodiscard]] double corner(const Vec3& x) const {
    Vec3 n;
    return ring_ ? from(axes_.transpose() * (x - centre_), n) : bound(x, x);
  }

  void edge(const Shape& b, int index, Nearest& best) const {
    const Vec3 &p = b.corners[b.edges[index].i], v = b.corners[b.edges[index].j] - p;
    const double middle = std::clamp((centre_ - p).dot(v) / v.squaredNorm(), 0.0, 1.0);
    if ((centre_ - p - middle * v).norm() - farthest_ > best.distance) return;
    const Vec3 X = axes_.transpose() * (p - centre_), V = axes_.transpose() * v;
    const auto at = [&](double t, double& distance) {
      Vec3 n;
      distance = from(X + t * V, n);
      return n.dot(V);
    };
    // The distance from a convex part is convex along the edge: its slope changes sign once.
    const auto refine = [&](double low, double high) {
      double d_low = 0.0, d_high = 0.0;
      double s_low = at(low, d_low), s_high = at(high, d_high);
      const auto take = [&](double t, double distance) {
        if (!(distance < best.distance)) return;
        if (t == 0.0 || t == 1.0)
          best = {Nearest::corner, t == 0.0 ? b.edges[index].i : b.edges[index].j, 0.0, distance};
        else
          best = {Nearest::edge, index, t, distance};
      };
      if (s_low >= 0.0) return take(low, d_low);
      if (s_high <= 0.0) return take(high, d_high);
      double t = 0.5 * (low + high), distance = 0.0;
      const double enough = 1e-13 * v.norm();
      for (int k = 0, side = 0; k < 100 && high - low > 1e-15; ++k) {  // Illinois
        t = k % 8 == 7 ? 0.5 * (low + high) : (low * s_high - high * s_low) / (s_high - s_low);
        const double s = at(t, distance);
        if (std::abs(s) < enough) break;
        if (s < 0.0) {
          low = t, s_low = s;
          if (side == -1) s_high *= 0.5;
          side = -1;
        } else {
          high = t, s_high = s;
          if (side == 1) s_low *= 0.5;
          side = 1;
        }
      }
      take(t, distance);
    };
    ring_ ? around_minima(X, V, middle, at, refine) : refine(0.0, 1.0);
  }

 private:
  /// Height of a ring above a plane: middle + most·cos(angle − highest).
  struct Height {
    double middle, most, highest;
  };
  template <class Plane>
  [[nodiscard]] Height height_above(const Plane& plane) const {
    const Vec3 n = half_.x() * (axes_.transpose() * plane.normal);
    return {plane.normal.dot(centre_) - plane.offset, std::hypot(n.x(), n.y()),
            std::atan2(n.y(), n.x())};
  }

  /// Unit vector of a direction across the axis of a ring, in axes of the part.
  [[nodiscard]] static Vec3 across(const Vec3& y) {
    const double q = std::hypot(y.x(), y.y());
    return q > 0.0 ? Vec3(y.x() / q, y.y() / q, 0.0) : Vec3(Vec3::UnitX());
  }

  /// Extent of the part along n. @param to_nearest  From its centre to its lowest point.
  [[nodiscard]] double extent(const Vec3& n, Vec3& to_nearest) const {
    const Vec3 along = axes_.transpose() * n;
    if (ring_) {
      to_nearest = -half_.x() * (axes_ * across(along));
      return half_.x() * std::hypot(along.x(), along.y());
    }
    const Vec3 local = half_.cwiseProduct(along);
    const double reach = local.norm();
    to_nearest = -axes_ * half_.cwiseProduct(local) / reach;
    return reach;
  }

  /// Calls refine(low, high) for the ranges of an edge around the minima of its distance from a
  /// ring. The nearest place is no farther from the centre than that nearest to the centre plus two
  /// radii.
  template <class At, class Refine>
  void around_minima(const Vec3& X, const Vec3& V, double middle, const At& at,
                     const Refine& refine) const {
    const double near = (X + middle * V).norm(), far = near + 2.0 * half_.x(),
                 along = std::sqrt(far * far - near * near) / V.norm();
    const double first = std::max(0.0, middle - along), last = std::min(1.0, middle + along);
    const auto place = [&](int k) {
      return k == kPlaces ? last : first + (last - first) * k / kPlaces;
    };
    std::array<double, kPlaces + 1> distance{};
    for (int k = 0; k <= kPlaces; ++k) at(place(k), distance[k]);
    for (int k = 0; k <= kPlaces; ++k) {
      const int before = std::max(0, k - 1), after = std::min(kPlaces, k + 1);
      if (distance[k] <= distance[before] && distance[k] <= distance[after])
        refine(place(before), place(after));
    }
  }

  bool ring_;
  Vec3 half_, centre_;
  Mat3 axes_;
  double farthest_;
};

/// Data of each triangle, edge and corner of a surface for part_gap().
struct SeenSurface {
  const SeenPart& part;
  const Shape& b;
  double round;

  [[nodiscard]] SurfacePlace place(const Nearest& n) const {
    const int kind = n.kind == Nearest::face ? 0 : n.kind == Nearest::edge ? 1 : 2;
    return {kind, n.index, n.distance - round, n.t, 0};
  }
  [[nodiscard]] SurfacePlace triangle(int t) const {
    Nearest best;
    if (is_tube(b) && is_inner_side(b, t)) return place(best);
    part.face(b, t, 2, best);
    if (best.kind != Nearest::face)
      for (const int e : b.triangle_edges[t]) part.edge(b, e, best);
    return place(best);
  }
  [[nodiscard]] SurfacePlace edge(int e) const {
    Nearest best;
    if (is_tube(b) && on_inner_side(b, b.edges[e].i) && on_inner_side(b, b.edges[e].j))
      return place(best);
    part.edge(b, e, best);
    return place(best);
  }
  [[nodiscard]] SurfacePlace corner(int k) const {
    if (is_tube(b) && on_inner_side(b, k)) return place({});
    return place({Nearest::corner, k, 0.0, part.corner(b.corners[k])});
  }
};

/// Nearby features of a surface that count, or the nearest one alone.
const std::vector<SurfacePlace>& places_of(const SeenPart& part, const Shape& b, double round,
                                           double reach) {
  const SeenSurface seen{part, b, round};
  SurfaceSearch& search = SurfaceSearch::of_this_thread();
  search.triangles.clear();
  b.tree->visit([&](const auto& box) { return part.bound(box.low, box.high) - round < reach; },
                [&](int t) { search.triangles.push_back(t); });
  find_places_that_count(b, search, reach, seen);
  if (!search.places.empty()) return search.places;
  SurfacePlace best;
  best.gap = std::numeric_limits<double>::infinity();
  b.tree->visit([&](const auto& box) { return part.bound(box.low, box.high) - round < best.gap; },
                [&](int t) {
                  const SurfacePlace one = seen.triangle(t);
                  if (one.gap < best.gap) best = one;
                });
  best.count = 1;
  search.places.push_back(best);
  return search.places;
}

Nearest nearest_of(const FeaturePair& pair, const Shape& b, const SeenPart& part) {
  Nearest best;
  switch (pair.kind) {
    case GapKind::part_corner:
      best.kind = Nearest::corner;
      best.index = pair.j;
      return best;
    case GapKind::part_edge:
      part.edge(b, pair.j, best);
      return best;
    case GapKind::part_triangle:
      part.face(b, pair.j, 2, best);
      if (best.kind == Nearest::face) return best;
      for (const int e : b.triangle_edges[pair.j]) part.edge(b, e, best);
      return best;
    default:
      break;
  }
  Nearest shallowest{Nearest::face, 0, 0.0, -std::numeric_limits<double>::infinity()};
  bool inside = true;
  for (int t = 0; t < static_cast<int>(b.triangles.size()); ++t) {
    const double distance = part.face(b, t, 1, best);
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
Gap<T> over_face(const Shape& part, const Shape& b, int triangle, bool behind,
                 const Placement<T>& at_a, const Placement<T>& at_b) {
  const V3<T> n =
      at_b.vector(behind ? Vec3(-b.planes[triangle].normal) : b.planes[triangle].normal);
  return over_plane(extreme_point(part, 0, n, at_a),
                    at_b.point(b.corners[b.triangles[triangle][0]]), n, part.rounding, b.rounding);
}

/// Position along the edge with its derivatives, by a Newton step. The distance depends on neither
/// these nor the last digits of the position.
template <class T>
Gap<T> over_edge(const Shape& part, const Shape& b, int edge, double t, const Placement<T>& at_a,
                 const Placement<T>& at_b) {
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
V3<T> farthest_from_axis(const Shape& part, const Shape& tube, const Placement<T>& at_a,
                         const Placement<T>& at_b) {
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

Shape part_of(const Shape& a, int which) {
  Shape part;
  part.solid = Solid::round;
  if (is_tube(a)) {  // its outer rim, slightly behind the end, on whose inner rim it stands
    const auto& [height, radius] = a.flat_ends[static_cast<std::size_t>(which)];
    const double behind = std::min(kBulge * radius, 0.5 * a.half[2]);
    part.round_solid = &ring_solid();
    part.rounding = a.rounding;
    part.axes = a.axes;
    part.centre = a.centre + (height < 0.0 ? height + behind : height - behind) * a.axes.col(2);
    part.half = {radius, radius, kThin * radius};
    return part;
  }
  part.round_solid = &ellipsoid_solid();
  part.rounding = a.rounding;
  part.axes = a.axes;
  part.centre = a.centre;
  part.half = a.half;
  if (a.flat_ends.empty()) return part;
  const auto& [height, radius] = a.flat_ends[static_cast<std::size_t>(which)];
  const double bulge = std::min(kBulge * radius, 0.5 * a.half[2]);
  part.half = {radius, radius, bulge};
  part.centre += (height < 0.0 ? height + bulge : height - bulge) * a.axes.col(2);
  return part;
}

template <class T>
Gap<T> part_gap(const Shape& part, double reach, const FeaturePair& pair, const Shape& b,
                const Placement<T>& at_a, const Placement<T>& at_b) {
  if (is_tube(b) && pair.kind == GapKind::part_solid)
    return point_over_solid(farthest_from_axis(part, b, at_a, at_b), part.rounding, b, at_b);
  const SeenPart seen(part, at_a, at_b);
  const auto over = [&](const Nearest& n) {
    if (n.kind == Nearest::face) {
      const auto& plane = b.planes[n.index];
      const bool behind =
          b.solid == Solid::surface && plane.normal.dot(seen.centre()) < plane.offset;
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
  };
  if (pair.kind != GapKind::part_surface) return over(nearest_of(pair, b, seen));
  OneGap<T> sum(reach);
  for (const SurfacePlace& p : places_of(seen, b, part.rounding + b.rounding, reach)) {
    Nearest n;
    n.kind = p.kind == 0 ? Nearest::face : p.kind == 1 ? Nearest::edge : Nearest::corner;
    n.index = p.index;
    n.t = p.t;
    sum.add(over(n), p.count);
  }
  return sum.gap();
}

template Gap<double> part_gap(const Shape&, double, const FeaturePair&, const Shape&,
                              const Placement<double>&, const Placement<double>&);
template Gap<Dual> part_gap(const Shape&, double, const FeaturePair&, const Shape&,
                            const Placement<Dual>&, const Placement<Dual>&);
template Gap<Fine> part_gap(const Shape&, double, const FeaturePair&, const Shape&,
                            const Placement<Fine>&, const Placement<Fine>&);

}  // namespace polhode::contact
