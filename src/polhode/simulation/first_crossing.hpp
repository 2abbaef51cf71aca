// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

namespace polhode {

/// Search of the first zero crossing, from below, of several functions over a step: regula falsi
/// with the Illinois modification for each function by itself, at the earliest of their estimates,
/// and bisection where these do not shorten the interval. @eq{event-time}
class FirstCrossing {
 public:
  /// @param at_start, at_end  Values at both ends; NaN: not to be watched.
  /// @param length  Of the step [s]. @param same  Difference of times that does not matter [s].
  FirstCrossing(std::span<const double> at_start, std::span<const double> at_end, double length,
                double same);

  /// Whether the crossing is found: at far_side().
  [[nodiscard]] bool found() const;
  /// The next trial, between both sides [s].
  [[nodiscard]] double next() const;
  /// Adds a trial. @returns whether it is the new far side.
  bool add(double length, std::span<const double> values);
  /// Shortest length found with a value that is not negative [s].
  [[nodiscard]] double far_side() const { return high_; }
  /// Functions that have crossed zero on the far side.
  [[nodiscard]] std::vector<int> crossed() const;

 private:
  struct Function {
    double at_start, at_end;  ///< Of the step.
    double low, high;         ///< On the two sides, with the weights of the Illinois rule.
    double beyond;            ///< On the far side.
    int side = 0;             ///< That of the last trial.
    [[nodiscard]] bool crosses() const { return beyond >= 0.0; }
  };
  std::vector<Function> functions_;
  double low_ = 0.0, high_, same_;
  double width_;    ///< Of the interval, when it was last halved.
  int trials_ = 0;  ///< Since then.
  int all_trials_ = 0;
};

}  // namespace polhode
