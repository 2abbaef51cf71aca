// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <polhode/loads/load_description.hpp>
#include <polhode/loads/planar_curve.hpp>

namespace polhode {

namespace {

constexpr int kSamples = 720;  ///< Of the whole curve, for sizes and initial feet.
constexpr int kMaxSteps = 60;
/// Longest step of the search along the curve, as a part of it.
constexpr double kLongestStep = 0.02;

}  // namespace

PlanarCurve::PlanarCurve(TimeFunctionPtr x, TimeFunctionPtr y, double length, bool ends,
                         double side)
    : x_(std::move(x)), y_(std::move(y)), length_(length), ends_(ends), side_(side) {
  Vec2 least = at(0.0).X, most = least;
  samples_ = {least};
  for (int i = 1; i <= kSamples; ++i) {
    samples_.push_back(at(length_ * i / kSamples).X);
    least = least.cwiseMin(samples_.back());
    most = most.cwiseMax(samples_.back());
  }
  size_ = (most - least).norm();
}

PlanarCurve::Point PlanarCurve::at(double s) const {
  const double inside = ends_ ? std::clamp(s, 0.0, length_) : s;
  const TimeSide side = inside > 0.5 * length_ ? TimeSide::kBefore : TimeSide::kAfter;
  const TimeRates x = x_->rates(inside, side), y = y_->rates(inside, side);
  Point p{{x.value, y.value}, {x.rate, y.rate}, {x.second, y.second}};
  if (inside != s) {
    p.X += (s - inside) * p.slope;
    p.second.setZero();
  }
  return p;
}

PlanarCurve::Distance PlanarCurve::distance(const Vec2& P, double near) const {
  double s = near;
  Point p = at(s);
  for (int i = 0; i < kMaxSteps; ++i) {
    const Vec2 d = P - p.X;
    const double first = -p.slope.dot(d), square = p.slope.squaredNorm();
    const double second = square - p.second.dot(d);
    // Where the point is beyond the centre of curvature: descent with the step of a straight line.
    const double step = -first / (second > 0.1 * square ? second : square);
    const double longest = kLongestStep * length_;
    s += std::clamp(step, -longest, longest);
    p = at(s);
    if (std::abs(step) < 1e-15 * length_) break;
  }
  Distance d;
  d.foot = s;
  const double speed = p.slope.norm();
  d.tangent = p.slope / speed;
  d.normal = side_ * Vec2(d.tangent.y(), -d.tangent.x());
  d.value = d.normal.dot(P - p.X);
  const double kappa =
      side_ * (p.slope.x() * p.second.y() - p.slope.y() * p.second.x()) / (speed * speed * speed);
  d.room = 1.0 + kappa * d.value;
  d.curvature = kappa / d.room;
  return d;
}

double PlanarCurve::nearest(const Vec2& P) const {
  double best = 0.0, least = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= kSamples; ++i) {
    const double d = (samples_[static_cast<std::size_t>(i)] - P).squaredNorm();
    if (d < least) {
      least = d;
      best = length_ * i / kSamples;
    }
  }
  return distance(P, best).foot;
}

PlanarCurve planar_curve(const LoadDescription& load, const std::string& prefix, double side) {
  const TimeFunctionPtr x = load.law(prefix + "curve_x"), y = load.law(prefix + "curve_y");
  if (!x || !y) return {};
  return {x, y, load.value(prefix + "period", 2.0 * std::numbers::pi),
          load.value(prefix + "open", 0.0) != 0.0, side};
}

}  // namespace polhode
