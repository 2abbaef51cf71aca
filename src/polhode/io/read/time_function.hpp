// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <polhode/io/text/expression.hpp>
#include <polhode/model/model.hpp>

namespace polhode::io {

/// A constant function of time.
class ConstantFunction final : public TimeFunction {
 public:
  explicit ConstantFunction(double value) : value_(value) {}
  [[nodiscard]] double operator()(double) const override { return value_; }
  [[nodiscard]] bool is_constant() const override { return true; }
  [[nodiscard]] TimeRates rates(double, TimeSide) const override { return {value_, 0.0, 0.0}; }
  [[nodiscard]] TimeBounds bounds(double, double) const override;

 private:
  double value_;
};

/// An expression in t, times a factor to SI.
class ExpressionFunction final : public TimeFunction {
 public:
  ExpressionFunction(std::shared_ptr<const Expression> expression, double factor)
      : expression_(std::move(expression)), factor_(factor) {}
  [[nodiscard]] double operator()(double t) const override { return factor_ * (*expression_)(t); }
  [[nodiscard]] TimeRates rates(double t, TimeSide side) const override {
    const TimeRates r = expression_->rates(t, side);
    return {factor_ * r.value, factor_ * r.rate, factor_ * r.second};
  }
  [[nodiscard]] TimeBreak next_break(double t, double until) const override {
    return expression_->next_break(t, until);
  }
  [[nodiscard]] TimeBounds bounds(double from, double to) const override;

 private:
  std::shared_ptr<const Expression> expression_;
  double factor_;
};

/// Interpolation between the points of a table.
enum class Interpolation : unsigned char {
  kLinear,  ///< Straight lines.
  kCubic,   ///< Natural cubic spline, or a periodic one.
  kStep,    ///< Constant from each point to the next.
};

/// Values at given times; before the first and after the last one constant, or periodic.
class TableFunction final : public TimeFunction {
 public:
  /// @param times   At least two, strictly increasing [s].
  /// @param values  As many; if periodic and not kStep, the last equals the first.
  TableFunction(std::vector<double> times, std::vector<double> values, Interpolation interpolation,
                bool periodic);
  [[nodiscard]] double operator()(double t) const override;
  [[nodiscard]] TimeRates rates(double t, TimeSide side) const override;

  /// Next break of the table: the value jumps at points of kStep, the slope at those of kLinear,
  /// the third derivative at those of kCubic.
  [[nodiscard]] TimeBreak next_break(double t, double until) const override;
  [[nodiscard]] TimeBounds bounds(double from, double to) const override;

 private:
  /// Number of the last point at or before a time in the table, −1 if there is none.
  [[nodiscard]] int interval(double t) const;
  /// Time in the table equivalent to t: for a periodic table within its first period.
  [[nodiscard]] double in_table(double t) const;

  std::vector<double> times_, values_;
  std::vector<double> curvatures_;  ///< Second derivatives at the points, of kCubic.
  Interpolation interpolation_;
  bool periodic_;
};

}  // namespace polhode::io
