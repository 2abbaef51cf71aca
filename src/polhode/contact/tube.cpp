// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include <polhode/contact/gap_parts.hpp>
#include <polhode/contact/round_solids/cylinder.hpp>
#include <polhode/contact/round_solids/meridian.hpp>
#include <polhode/contact/round_solids/ring.hpp>
#include <polhode/contact/tube.hpp>

namespace polhode::contact {

namespace {

/// Number of fixed points on a rim, as a cylinder has them, for standing on it.
constexpr int kTubeRimPoints = 12;

/// Number of fixed points of an end, on which it stands, and their distance from the inner rim as a
/// part of the wall: what lies in the mouth touches the rim and not these.
constexpr int kStandingPoints = 24;
constexpr double kBehindRim = 0.1;

/// Distance of an outer rim behind its end, as a part of its radius.
constexpr double kSetback = 2e-3;

/// Half thickness of a rim, as a part of its radius.
constexpr double kThin = 1e-6;

/// Half the length between the outer rims [m].
double half_between_rims(const geometry::Shape& tube) {
  return tube.half[2] - std::min(kSetback * tube.half[0], 0.5 * tube.half[2]);
}

}  // namespace

geometry::Shape tube(std::string_view where, double outer, double inner, double length,
                     const geometry::TriangleSurface& polygon, const geometry::ShapePlace& place,
                     double rounding) {
  geometry::Shape s = geometry::mesh(where, polygon, place, rounding);
  const double R = 0.5 * outer - s.rounding, r = 0.5 * inner + s.rounding;
  s.half = {R, r, 0.5 * length - s.rounding};
  s.centre = place.origin;
  s.axes = place.axes;
  s.flat_ends = {{-s.half[2], R}, {s.half[2], R}};
  s.detail = 0.5 * std::min(0.5 * (outer - inner), length);
  s.points.clear();
  for (int i = 0; i < static_cast<int>(s.corners.size()); ++i) {
    const Vec3 x = s.axes.transpose() * (s.corners[i] - s.centre);
    const double step = 2.0 * std::numbers::pi / kTubeRimPoints, angle = std::atan2(x.y(), x.x());
    if (std::hypot(x.x(), x.y()) > 0.5 * (R + r) && std::abs(std::remainder(angle, step)) < 1e-6)
      s.points.push_back(i);
  }
  s.face_points.clear();
  const double standing = r + kBehindRim * (R - r);
  for (const double height : {-s.half[2], s.half[2]})
    for (int k = 0; k < kStandingPoints; ++k) {
      const double angle = 2.0 * std::numbers::pi * k / kStandingPoints;
      const Vec3 x(standing * std::cos(angle), standing * std::sin(angle), height);
      s.face_points.push_back(static_cast<int>(s.corners.size()));
      s.corners.push_back(s.centre + s.axes * x);
    }
  s.border_corner.resize(s.corners.size(), 0);
  return s;
}

geometry::Shape outer_rim(const geometry::Shape& tube, int which) {
  const double radius = tube.half[0], height = half_between_rims(tube);
  geometry::Shape rim;
  rim.solid = geometry::Solid::round;
  rim.round_solid = &ring_solid();
  rim.rounding = tube.rounding;
  rim.axes = tube.axes;
  rim.centre = tube.centre + (which == 0 ? -height : height) * tube.axes.col(2);
  rim.half = {radius, radius, kThin * radius};
  return rim;
}

geometry::Shape hull_of_tube(const geometry::Shape& tube) {
  geometry::Shape hull;
  hull.solid = geometry::Solid::round;
  hull.round_solid = &cylinder_solid();
  hull.rounding = tube.rounding;
  hull.axes = tube.axes;
  hull.centre = tube.centre;
  hull.half = {tube.half[0], tube.half[0], half_between_rims(tube)};
  return hull;
}

/// Distance of a point from the axis, over its height above the mouth of a wide tube, below which
/// the gap to an inner rim is smoothed.
constexpr double kNearAxis = 0.05;

/// Gap to an inner rim in front of the mouth. Its distance has a kink on the axis, where all of the
/// rim is as near; there the distance q from the axis is replaced by s (2 u² − u³), u = q/s, for
/// u < 1. @eq{contact-mouth-on-axis}
/// @param side  Of the end along the axis: −1 or 1.
template <class T>
Gap<T> over_inner_rim(const V3<T>& x, double rho_a, const geometry::Shape& b,
                      const Placement<T>& at_b, const Meridian<T>& m, double side) {
  const double r = b.half[1];
  const T h = side * m.h - b.half[2], s = (kNearAxis * r) * (h / (h + r)), u = m.q / s;
  if (!(value(u) < 1.0))
    return between_points(x, m.point(at_b, b, side * b.half[2], r), rho_a, b.rounding);
  const V3<T> across = x - at_b.point(b.centre) - m.h * m.axis;
  const T distance_q = r - s * (u * u * (2.0 - u)), length = sqrt(distance_q * distance_q + h * h);
  // Derivatives of the replaced q by q, over q, and by h.
  const T by_q = (4.0 - 3.0 * u) / s, by_h = (2.0 * u * u * (u - 1.0)) * (s * (r / (h * (h + r))));
  const V3<T> gradient = (T(-1.0) / length) * (distance_q * by_q * across) +
                         ((side / length) * (h - distance_q * by_h)) * m.axis;
  Gap<T> g;
  g.slope = norm(gradient);
  g.normal = (T(1.0) / g.slope) * gradient;
  g.distance = length - (rho_a + b.rounding);
  g.point = at_b.point(b.centre) + (side * b.half[2]) * m.axis + ((r / s) * (2.0 - u)) * across +
            (b.rounding + 0.5 * g.distance) * g.normal;
  return g;
}

/// Nearest point of a ring with a rectangular section: two round faces and two flat ones.
template <class T>
Gap<T> over_tube(const V3<T>& x, double rho_a, const geometry::Shape& b, const Placement<T>& at_b) {
  const Meridian<T> m(x, b, at_b);
  const double R = b.half[0], r = b.half[1], H = b.half[2], h = value(m.h), q = value(m.q);
  const double side = h < 0.0 ? -1.0 : 1.0, beyond = std::abs(h) - H;
  const double outside = q - R, inside = r - q;
  const auto end = [&] {
    return over_plane(x, m.point(at_b, b, side * H, 0.0), side * m.axis, rho_a, b.rounding);
  };
  const auto outer = [&] {
    return over_plane(x, m.point(at_b, b, 0.0, R), m.outward, rho_a, b.rounding);
  };
  const auto inner = [&] {
    return over_plane(x, m.point(at_b, b, 0.0, r), -m.outward, rho_a, b.rounding);
  };
  if (beyond > 0.0) {
    if (outside <= 0.0 && inside <= 0.0) return end();
    if (inside > 0.0) return over_inner_rim(x, rho_a, b, at_b, m, side);
    return between_points(x, m.point(at_b, b, side * H, R), rho_a, b.rounding);
  }
  if (outside > 0.0 || (outside >= inside && outside >= beyond)) return outer();
  if (inside > 0.0 || inside >= beyond) return inner();
  return end();
}

template Gap<double> over_tube(const V3<double>&, double, const geometry::Shape&,
                               const Placement<double>&);
template Gap<Dual> over_tube(const V3<Dual>&, double, const geometry::Shape&,
                             const Placement<Dual>&);
template Gap<Fine> over_tube(const V3<Fine>&, double, const geometry::Shape&,
                             const Placement<Fine>&);

}  // namespace polhode::contact
