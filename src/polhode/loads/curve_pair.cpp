// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include <polhode/loads/curve_pair.hpp>

namespace polhode {

namespace {

using Vec2 = PlanarCurve::Vec2;

constexpr int kMaxPlaces = 60;
/// Longest step of the search along the second curve, as a part of it.
constexpr double kLongestPlaceStep = 0.02;
/// Step, as a part of the curve, after which the search has converged, by its quadratic order.
constexpr double kLastPlaceStep = 1e-9;
/// Relative curvature, in units of that of curves of their size, below which the curves are
/// conforming.
constexpr double kFits = 1e-3;
/// Largest displacement of a contact point in a step, as a part of the curve: a shorter step makes
/// it shorter, unless the contact point jumps.
constexpr double kLongestWay = 0.1;
/// Number of positions tested between two contact points, if these are farther apart than this part
/// of the curve, and decrease of the distance in between that is rounding, as a part of the curves'
/// size.
constexpr int kBetween = 16;
constexpr double kNearPlaces = 1e-4, kRoundedDistance = 1e-12;

/// X rotated by a quarter of a turn.
Vec2 quarter(const Vec2& X) { return {-X.y(), X.x()}; }

}  // namespace

CurvePair::Distance CurvePair::distance(const Vec4& q, const Places& near) const {
  const auto turned = [&](const Vec2& X) -> Vec2 { return q[2] * X + q[3] * quarter(X); };
  const double longest = kLongestPlaceStep * b_.length(), last = kLastPlaceStep * b_.length();
  double u = near.b, s = near.a, bend = 0.0, along = 0.0, least = 0.0;
  PlanarCurve::Point p;
  PlanarCurve::Distance d;
  for (int i = 0;; ++i) {
    p = b_.at(u);
    d = a_.distance(q.head<2>() + turned(p.X), s);
    s = d.foot;
    const Vec2 slope = turned(p.slope);
    along = d.tangent.dot(slope);
    bend = d.normal.dot(turned(p.second)) + d.curvature * along * along;
    // For conforming curves: descent with the step of curves of their size.
    const double pace = p.slope.squaredNorm() / size();
    least = kFits * pace;
    const double step = -d.normal.dot(slope) / (bend > least ? bend : pace);
    if (std::abs(step) < 1e-15 * b_.length() || i == kMaxPlaces) break;
    u += std::clamp(step, -longest, longest);
    if (std::abs(step) < last) i = kMaxPlaces - 1;  // once more, for the values there
  }
  Eigen::Matrix<double, 2, 4> by_q;
  by_q << Eigen::Matrix2d::Identity(), p.X, quarter(p.X);
  Vec4 by_u = d.curvature * along * (by_q.transpose() * d.tangent);
  by_u[2] += d.normal.dot(p.slope);
  by_u[3] += d.normal.dot(quarter(p.slope));
  const Vec4 across = by_q.transpose() * d.tangent;
  Distance result;
  result.value = d.value;
  result.at = {s, u};
  result.gradient = by_q.transpose() * d.normal;
  result.hessian = d.curvature * across * across.transpose() -
                   (1.0 / std::max(bend, least)) * by_u * by_u.transpose();
  result.normal = d.normal;
  result.tangent = d.tangent;
  result.own = p.X;
  result.touches = bend > least && d.room > 0.0;
  return result;
}

bool CurvePair::leads_to(const Vec4& q, const Places& from, const Places& to) const {
  const double way = to.b - from.b;
  if (std::abs(way) < kNearPlaces * b_.length()) return true;
  if (std::abs(way) > kLongestWay * b_.length()) return false;
  double foot = from.a, highest = -std::numeric_limits<double>::infinity();
  for (int i = 0; i <= kBetween; ++i) {
    const Vec2 X = b_.at(from.b + way * i / kBetween).X;
    const auto d = a_.distance(q.head<2>() + q[2] * X + q[3] * quarter(X), foot);
    if (d.value < highest - kRoundedDistance * size()) return false;
    highest = std::max(highest, d.value);
    foot = d.foot;
  }
  return true;
}

CurvePair::Places CurvePair::first(const Vec4& q) const {
  const int count = static_cast<int>(b_.samples().size()) - 1;
  // Every fourth sample: the search between them converges to the smallest distance on either side.
  constexpr int kStride = 4;
  std::vector<Places> places;
  std::vector<double> heights;
  for (int i = 0; i <= count; i += kStride) {
    const Vec2& X = b_.samples()[static_cast<std::size_t>(i)];
    const Vec2 P = q.head<2>() + q[2] * X + q[3] * quarter(X);
    places.push_back({a_.nearest(P), b_.length() * i / count});
    heights.push_back(a_.distance(P, places.back().a).value);
  }
  Places best = places.front();
  double closest = std::numeric_limits<double>::infinity();
  const std::size_t n = heights.size();
  for (std::size_t i = 0; i < n; ++i) {
    if ((i > 0 && heights[i - 1] < heights[i]) || (i + 1 < n && heights[i + 1] < heights[i]))
      continue;
    const Distance d = distance(q, places[i]);
    if (!d.touches || !contains(d.at) || std::abs(d.value) >= closest) continue;
    closest = std::abs(d.value);
    best = d.at;
  }
  return best;
}

}  // namespace polhode
