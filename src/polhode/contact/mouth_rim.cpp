// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>
#include <type_traits>
#include <vector>

#include <polhode/contact/gap_parts.hpp>
#include <polhode/contact/mouth_rim.hpp>
#include <polhode/contact/surface_features.hpp>
#include <polhode/math/sign_change.hpp>

namespace polhode::contact {

namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;

/// Slope at which a place on a rim counts as nearest, as a part of the radius.
constexpr double kEnough = 1e-14;

/// Number of intervals of a rim, or half of it, in which minima of a distance are searched.
constexpr int kIntervals = 32;

/// Gap that the ends of an arc have more than its middle, over the square of half its angle, as a
/// part of the radius: of short arcs, and of half a rim.
constexpr double kToMiddle = 1e-3, kToMiddleOfHalf = 2e-6;

/// Circle of an inner rim, in body coordinates; angle 0 lies at `first`.
struct Rim {
  Vec3 centre, first, across;  ///< `first` and `across` are unit vectors.
  double radius;               ///< [m]

  Rim(const geometry::Shape& tube, bool upper)
      : centre(tube.centre + (upper ? tube.half[2] : -tube.half[2]) * tube.axes.col(2)),
        first(tube.axes.col(0)),
        across(tube.axes.col(1)),
        radius(tube.half[1]) {}
  [[nodiscard]] Vec3 from_centre(double angle) const {
    return radius * (std::cos(angle) * first + std::sin(angle) * across);
  }
  /// Derivative of the place by the angle.
  [[nodiscard]] Vec3 tangent(double angle) const {
    return radius * (std::cos(angle) * across - std::sin(angle) * first);
  }
};

/// A place on the rim in the world; in extended precision it lies on the circle to the last digit.
template <class T>
V3<T> place_on(const Rim& rim, double angle, const Placement<T>& at_tube) {
  if constexpr (std::is_same_v<T, Fine>) {
    const Fine exact = angle;
    return at_tube.point(rim.centre) + (rim.radius * std::cos(exact)) * at_tube.vector(rim.first) +
           (rim.radius * std::sin(exact)) * at_tube.vector(rim.across);
  }
  return at_tube.point(rim.centre + rim.from_centre(angle));
}

/// Derivatives of the angle at which a distance is least: −1 over the curvature times the slope.
/// The distance depends on neither.
template <class T>
T turn(const T& slope, double curvature) {
  return curvature > 0.0 ? (-1.0 / curvature) * (slope - value(slope)) : T(0.0);
}

/// Place on an arc where a distance is least.
struct ArcPlace {
  double angle = 0.0;
  bool free = false;  ///< Between its ends.
};

/// Appends the places on an arc where a distance is least. @param slope  Of the distance, by the
/// angle. @param closed  The arc is a circle.
template <class Slope>
void find_minima(double low, double high, bool closed, int intervals, double enough,
                 const Slope& slope, std::vector<ArcPlace>& places) {
  double before = slope(low);
  if (before >= 0.0 && !closed) places.push_back({low, false});
  for (int k = 1; k <= intervals; ++k) {
    const double from = low + (high - low) * (k - 1) / intervals,
                 to = k == intervals ? high : low + (high - low) * k / intervals;
    const double here = slope(to);
    if (before < 0.0 && here >= 0.0)
      places.push_back({sign_change(slope, from, to, before, here, enough), true});
    before = here;
  }
  if ((before < 0.0 && !closed) || places.empty()) places.push_back({high, false});
}

/// One gap of the places on an arc where a distance is least. @param gap_at  Gap at a place.
template <class T, class GapAt>
Gap<T> over_arc(double reach, const std::vector<ArcPlace>& places, const GapAt& gap_at) {
  if (places.size() == 1) return gap_at(places.front());
  std::vector<Gap<T>> gaps;
  for (const ArcPlace& place : places) gaps.push_back(gap_at(place));
  std::stable_sort(gaps.begin(), gaps.end(), [](const Gap<T>& x, const Gap<T>& y) {
    return value(x.distance) < value(y.distance);
  });
  OneGap<T> sum(reach);
  for (const Gap<T>& g : gaps) sum.add(g, 1);
  return sum.gap();
}

/// Arc of a rim: half of it, where a bar leaves the mouth or enters it, or all of it.
struct Arc {
  Rim rim;
  bool whole;
  double low, high;

  /// @param bar  Unit direction of the bar, in body coordinates of the tube.
  Arc(const geometry::Shape& tube, int number, const Vec3& bar)
      : rim(tube, is_upper_rim(number)), whole(is_whole_rim(number)) {
    const double middle =
        std::atan2(bar.dot(rim.across), bar.dot(rim.first)) + (number % 2 == 0 ? 0.0 : 0.5 * kTurn);
    low = middle - (whole ? 0.5 : 0.25) * kTurn, high = middle + (whole ? 0.5 : 0.25) * kTurn;
  }
};

/// Place on a rim where it is nearest to a solid, with the derivatives of its angle.
/// @param more_curvature  Added to that of the distance. @param turned  Receives the derivatives.
template <class T>
V3<T> nearest_to_solid(const Rim& rim, double angle, const geometry::Shape& solid,
                       const Placement<T>& at_tube, const Placement<T>& at_solid,
                       double more_curvature, T& turned) {
  const V3<T> y = place_on(rim, angle, at_tube);
  turned = T(0.0);
  if constexpr (std::is_same_v<T, Dual>) {
    const auto seen = [&](const Vec3& X) { return at_solid.to_body(value(at_tube.point(X))); };
    const Vec3 centre = seen(rim.centre),
               outward = seen(rim.centre + rim.from_centre(angle)) - centre,
               tangent = seen(rim.centre + rim.tangent(angle)) - centre;
    Dual more(0.0);  // added to the angle
    more.d[11] = 1.0;
    const Mat3 no_turn = Mat3::Identity();
    const Gap<Dual> g =
        point_over_solid(constant<Dual>(Vec3(centre + outward)) + more * constant<Dual>(tangent),
                         0.0, solid, Placement<Dual>(Vec3::Zero(), no_turn, 0));
    const double curvature =
        dot(g.normal, constant<Dual>(tangent) - more * constant<Dual>(outward)).d[11];
    const V3<T> along = at_tube.vector(rim.tangent(angle));
    turned = turn(dot(point_over_solid(y, 0.0, solid, at_solid).normal, along),
                  curvature + more_curvature);
    return y + turned * along;
  }
  return y;
}

/// Distance of a solid from the places of a rim, in the coordinates of the solid's body.
struct SeenRim {
  Vec3 centre, first, across;
  const geometry::Shape& solid;
  Mat3 no_turn = Mat3::Identity();

  template <class T>
  SeenRim(const Rim& rim, const geometry::Shape& s, const Placement<T>& at_tube,
          const Placement<T>& at_solid)
      : solid(s) {
    const auto seen = [&](const Vec3& X) { return at_solid.to_body(value(at_tube.point(X))); };
    centre = seen(rim.centre);
    first = seen(rim.centre + rim.radius * rim.first) - centre;
    across = seen(rim.centre + rim.radius * rim.across) - centre;
  }
  [[nodiscard]] Gap<double> gap(double angle) const {
    const Vec3 x = centre + std::cos(angle) * first + std::sin(angle) * across;
    return point_over_solid(v3(x), 0.0, solid, Placement<double>(Vec3::Zero(), no_turn, 0));
  }
  [[nodiscard]] double slope(double angle) const {
    return value(gap(angle).normal).dot(std::cos(angle) * across - std::sin(angle) * first);
  }
};

}  // namespace

Vec3 out_of_rim(const geometry::Shape& tube, const Vec3& X) {
  const Vec3 axis = tube.axes.col(2), x = X - tube.centre;
  const double height = axis.dot(x);
  return std::copysign(1.0, height) * axis - (x - height * axis).normalized();
}

template <class T>
Gap<T> rim_over_edge(const geometry::Shape& tube, int number, const geometry::Shape& b, int j,
                     const Placement<T>& at_tube, const Placement<T>& at_b) {
  const Vec3 &P = b.corners[b.edges[j].i], &Q = b.corners[b.edges[j].j];
  const V3<T> start = at_b.point(P), along = at_b.between(P, Q);
  const Vec3 from = at_tube.to_body(value(start)),
             v = at_tube.to_body(value(start) + value(along)) - from;
  const double square = v.squaredNorm();
  const Arc arc(tube, number, v / std::sqrt(square));
  const Rim& rim = arc.rim;
  const Vec3 p = from - rim.centre;
  const auto on_line_at = [&](const Vec3& y) { return v.dot(y - p) / square; };
  const auto between = [&](const Vec3& y) {
    return Vec3(y - p - std::clamp(on_line_at(y), 0.0, 1.0) * v);
  };
  const auto slope = [&](double angle) {
    return between(rim.from_centre(angle)).dot(rim.tangent(angle));
  };
  const auto gap_at = [&](const ArcPlace& place) {
    const Vec3 y_0 = rim.from_centre(place.angle), tangent_0 = rim.tangent(place.angle);
    const double t = on_line_at(y_0);
    V3<T> y = place_on(rim, place.angle, at_tube);
    const auto on_edge = [&] {
      if (t <= 0.0) return start;
      if (t >= 1.0) return at_b.point(Q);
      return on_line(y, start, along);
    };
    if constexpr (std::is_same_v<T, Dual>)
      if (place.free) {
        const V3<T> tangent = at_tube.vector(tangent_0);
        const double with_edge = t > 0.0 && t < 1.0 ? tangent_0.dot(v) / std::sqrt(square) : 0.0;
        const double curvature =
            tangent_0.squaredNorm() - with_edge * with_edge - between(y_0).dot(y_0);
        y = y + turn(dot(y - on_edge(), tangent), curvature) * tangent;
      }
    return between_points(y, on_edge(), tube.rounding, b.rounding);
  };
  thread_local std::vector<ArcPlace> places;
  places.clear();
  find_minima(arc.low, arc.high, arc.whole, kIntervals, kEnough * rim.radius * rim.radius, slope,
              places);
  return over_arc<T>(surface_reach(tube, b), places, gap_at);
}

namespace {

/// Gap of an arc and a convex solid. Where all of the arc is as near, its middle is the nearest
/// place.
template <class T>
Gap<T> solid_over_arc(const Rim& rim, double low, double high, int intervals, double to_middle,
                      const geometry::Shape& tube, const geometry::Shape& solid,
                      const Placement<T>& at_tube, const Placement<T>& at_solid) {
  const SeenRim seen(rim, solid, at_tube, at_solid);
  const double middle = 0.5 * (low + high), more = to_middle * rim.radius;
  const auto slope = [&](double angle) {
    return seen.slope(angle) + 2.0 * more * (angle - middle);
  };
  const auto gap_at = [&](const ArcPlace& place) {
    T turned(0.0);
    const V3<T> y = place.free ? nearest_to_solid(rim, place.angle, solid, at_tube, at_solid,
                                                  2.0 * more, turned)
                               : place_on(rim, place.angle, at_tube);
    Gap<T> g = point_over_solid(y, tube.rounding, solid, at_solid);
    const T from_middle = place.angle - middle + turned;
    g.distance = g.distance + more * (from_middle * from_middle);
    return g;
  };
  thread_local std::vector<ArcPlace> places;
  places.clear();
  find_minima(low, high, false, intervals, kEnough * rim.radius, slope, places);
  return over_arc<T>(surface_reach(tube, solid), places, gap_at);
}

}  // namespace

template <class T>
Gap<T> rim_over_bar(const geometry::Shape& tube, int number, const geometry::Shape& bar,
                    const Placement<T>& at_tube, const Placement<T>& at_bar) {
  const Vec3 axis = at_tube.to_body(value(at_bar.point(bar.centre + bar.axes.col(2)))) -
                    at_tube.to_body(value(at_bar.point(bar.centre)));
  const Arc arc(tube, number, axis);
  return solid_over_arc(arc.rim, arc.low, arc.high, kIntervals, kToMiddleOfHalf, tube, bar, at_tube,
                        at_bar);
}

template <class T>
Gap<T> arc_over_solid(const geometry::Shape& tube, int arc, const geometry::Shape& solid,
                      const Placement<T>& at_tube, const Placement<T>& at_solid) {
  const auto from_centre = [&](int corner) {
    return Vec3(tube.axes.transpose() * (tube.corners[corner] - tube.centre));
  };
  const Vec3 p = from_centre(tube.edges[arc].i), q = from_centre(tube.edges[arc].j);
  double low = std::atan2(p.y(), p.x()), high = std::atan2(q.y(), q.x());
  high = low + std::remainder(high - low, kTurn);
  if (high < low) std::swap(low, high);
  return solid_over_arc(Rim(tube, p.z() > 0.0), low, high, 1, kToMiddle, tube, solid, at_tube,
                        at_solid);
}

template Gap<double> rim_over_edge(const geometry::Shape&, int, const geometry::Shape&, int,
                                   const Placement<double>&, const Placement<double>&);
template Gap<Dual> rim_over_edge(const geometry::Shape&, int, const geometry::Shape&, int,
                                 const Placement<Dual>&, const Placement<Dual>&);
template Gap<Fine> rim_over_edge(const geometry::Shape&, int, const geometry::Shape&, int,
                                 const Placement<Fine>&, const Placement<Fine>&);
template Gap<double> rim_over_bar(const geometry::Shape&, int, const geometry::Shape&,
                                  const Placement<double>&, const Placement<double>&);
template Gap<Dual> rim_over_bar(const geometry::Shape&, int, const geometry::Shape&,
                                const Placement<Dual>&, const Placement<Dual>&);
template Gap<Fine> rim_over_bar(const geometry::Shape&, int, const geometry::Shape&,
                                const Placement<Fine>&, const Placement<Fine>&);
template Gap<double> arc_over_solid(const geometry::Shape&, int, const geometry::Shape&,
                                    const Placement<double>&, const Placement<double>&);
template Gap<Dual> arc_over_solid(const geometry::Shape&, int, const geometry::Shape&,
                                  const Placement<Dual>&, const Placement<Dual>&);
template Gap<Fine> arc_over_solid(const geometry::Shape&, int, const geometry::Shape&,
                                  const Placement<Fine>&, const Placement<Fine>&);

}  // namespace polhode::contact
