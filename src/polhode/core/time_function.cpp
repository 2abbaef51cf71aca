// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <polhode/core/time_function.hpp>

namespace polhode {

namespace {

/// Relative difference of values below which they are equal.
constexpr double kSame = 1e-10;

double shift(double t) { return 2.0 * kSameBreak * std::max(std::abs(t), 1e-6); }

}  // namespace

double beside(double t, TimeSide side) {
  return side == TimeSide::kAfter ? t + shift(t) : t - shift(t);
}

double jump_at(double t, double before, double after, double change) {
  const double jump = after - before;
  const double noise =
      kSame * (std::abs(before) + std::abs(after)) + 4.0 * shift(t) * std::abs(change);
  return std::abs(jump) <= noise ? 0.0 : jump;
}

TimeRates TimeFunction::rates(double t, TimeSide side) const {
  const double h = side == TimeSide::kAfter ? 1e-4 : -1e-4;
  const double at = beside(t, side);
  const double f0 = (*this)(at), f1 = (*this)(at + h), f2 = (*this)(at + 2.0 * h);
  if (is_constant()) return {f0, 0.0, 0.0};
  return {f0, (4.0 * f1 - 3.0 * f0 - f2) / (2.0 * h), (f0 - 2.0 * f1 + f2) / (h * h)};
}

TimeBounds TimeFunction::bounds(double from, double to) const {
  constexpr int kParts = 64;
  const double h = (to - from) / kParts;
  TimeBounds bounds;
  double before = 0.0, last = 0.0;
  for (int k = 0; k <= kParts; ++k) {
    const double now = (*this)(from + h * k);
    bounds.size = std::max(bounds.size, std::abs(now));
    if (k > 1 && h > 0.0)
      bounds.curvature = std::max(bounds.curvature, std::abs(now - 2.0 * last + before) / (h * h));
    before = last;
    last = now;
  }
  return bounds;
}

}  // namespace polhode
