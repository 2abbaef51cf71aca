// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <limits>
#include <memory>

namespace polhode {

/// The side of a time on which derivatives are taken: at a kink they differ.
enum class TimeSide : unsigned char { kBefore, kAfter };

/// Value and derivatives by time at one side of a time.
struct TimeRates {
  double value = 0.0;
  double rate = 0.0;    ///< [1/s]
  double second = 0.0;  ///< [1/s²]

  /// Value and derivatives at a time later by dt, from the Taylor polynomial.
  [[nodiscard]] TimeRates moved(double dt) const {
    return {value + dt * rate, rate + dt * second, second};
  }
};

/// A time at which a function is not smooth.
struct TimeBreak {
  double t = std::numeric_limits<double>::infinity();  ///< [s]; infinite: there is none.
  int derivative = 0;  ///< The lowest one that jumps there: 0 the value itself, 1 the slope, ...

  [[nodiscard]] bool exists() const { return t < std::numeric_limits<double>::infinity(); }
};

/// Relative difference of times below which two breaks are one [-].
inline constexpr double kSameBreak = 0x1p-46;

/// Bounds of a function over a span of time, in its unit.
struct TimeBounds {
  double size = 0.0;       ///< Of |f|.
  double curvature = 0.0;  ///< Of |f''|, without breaks [1/s²].
};

/// A number that may depend on time: constant, expression in t, or table. SI units.
class TimeFunction {
 public:
  virtual ~TimeFunction() = default;
  [[nodiscard]] virtual double operator()(double t) const = 0;
  [[nodiscard]] virtual bool is_constant() const { return false; }
  /// Number of the controller that sets it during a run; -1: none does.
  [[nodiscard]] virtual int controller() const { return -1; }
  /// Value and derivatives as limits from one side of t. By default differences over 0.2 ms on that
  /// side, with an error of order (0.1 ms)².
  [[nodiscard]] virtual TimeRates rates(double t, TimeSide side) const;
  /// First break after t, up to `until`. The breaks depend on neither t nor `until`, so that a
  /// continued run has the same ones.
  [[nodiscard]] virtual TimeBreak next_break(double /*t*/, double /*until*/) const { return {}; }
  /// Bounds over [from, to]; by default from samples, which miss changes shorter than a 64th.
  [[nodiscard]] virtual TimeBounds bounds(double from, double to) const;
};
using TimeFunctionPtr = std::shared_ptr<const TimeFunction>;

/// Three time functions, one per component.
using TimeVector = std::array<TimeFunctionPtr, 3>;

/// A time on one side of t, nearer than any two different times of a model.
[[nodiscard]] double beside(double t, TimeSide side);

/// Jump from before to after, or zero if the difference is rounding.
/// @param before, after  The two limits.
/// @param change  Sum of the magnitudes of their derivatives.
[[nodiscard]] double jump_at(double t, double before, double after, double change);

}  // namespace polhode
