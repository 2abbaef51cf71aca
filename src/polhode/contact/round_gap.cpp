// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/LU>

#include <polhode/contact/gap_parts.hpp>
#include <polhode/contact/mouth_rim.hpp>
#include <polhode/contact/round_solids/cylinder.hpp>
#include <polhode/contact/round_solids/round_shape.hpp>
#include <polhode/contact/separation.hpp>
#include <polhode/contact/tube.hpp>

namespace polhode::contact {

namespace {

/// Support point of a round solid, from its centre, in the unit direction n.
template <class T>
V3<T> support(const geometry::Shape& s, const V3<T>* axes, const V3<T>& n) {
  return s.round_solid->formulas<T>().support(s, axes, n, blur::fine);
}

/// Support point of a shape in the world.
template <class T>
struct Axes {
  V3<T> axis[3];
  V3<T> centre;
  Axes(const geometry::Shape& s, const Placement<T>& at) : centre(at.point(s.centre)) {
    for (int i = 0; i < 3; ++i) axis[i] = at.vector(s.axes.col(i));
  }
};

template <class T>
Mat3 values(const Axes<T>& axes) {
  Mat3 columns;
  for (int i = 0; i < 3; ++i) columns.col(i) = value(axes.axis[i]);
  return columns;
}

/// Half thickness of a needle over its length.
constexpr double kSlender = 1e-6;

/// An edge as a slender cylinder. Unlike a straight line it has a unique nearest point to a face
/// that it lies on.
geometry::Shape needle(const geometry::Shape& b, int edge) {
  const Vec3 &p = b.corners[b.edges[edge].i], &q = b.corners[b.edges[edge].j];
  geometry::Shape s;
  const double length = (q - p).norm(), thickness = kSlender * length;
  s.solid = geometry::Solid::round;
  s.round_solid = &cylinder_solid();
  s.rounding = std::max(0.0, b.rounding - thickness);
  s.centre = 0.5 * (p + q);
  s.half = {thickness, thickness, 0.5 * length};
  s.axes.col(2) = (q - p).normalized();
  s.axes.col(0) = s.axes.col(2).unitOrthogonal();
  s.axes.col(1) = s.axes.col(2).cross(s.axes.col(0));
  return s;
}

/// @param start  Approximate direction from b to a.
template <class T>
Gap<T> smooth_gap(const geometry::Shape& a, const geometry::Shape& b, const Placement<T>& at_a,
                  const Placement<T>& at_b, const Vec3& start) {
  const Axes<T> on_a(a, at_a), on_b(b, at_b);
  const V3<T> between = on_a.centre - on_b.centre;
  const Separation s = separate(a, b, values(on_a), values(on_b), value(between), start);
  // n in T: one Newton step from the direction found in plain numbers.
  Vec3 e, f;
  tangents(s.n, e, f);
  const V3<T> n_0 = constant<T>(s.n);
  const V3<T> w_0 = between + support<T>(a, on_a.axis, -n_0) - support<T>(b, on_b.axis, n_0);
  const T r_e = dot(v3(e), w_0), r_f = dot(v3(f), w_0);
  const Eigen::Matrix2d inverse = s.M.inverse();
  const T d_e = inverse(0, 0) * r_e + inverse(0, 1) * r_f;
  const T d_f = inverse(1, 0) * r_e + inverse(1, 1) * r_f;
  const V3<T> n = unit(n_0 + d_e * v3(e) + d_f * v3(f));
  const V3<T> x = on_a.centre + support<T>(a, on_a.axis, -n);
  const V3<T> y = on_b.centre + support<T>(b, on_b.axis, n);
  Gap<T> g;
  g.normal = n;
  g.distance = dot(n, x - y);
  g.point = 0.5 * (x + y);
  return g;
}

}  // namespace

template <class T>
V3<T> extreme_point(const geometry::Shape& a, int which, const V3<T>& n, const Placement<T>& at_a) {
  const Axes<T> at(a, at_a);
  if (a.flat_ends.empty()) {
    const T components[3] = {-dot(at.axis[0], n), -dot(at.axis[1], n), -dot(at.axis[2], n)};
    return at.centre + of_ellipsoid<T>(a.half, at.axis, components);
  }
  const auto& [height, radius] = a.flat_ends[static_cast<std::size_t>(which)];
  const T x = -dot(at.axis[0], n), y = -dot(at.axis[1], n);
  const T across = sqrt(x * x + y * y + 1e-24);
  return at.centre + height * at.axis[2] + (radius * x / across) * at.axis[0] +
         (radius * y / across) * at.axis[1];
}

namespace {

/// Directions around a tube's axis from which its nearest place is searched.
constexpr int kDirections = 24;
/// Projections onto both shapes in turn in that search, from each direction and from the best.
constexpr int kProjections = 3, kLastProjections = 6;

double wall_of(const geometry::Shape& tube) {
  return tube.half[0] - tube.half[1] + 2.0 * tube.rounding;
}

/// Whether a tube's hull, at this distance from another shape, stands for the tube: they do not
/// overlap deeply, and the nearest place of the hull lies outside the middle of the wall. Elsewhere
/// the other shape is within the tube, or in front of its mouth.
bool hull_stands_for(const geometry::Shape& tube, const Vec3& nearest, double distance) {
  const double half = 0.5 * wall_of(tube);
  return distance > -half &&
         std::hypot(nearest.x(), nearest.y()) > tube.half[0] + tube.rounding - half;
}

/// Place of the outer side of a tube nearest to another shape, in its own axes: the best of those
/// found from several directions, no bound.
/// @param distance  Gap of a place [m], and a point of the other shape near it.
template <class Distance>
Vec3 nearest_on_side(const geometry::Shape& tube, const Distance& distance) {
  const double R = tube.half[0], H = hull_of_tube(tube).half[2];
  const auto onto_side = [&](const Vec3& y) {
    const double q = std::hypot(y.x(), y.y());
    return q > 0.0 ? Vec3(R / q * y.x(), R / q * y.y(), std::clamp(y.z(), -H, H))
                   : Vec3(R, 0.0, std::clamp(y.z(), -H, H));
  };
  Vec3 best = Vec3::Zero(), other;
  double least = std::numeric_limits<double>::infinity();
  const auto descend = [&](Vec3 place, int count) {
    for (int k = 0; k <= count; ++k) {
      const double d = distance(place, other);
      if (d < least) least = d, best = place;
      place = onto_side(other);
    }
  };
  for (int k = 0; k < kDirections; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / kDirections;
    for (const double height : {-H, 0.0, H})
      descend({R * std::cos(angle), R * std::sin(angle), height}, kProjections);
  }
  descend(best, kLastProjections);
  return best;
}

template <class T>
Mat3 rotation(const Placement<T>& at) {
  Mat3 L;
  for (int i = 0; i < 3; ++i) L.col(i) = value(at.vector(Vec3::Unit(i)));
  return L;
}

/// Gap of the outer side of a tube over a shape that its hull does not stand for: no contact,
/// unless it has passed through the wall.
template <class T>
Gap<T> side_over(const geometry::Shape& tube, const geometry::Shape& b, const Placement<T>& at_tube,
                 const Placement<T>& at_b) {
  const auto world = [&](const auto& at, const Vec3& y) {
    return at.point(tube.centre + tube.axes * y);
  };
  const Mat3 L_tube = rotation(at_tube), L_b = rotation(at_b);
  const Placement<double> plain(value(at_tube.point(Vec3::Zero())), L_tube, 0),
      plain_b(value(at_b.point(Vec3::Zero())), L_b, 6);
  const Vec3 place = nearest_on_side(tube, [&](const Vec3& y, Vec3& other) {
    const Gap<double> g = point_over_solid(world(plain, y), tube.rounding, b, plain_b);
    const Vec3 surface = value(g.point) - 0.5 * g.distance * value(g.normal);
    other = tube.axes.transpose() * (plain.to_body(surface) - tube.centre);
    return g.distance;
  });
  Gap<T> g = point_over_solid(world(at_tube, place), tube.rounding, b, at_b);
  g.feature = kInMouth;
  const double wall = wall_of(tube), open = 0.25 * wall, d = value(g.distance);
  if (d > -0.5 * wall && d < open) g.distance = T(open);
  return g;
}

/// Convex shape that stands for a round one: a tube's hull, the needle of a segment, or its own.
geometry::Shape convex(const geometry::Shape& s) {
  if (s.solid == geometry::Solid::segment) return needle(s, 0);
  if (is_tube(s)) return hull_of_tube(s);
  geometry::Shape own;
  own.solid = s.solid, own.round_solid = s.round_solid;
  own.centre = s.centre, own.axes = s.axes, own.half = s.half, own.rounding = s.rounding;
  return own;
}

/// Flattens the ends of a shape for contact with a strictly convex one.
void flatten(geometry::Shape& s) {
  if (s.round_solid->with_flat_ends) s.round_solid = s.round_solid->with_flat_ends;
}

/// The gap g of two convex shapes that stand for a and b, where hulls stand for tubes; elsewhere
/// that of the tube's outer side.
template <class T>
Gap<T> gap_or_open(const Gap<T>& g, const geometry::Shape& convex_a, const geometry::Shape& a,
                   const geometry::Shape& convex_b, const geometry::Shape& b,
                   const Placement<T>& at_a, const Placement<T>& at_b) {
  const Vec3 half = 0.5 * value(g.distance) * value(g.normal), middle = value(g.point);
  const auto stands = [&](const geometry::Shape& s, const Placement<T>& at, const Vec3& nearest) {
    return !is_tube(s) || hull_stands_for(s, s.axes.transpose() * (at.to_body(nearest) - s.centre),
                                          value(g.distance));
  };
  const bool of_a = stands(a, at_a, middle + half), of_b = stands(b, at_b, middle - half);
  if (of_a && of_b) return g;
  Gap<T> open;
  if (!of_a) open = side_over(a, is_tube(b) ? b : convex_b, at_a, at_b);
  if (!of_b) {
    Gap<T> other = side_over(b, is_tube(a) ? a : convex_a, at_b, at_a);
    other.normal = -other.normal;
    if (of_a || value(other.distance) < value(open.distance)) open = other;
  }
  return open;
}

/// Gap of two convex shapes that stand for a and b.
/// @param start  Approximate direction from b to a.
template <class T>
Gap<T> convex_gap(const geometry::Shape& convex_a, const geometry::Shape& a,
                  const geometry::Shape& convex_b, const geometry::Shape& b,
                  const Placement<T>& at_a, const Placement<T>& at_b, const Vec3& start) {
  return gap_or_open(smooth_gap(convex_a, convex_b, at_a, at_b, start), convex_a, a, convex_b, b,
                     at_a, at_b);
}

}  // namespace

template <class T>
Gap<T> round_over_round(const geometry::Shape& a, const geometry::Shape& b,
                        const Placement<T>& at_a, const Placement<T>& at_b) {
  geometry::Shape on_a = convex(a), on_b = convex(b);
  // The end of one is flat to an ellipsoid, which is strictly convex.
  if (b.flat_ends.empty()) flatten(on_a);
  if (a.flat_ends.empty()) flatten(on_b);
  return convex_gap(on_a, a, on_b, b, at_a, at_b,
                    value(at_a.point(a.centre)) - value(at_b.point(b.centre)));
}

template <class T>
Gap<T> end_over_round(const geometry::Shape& a, int which, const geometry::Shape& b,
                      const Placement<T>& at_a, const Placement<T>& at_b) {
  const geometry::Shape disc = end_disc(a, which);
  geometry::Shape other = convex(b);
  flatten(other);
  return convex_gap(disc, a, other, b, at_a, at_b,
                    value(at_a.point(disc.centre)) - value(at_b.point(other.centre)));
}

template <class T>
Gap<T> round_over_edge(const geometry::Shape& a, const geometry::Shape& b, int edge,
                       const Placement<T>& at_a, const Placement<T>& at_b) {
  const geometry::Shape slender = needle(b, edge), own = convex(a);
  if (is_rim_arc(b, edge)) {
    Gap<T> g = arc_over_solid(b, edge, own, at_b, at_a);
    g.normal = -g.normal;
    return gap_or_open(g, own, a, slender, slender, at_a, at_b);
  }
  // As if a were a ball: the nearest point of the needle is that of the edge.
  const Vec3 X = at_b.to_body(value(at_a.point(a.centre))) - slender.centre,
             v = slender.axes.col(2);
  const double half = slender.half.z(), along = std::clamp(v.dot(X), -half, half);
  return convex_gap(own, a, slender, slender, at_a, at_b, value(at_b.vector(Vec3(X - along * v))));
}

template V3<double> extreme_point(const geometry::Shape&, int, const V3<double>&,
                                  const Placement<double>&);
template V3<Dual> extreme_point(const geometry::Shape&, int, const V3<Dual>&,
                                const Placement<Dual>&);
template V3<Fine> extreme_point(const geometry::Shape&, int, const V3<Fine>&,
                                const Placement<Fine>&);
template Gap<double> round_over_edge(const geometry::Shape&, const geometry::Shape&, int,
                                     const Placement<double>&, const Placement<double>&);
template Gap<Dual> round_over_edge(const geometry::Shape&, const geometry::Shape&, int,
                                   const Placement<Dual>&, const Placement<Dual>&);
template Gap<Fine> round_over_edge(const geometry::Shape&, const geometry::Shape&, int,
                                   const Placement<Fine>&, const Placement<Fine>&);
template Gap<double> round_over_round(const geometry::Shape&, const geometry::Shape&,
                                      const Placement<double>&, const Placement<double>&);
template Gap<Fine> round_over_round(const geometry::Shape&, const geometry::Shape&,
                                    const Placement<Fine>&, const Placement<Fine>&);
template Gap<Dual> round_over_round(const geometry::Shape&, const geometry::Shape&,
                                    const Placement<Dual>&, const Placement<Dual>&);
template Gap<double> end_over_round(const geometry::Shape&, int, const geometry::Shape&,
                                    const Placement<double>&, const Placement<double>&);
template Gap<Dual> end_over_round(const geometry::Shape&, int, const geometry::Shape&,
                                  const Placement<Dual>&, const Placement<Dual>&);
template Gap<Fine> end_over_round(const geometry::Shape&, int, const geometry::Shape&,
                                  const Placement<Fine>&, const Placement<Fine>&);

}  // namespace polhode::contact
