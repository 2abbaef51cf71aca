// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>

namespace polhode {

/// The side of a time on which derivatives are taken: at a kink they differ.
enum class TimeSide : unsigned char { kBefore, kAfter };

/// Value and derivatives by time at one side of a time.
struct TimeRates {
  double value = 0.0;
  double rate = 0.0;    ///< [1/s]
  double second = 0.0;  ///< [1/s²]
};

/// A number that may depend on time: constant, expression in t, or table. SI units.
class TimeFunction {
 public:
  virtual ~TimeFunction() = default;
  [[nodiscard]] virtual double operator()(double t) const = 0;
  [[nodiscard]] virtual bool is_constant() const { return false; }
  /// Limits from one side of t. Here by differences over 0.2 ms on that side: for functions that
  /// do not know better, with an error of order (0.1 ms)².
  [[nodiscard]] virtual TimeRates rates(double t, TimeSide side) const;
};
using TimeFunctionPtr = std::shared_ptr<const TimeFunction>;

/// Three time functions, one per component.
using TimeVector = std::array<TimeFunctionPtr, 3>;

/// A time on one side of t, nearer than any two times of a model that differ.
[[nodiscard]] double beside(double t, TimeSide side);

/// The jump from before to after, or zero where rounding alone makes them differ.
/// @param before, after    The two limits.
/// @param change           Sum of the magnitudes of their derivatives.
[[nodiscard]] double jump_at(double t, double before, double after, double change);

}  // namespace polhode
