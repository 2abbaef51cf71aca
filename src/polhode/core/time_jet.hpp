// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

namespace polhode {

/// A value with its first two derivatives by time (automatic differentiation, forward mode).
/// Comparisons use the value.
struct TimeJet {
  double value = 0.0, rate = 0.0, second = 0.0;

  TimeJet() = default;
  TimeJet(double constant) : value(constant) {}  // NOLINT: numbers are jets
  TimeJet(double v, double d, double dd) : value(v), rate(d), second(dd) {}

  friend TimeJet operator+(const TimeJet& x, const TimeJet& y) {
    return {x.value + y.value, x.rate + y.rate, x.second + y.second};
  }
  friend TimeJet operator-(const TimeJet& x, const TimeJet& y) {
    return {x.value - y.value, x.rate - y.rate, x.second - y.second};
  }
  friend TimeJet operator-(const TimeJet& x) { return {-x.value, -x.rate, -x.second}; }
  friend TimeJet operator*(const TimeJet& x, const TimeJet& y) {
    return {x.value * y.value, x.rate * y.value + x.value * y.rate,
            x.second * y.value + 2.0 * x.rate * y.rate + x.value * y.second};
  }
  friend TimeJet operator/(const TimeJet& x, const TimeJet& y) {
    const double ratio = x.value / y.value, its_rate = (x.rate - ratio * y.rate) / y.value;
    return {ratio, its_rate, (x.second - 2.0 * its_rate * y.rate - ratio * y.second) / y.value};
  }
  friend bool operator<(const TimeJet& x, const TimeJet& y) { return x.value < y.value; }
  friend bool operator<=(const TimeJet& x, const TimeJet& y) { return x.value <= y.value; }
  friend bool operator>(const TimeJet& x, const TimeJet& y) { return x.value > y.value; }
  friend bool operator>=(const TimeJet& x, const TimeJet& y) { return x.value >= y.value; }
  friend bool operator==(const TimeJet& x, const TimeJet& y) { return x.value == y.value; }
  friend bool operator!=(const TimeJet& x, const TimeJet& y) { return x.value != y.value; }

  /// The chain rule: f with its derivatives by x at x.value.
  [[nodiscard]] TimeJet through(double f, double df, double ddf) const {
    const auto times = [](double a, double b) { return b == 0.0 ? 0.0 : a * b; };
    return {f, times(df, rate), times(ddf, rate * rate) + times(df, second)};
  }
};

inline TimeJet sin(const TimeJet& x) {
  return x.through(std::sin(x.value), std::cos(x.value), -std::sin(x.value));
}
inline TimeJet cos(const TimeJet& x) {
  return x.through(std::cos(x.value), -std::sin(x.value), -std::cos(x.value));
}
inline TimeJet tan(const TimeJet& x) {
  const double f = std::tan(x.value), df = 1.0 + f * f;
  return x.through(f, df, 2.0 * f * df);
}
inline TimeJet asin(const TimeJet& x) {
  const double c = std::sqrt(1.0 - x.value * x.value);
  return x.through(std::asin(x.value), 1.0 / c, x.value / (c * c * c));
}
inline TimeJet acos(const TimeJet& x) {
  const double c = std::sqrt(1.0 - x.value * x.value);
  return x.through(std::acos(x.value), -1.0 / c, -x.value / (c * c * c));
}
inline TimeJet atan(const TimeJet& x) {
  const double df = 1.0 / (1.0 + x.value * x.value);
  return x.through(std::atan(x.value), df, -2.0 * x.value * df * df);
}
inline TimeJet atan2(const TimeJet& y, const TimeJet& x) {
  const double r2 = x.value * x.value + y.value * y.value;
  const double area = x.value * y.rate - y.value * x.rate;
  const double area_rate = x.value * y.second - y.value * x.second;
  const double r2_rate = 2.0 * (x.value * x.rate + y.value * y.rate);
  const double rate = area / r2;
  return {std::atan2(y.value, x.value), rate, (area_rate - rate * r2_rate) / r2};
}
inline TimeJet sinh(const TimeJet& x) {
  return x.through(std::sinh(x.value), std::cosh(x.value), std::sinh(x.value));
}
inline TimeJet cosh(const TimeJet& x) {
  return x.through(std::cosh(x.value), std::sinh(x.value), std::cosh(x.value));
}
inline TimeJet tanh(const TimeJet& x) {
  const double f = std::tanh(x.value), df = 1.0 - f * f;
  return x.through(f, df, -2.0 * f * df);
}
inline TimeJet exp(const TimeJet& x) {
  const double f = std::exp(x.value);
  return x.through(f, f, f);
}
inline TimeJet log(const TimeJet& x) {
  return x.through(std::log(x.value), 1.0 / x.value, -1.0 / (x.value * x.value));
}
inline TimeJet log10(const TimeJet& x) {
  const TimeJet natural = log(x) / TimeJet(std::log(10.0));
  return {std::log10(x.value), natural.rate, natural.second};
}
inline TimeJet sqrt(const TimeJet& x) {
  const double f = std::sqrt(x.value);
  return x.through(f, 0.5 / f, -0.25 / (f * x.value));
}
inline TimeJet abs(const TimeJet& x) { return x.value < 0.0 ? -x : x; }
inline TimeJet floor(const TimeJet& x) { return {std::floor(x.value)}; }
inline TimeJet pow(const TimeJet& x, const TimeJet& y) {
  const double f = std::pow(x.value, y.value);
  if (y.rate == 0.0 && y.second == 0.0) {
    const double n = y.value;
    return x.through(f, n == 0.0 ? 0.0 : n * std::pow(x.value, n - 1.0),
                     n * (n - 1.0) == 0.0 ? 0.0 : n * (n - 1.0) * std::pow(x.value, n - 2.0));
  }
  const TimeJet power = exp(y * log(x));
  return {f, power.rate, power.second};
}

}  // namespace polhode
