// SPDX-License-Identifier: Apache-2.0
// Breaks (jumps and kinks) of functions of time, and bounds of values and second derivatives.
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <polhode/io/read/time_function.hpp>
#include <polhode/io/text/expression.hpp>

namespace polhode::time_breaks_tests {
namespace {

std::shared_ptr<const io::Expression> expression(const std::string& text) {
  io::ExpressionFault fault;
  auto e = io::Expression::parse(text, {}, io::UnitSystem{}, true, fault);
  EXPECT_TRUE(e) << text << ": " << fault.what;
  return e;
}

template <class Function>
std::vector<TimeBreak> breaks(const Function& f, double until) {
  std::vector<TimeBreak> list;
  for (TimeBreak b = f.next_break(0.0, until); b.exists(); b = f.next_break(b.t, until)) {
    list.push_back(b);
    if (list.size() > 1000) break;
  }
  return list;
}

void expect_breaks(const std::string& text, double until, const std::vector<double>& times,
                   int derivative) {
  const auto found = breaks(*expression(text), until);
  ASSERT_EQ(found.size(), times.size()) << text;
  for (std::size_t k = 0; k < times.size(); ++k) {
    EXPECT_NEAR(found[k].t, times[k], 1e-13 * times[k]) << text;
    EXPECT_EQ(found[k].derivative, derivative) << text;
  }
}

TEST(ExpressionBreaks, AreThoseOfConditions) {
  expect_breaks("t > 0.7 ? 1 : 0", 2.0, {0.7}, 0);
  expect_breaks("t >= 5.3 && t < 5.5 ? 2 : 0", 10.0, {5.3, 5.5}, 0);
  expect_breaks("t < 1 || t > 3 ? 0 : t", 10.0, {1.0, 3.0}, 0);
  expect_breaks("(t > 1) - (t > 1.5) + 0*t", 10.0, {1.0, 1.5}, 0);
  expect_breaks("t > 1 ? t - 1 : 0", 10.0, {1.0}, 1);
  expect_breaks("!(t < 2) ? 1 : 3", 10.0, {2.0}, 0);
}

TEST(ExpressionBreaks, AreThoseOfFunctionsWithBranches) {
  expect_breaks("abs(t - 0.3)", 1.0, {0.3}, 1);
  expect_breaks("sign(t - 0.3)", 1.0, {0.3}, 0);
  expect_breaks("floor(10*t)", 0.45, {0.1, 0.2, 0.3, 0.4}, 0);
  expect_breaks("t/0.25 - floor(t/0.25)", 0.6, {0.25, 0.5}, 0);
  expect_breaks("min(t, 2)", 10.0, {2.0}, 1);
  expect_breaks("max(0, min(1, t - 2))", 10.0, {2.0, 3.0}, 1);
  expect_breaks("sin(2*pi*t) > 0 ? 1 : -1", 1.9, {0.5, 1.0, 1.5}, 0);
  expect_breaks("atan2(sin(t), cos(t))", 4.0, {std::numbers::pi}, 0);
  expect_breaks("mod(t, 0.25)", 0.6, {0.25, 0.5}, 0);
  expect_breaks("step(t, 0.7)", 2.0, {0.7}, 0);
  expect_breaks("pulse(t, 5.3, 5.5)", 10.0, {5.3, 5.5}, 0);
  expect_breaks("pulse(mod(t, 2), 0, 1)", 3.9, {1.0, 2.0, 3.0}, 0);
  expect_breaks("ramp(t, 2, 3)", 10.0, {2.0, 3.0}, 1);
  expect_breaks("smoothstep(t, 2, 3)", 10.0, {2.0, 3.0}, 1);
  expect_breaks("max(0, sin(t))^2", 7.0, {std::numbers::pi, 2.0 * std::numbers::pi}, 1);
}

TEST(ExpressionBreaks, IncludeVeryShortPulses) {
  for (const double length : {1e-1, 1e-3, 1e-6, 1e-9}) {
    const std::string text =
        "t > 612.3 && t < 612.3 + " + std::to_string(length * 1e10) + "e-10 ? 1 : 0";
    expect_breaks(text, 1000.0, {612.3, 612.3 + length}, 0);
  }
}

TEST(ExpressionBreaks, AreAbsentWhereNoBranchChanges) {
  for (const char* text : {"sin(100*t)", "t^2 - 3*t", "abs(t^2 + 1)", "abs((t - 1)^2)", "max(t, t)",
                           "min(t^2 - 2*t + 1.5, 0)", "exp(-((t - 5)/0.01)^2)", "t > -1 ? 1 : 0"})
    EXPECT_FALSE(expression(text)->next_break(0.0, 10.0).exists()) << text;
}

/// A continued run starts its search at another time and must find bitwise the same breaks.
TEST(ExpressionBreaks, DoNotDependOnTheStartOfTheSearch) {
  const auto f = expression("sin(17*t) > 0.3 ? 1 : t");
  for (const TimeBreak& b : breaks(*f, 20.0))
    for (const double before : {1e-3, 0.01, 0.0371})
      EXPECT_EQ(f->next_break(b.t - before, 20.0).t, b.t);
}

TEST(ExpressionBounds, HoldForValueAndSecondDerivative) {
  const std::vector<std::string> texts = {"3*sin(7*t) + t^2",
                                          "exp(-t)*cos(5*t)",
                                          "1/(1 + t^2)",
                                          "sqrt(1 + t)",
                                          "log(1 + t) - log10(2 + t)",
                                          "tanh(3*t - 2)",
                                          "atan(4*t)",
                                          "asin(t/9) + acos(t/7)",
                                          "sinh(t) - cosh(t/2)",
                                          "tan(t/10)",
                                          "(1 + t)^1.5",
                                          "2^t",
                                          "abs(t - 2)*t^3",
                                          "min(t^2, 4*t)",
                                          "atan2(t + 1, 2*t + 3)",
                                          "mod(t, 5)*t",
                                          "ramp(t, -1, 4)^2",
                                          "smoothstep(t, -1, 4)",
                                          "(2 + t)^sin(t)"};
  for (const std::string& text : texts) {
    const auto f = expression(text);
    for (double from = 0.0; from < 3.0; from += 0.31) {
      const double to = from + 0.2, h = 1e-3;
      const TimeBounds b = f->bounds(from, to);
      ASSERT_TRUE(std::isfinite(b.size) && std::isfinite(b.curvature)) << text << " at " << from;
      double size = 0.0, curvature = 0.0;
      for (double t = from + 2.0 * h; t < to - 2.0 * h; t += h) {
        size = std::max(size, std::abs((*f)(t)));
        if (f->next_break(t - 1.5 * h, t + 1.5 * h).exists()) continue;
        curvature =
            std::max(curvature, std::abs((*f)(t + h) - 2.0 * (*f)(t) + (*f)(t - h)) / (h * h));
      }
      EXPECT_GE(b.size, size) << text << " at " << from;
      EXPECT_GE(b.curvature, curvature - 1e-6) << text << " at " << from;
      EXPECT_LE(b.size, 2.0 * size + 2.0) << text << " at " << from;
      EXPECT_LE(b.curvature, 4.0 * curvature + 10.0) << text << " at " << from;
    }
  }
}

TEST(ExpressionBounds, OfConstantPartsAreExact) {
  EXPECT_EQ(expression("floor(5*2)*t + 0^0")->next_break(0.0, 10.0).exists(), false);
  const TimeBounds b = expression("2*3*sin(t)")->bounds(0.0, 100.0);
  EXPECT_NEAR(b.size, 6.0, 1e-12);
  EXPECT_NEAR(b.curvature, 6.0, 1e-12);
}

TEST(TableBreaks, AreThePoints) {
  const std::vector<double> t = {1.0, 2.0, 4.0}, v = {0.0, 1.0, 0.0};
  const auto of = [&](io::Interpolation way, bool periodic, double until) {
    std::vector<double> times, derivatives;
    for (const TimeBreak& b : breaks(io::TableFunction(t, v, way, periodic), until)) {
      times.push_back(b.t);
      derivatives.push_back(b.derivative);
    }
    return std::pair(times, derivatives);
  };
  using List = std::vector<double>;
  EXPECT_EQ(of(io::Interpolation::kStep, false, 9.0), std::pair(List{1, 2, 4}, List{0, 0, 0}));
  EXPECT_EQ(of(io::Interpolation::kLinear, false, 3.0), std::pair(List{1, 2}, List{1, 1}));
  EXPECT_EQ(of(io::Interpolation::kCubic, false, 9.0), std::pair(List{1, 2, 4}, List{1, 3, 1}));
  EXPECT_EQ(of(io::Interpolation::kCubic, true, 9.0),
            std::pair(List{1, 2, 4, 5, 7, 8}, List{3, 3, 3, 3, 3, 3}));
}

TEST(TableBounds, HoldBetweenThePointsAndInLaterPeriods) {
  const std::vector<double> t = {0.0, 1.0, 1.5, 3.0}, v = {1.0, -2.0, 3.0, 1.0};
  for (const bool periodic : {false, true}) {
    const io::TableFunction f(t, v, io::Interpolation::kCubic, periodic);
    for (double from = 0.0; from < 8.0; from += 0.17)
      for (const double length : {0.1, 0.7, 4.0}) {
        const TimeBounds b = f.bounds(from, from + length);
        for (double x = from; x < from + length; x += 0.01) {
          EXPECT_LE(std::abs(f(x)), b.size + 1e-12);
          const double h = 1e-4;
          if (f.next_break(x - 2.0 * h, x + 2.0 * h).exists()) continue;
          EXPECT_LE(std::abs(f(x + h) - 2.0 * f(x) + f(x - h)) / (h * h), b.curvature + 1e-5);
        }
      }
  }
}

}  // namespace
}  // namespace polhode::time_breaks_tests
