// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include <polhode/core/time_function.hpp>

namespace polhode {

/// A sum of three functions with constant factors, as of a vector in other axes.
class TimeSum final : public TimeFunction {
 public:
  TimeSum(TimeVector parts, std::array<double, 3> factors)
      : parts_(std::move(parts)), factors_(factors) {}

  [[nodiscard]] double operator()(double t) const override {
    double sum = 0.0;
    each([&](const TimeFunction& f, double c) { sum += c * f(t); });
    return sum;
  }
  [[nodiscard]] bool is_constant() const override {
    bool constant = true;
    each([&](const TimeFunction& f, double) { constant = constant && f.is_constant(); });
    return constant;
  }
  [[nodiscard]] TimeRates rates(double t, TimeSide side) const override {
    TimeRates sum;
    each([&](const TimeFunction& f, double c) {
      const TimeRates r = f.rates(t, side);
      sum = {sum.value + c * r.value, sum.rate + c * r.rate, sum.second + c * r.second};
    });
    return sum;
  }
  [[nodiscard]] TimeBreak next_break(double t, double until) const override {
    TimeBreak first;
    each([&](const TimeFunction& f, double) {
      const TimeBreak next = f.next_break(t, until);
      if (next.exists() && next.t == first.t)
        first.derivative = std::min(first.derivative, next.derivative);
      else if (next.t < first.t)
        first = next;
    });
    return first;
  }
  [[nodiscard]] TimeBounds bounds(double from, double to) const override {
    TimeBounds sum;
    each([&](const TimeFunction& f, double c) {
      const TimeBounds b = f.bounds(from, to);
      sum = {sum.size + std::abs(c) * b.size, sum.curvature + std::abs(c) * b.curvature};
    });
    return sum;
  }

 private:
  template <class Visit>
  void each(const Visit& visit) const {
    for (std::size_t k = 0; k < 3; ++k)
      if (parts_[k] && factors_[k] != 0.0) visit(*parts_[k], factors_[k]);
  }

  TimeVector parts_;
  std::array<double, 3> factors_;
};

/// c f, or f itself where c is 1, or nothing where f is nothing.
[[nodiscard]] inline TimeFunctionPtr scaled(const TimeFunctionPtr& f, double c) {
  if (!f || c == 1.0) return f;
  return std::make_shared<TimeSum>(TimeVector{f, nullptr, nullptr}, std::array{c, 0.0, 0.0});
}

}  // namespace polhode
