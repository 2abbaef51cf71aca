// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include <polhode/core/time_function.hpp>

#include "motion_call.hpp"

namespace polhode::python {

/// A Python callable of the time that gives one number or three; it is called once for each time.
/// It is borrowed, see CompiledModel.
class TimeCall {
 public:
  TimeCall(nb::handle function, std::size_t size) : function_(function), values_(size, 0.0) {}

  /// @throws nb::python_error if the function raises.
  double value(double t, std::size_t component) {
    if (t != time_) {
      const nb::gil_scoped_acquire locked;
      const nb::object result = function_(t);
      if (values_.size() == 1) {
        values_[0] = number_of(result);
      } else {
        const Vec3 v = three_numbers_of(result);
        values_.assign(v.begin(), v.end());
      }
      time_ = t;
    }
    return values_[component];
  }

 private:
  nb::handle function_;
  std::vector<double> values_;
  double time_ = std::numeric_limits<double>::quiet_NaN();
};

/// A component of a TimeCall as a function of time; derivatives are taken by differences.
class CalledFunction final : public TimeFunction {
 public:
  CalledFunction(std::shared_ptr<TimeCall> call, std::size_t component)
      : call_(std::move(call)), component_(component) {}
  [[nodiscard]] double operator()(double t) const override { return call_->value(t, component_); }

 private:
  std::shared_ptr<TimeCall> call_;
  std::size_t component_;
};

}  // namespace polhode::python
