// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include <polhode/core/time_function.hpp>

namespace polhode {

/// Numbers that a program sets between steps. They are constant during each step.
struct HeldNumbers {
  std::vector<double> now;   ///< For the next step.
  std::vector<double> used;  ///< Those of the last step.
};

/// TimeFunction::controller() of numbers that a program sets instead of a controller.
inline constexpr int kHeldByProgram = -2;

/// One of these numbers as a function of time.
class HeldValue final : public TimeFunction {
 public:
  /// @param offset  Added to the number.
  HeldValue(std::shared_ptr<HeldNumbers> numbers, std::size_t index, double offset = 0.0)
      : numbers_(std::move(numbers)), index_(index), offset_(offset) {}

  [[nodiscard]] const std::shared_ptr<HeldNumbers>& numbers() const { return numbers_; }
  [[nodiscard]] int controller() const override { return kHeldByProgram; }
  [[nodiscard]] std::size_t index() const { return index_; }
  [[nodiscard]] double offset() const { return offset_; }
  [[nodiscard]] double operator()(double /*t*/) const override {
    return numbers_->now[index_] + offset_;
  }
  [[nodiscard]] TimeRates rates(double t, TimeSide /*side*/) const override {
    return {(*this)(t), 0.0, 0.0};
  }
  [[nodiscard]] TimeBounds bounds(double from, double /*to*/) const override {
    const double value = (*this)(from);
    return {value < 0.0 ? -value : value, 0.0};
  }

 private:
  std::shared_ptr<HeldNumbers> numbers_;
  std::size_t index_;
  double offset_;
};

/// A function of time as a held value; null if it is none.
[[nodiscard]] inline const HeldValue* held_value(const TimeFunctionPtr& f) {
  return f && f->controller() == kHeldByProgram ? static_cast<const HeldValue*>(f.get()) : nullptr;
}

}  // namespace polhode
