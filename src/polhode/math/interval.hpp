// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace polhode {

/// Interval of all numbers from lo to hi. Results are widened by some units in the last place, so
/// that they contain the exact ones.
struct Interval {
  double lo = 0.0, hi = 0.0;

  Interval() = default;
  constexpr Interval(double value) : lo(value), hi(value) {}  // NOLINT: numbers are intervals
  constexpr Interval(double low, double high) : lo(low), hi(high) {}

  [[nodiscard]] static constexpr Interval all() {
    return {-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  }
  [[nodiscard]] bool is_number() const { return lo == hi; }
  [[nodiscard]] bool finite() const { return std::isfinite(lo) && std::isfinite(hi); }
  [[nodiscard]] bool contains(double x) const { return lo <= x && x <= hi; }
  [[nodiscard]] double middle() const { return is_number() ? lo : 0.5 * (lo + hi); }
  /// Largest magnitude.
  [[nodiscard]] double size() const { return std::max(std::abs(lo), std::abs(hi)); }
};

/// Result of an operation, widened; everything if it is NaN.
[[nodiscard]] inline Interval widened(double lo, double hi) {
  constexpr double kUlps = 0x1p-50;
  if (std::isnan(lo) || std::isnan(hi)) return Interval::all();
  return {lo - kUlps * std::abs(lo), hi + kUlps * std::abs(hi)};
}

[[nodiscard]] inline Interval hull(const Interval& x, const Interval& y) {
  return {std::min(x.lo, y.lo), std::max(x.hi, y.hi)};
}
[[nodiscard]] inline Interval operator-(const Interval& x) { return {-x.hi, -x.lo}; }
[[nodiscard]] inline Interval operator+(const Interval& x, const Interval& y) {
  return widened(x.lo + y.lo, x.hi + y.hi);
}
[[nodiscard]] inline Interval operator-(const Interval& x, const Interval& y) { return x + (-y); }
[[nodiscard]] inline Interval operator*(const Interval& x, const Interval& y) {
  const auto times = [](double a, double b) { return a == 0.0 || b == 0.0 ? 0.0 : a * b; };
  const double a = times(x.lo, y.lo), b = times(x.lo, y.hi), c = times(x.hi, y.lo),
               d = times(x.hi, y.hi);
  return widened(std::min({a, b, c, d}), std::max({a, b, c, d}));
}
[[nodiscard]] inline Interval reciprocal(const Interval& x) {
  if (x.contains(0.0)) return Interval::all();
  return widened(1.0 / x.hi, 1.0 / x.lo);
}
/// |x|; tighter than the hull of x and −x.
[[nodiscard]] inline Interval magnitude(const Interval& x) {
  return {x.contains(0.0) ? 0.0 : std::min(std::abs(x.lo), std::abs(x.hi)), x.size()};
}

/// Image under an increasing function.
template <class Function>
[[nodiscard]] Interval growing(const Function& f, const Interval& x) {
  return widened(f(x.lo), f(x.hi));
}

[[nodiscard]] inline Interval sine(const Interval& x) {
  constexpr double kTurn = 2.0 * std::numbers::pi, kQuarter = 0.5 * std::numbers::pi;
  if (!x.finite() || x.hi - x.lo >= kTurn) return {-1.0, 1.0};
  // Maxima at a quarter of a turn, minima at three quarters.
  const auto meets = [&](double place) {
    const double k = std::ceil((x.lo - place) / kTurn - 1e-9);
    return place + k * kTurn <= x.hi + 1e-9;
  };
  const double a = std::sin(x.lo), b = std::sin(x.hi);
  const Interval ends = widened(std::min(a, b), std::max(a, b));
  return {meets(-kQuarter) ? -1.0 : std::max(ends.lo, -1.0),
          meets(kQuarter) ? 1.0 : std::min(ends.hi, 1.0)};
}
[[nodiscard]] inline Interval cosine(const Interval& x) {
  return sine(x + Interval(0.5 * std::numbers::pi));
}
/// x to a constant power; everything where it is undefined.
[[nodiscard]] inline Interval power(const Interval& x, double n) {
  if (n == 0.0) return 1.0;
  if (n < 0.0) return reciprocal(power(x, -n));
  const double lo = std::pow(x.lo, n), hi = std::pow(x.hi, n);
  if (n == std::floor(n)) {
    const bool even = std::fmod(n, 2.0) == 0.0;
    if (even && x.contains(0.0)) return {0.0, widened(0.0, std::max(lo, hi)).hi};
    return widened(std::min(lo, hi), std::max(lo, hi));
  }
  return x.lo >= 0.0 ? widened(lo, hi) : Interval::all();
}

}  // namespace polhode
