// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include <polhode/io/read/time_function.hpp>

namespace polhode::time_function_tests {
namespace {

const std::vector<double> kTimes = {0.0, 1.0, 3.0, 4.0};
const std::vector<double> kValues = {1.0, 2.0, -2.0, 1.0};

TEST(TableFunction, PassesThroughItsPoints) {
  for (const auto way :
       {io::Interpolation::kLinear, io::Interpolation::kCubic, io::Interpolation::kStep}) {
    const io::TableFunction f(kTimes, kValues, way, false);
    for (std::size_t k = 0; k < kTimes.size(); ++k) EXPECT_NEAR(f(kTimes[k]), kValues[k], 1e-15);
  }
}

TEST(TableFunction, HoldsTheEndValues) {
  const io::TableFunction f(kTimes, {5.0, 2.0, -2.0, 7.0}, io::Interpolation::kCubic, false);
  EXPECT_EQ(f(-10.0), 5.0);
  EXPECT_EQ(f(10.0), 7.0);
}

TEST(TableFunction, InterpolatesLinearlyOrInSteps) {
  EXPECT_EQ(io::TableFunction(kTimes, kValues, io::Interpolation::kLinear, false)(2.0), 0.0);
  EXPECT_EQ(io::TableFunction(kTimes, kValues, io::Interpolation::kStep, false)(2.9), 2.0);
}

TEST(TableFunction, RepeatsWhenPeriodic) {
  for (const auto way :
       {io::Interpolation::kLinear, io::Interpolation::kCubic, io::Interpolation::kStep}) {
    const io::TableFunction f(kTimes, kValues, way, true);
    for (const double t : {0.0, 0.3, 1.7, 3.9})
      for (const double period : {-8.0, -4.0, 4.0, 400.0}) EXPECT_NEAR(f(t + period), f(t), 1e-12);
  }
}

TEST(TableFunction, CubicReproducesStraightLines) {
  const io::TableFunction f({0.0, 0.5, 2.0, 2.5}, {1.0, 2.0, 5.0, 6.0}, io::Interpolation::kCubic,
                            false);
  for (const double t : {0.1, 0.7, 1.9, 2.3}) EXPECT_NEAR(f(t), 1.0 + 2.0 * t, 1e-14);
}

/// The spline through n points of a smooth periodic function errs by h⁴: 16 times less for half h.
TEST(TableFunction, PeriodicCubicIsOfFourthOrder) {
  const auto error = [](int n) {
    std::vector<double> t, v;
    for (int k = 0; k <= n; ++k) {
      t.push_back(2.0 * std::numbers::pi * k / n);
      v.push_back(std::sin(t.back()));
    }
    v.back() = v.front();
    const io::TableFunction f(t, v, io::Interpolation::kCubic, true);
    double largest = 0.0;
    for (double x = -3.0; x < 10.0; x += 0.01)
      largest = std::max(largest, std::abs(f(x) - std::sin(x)));
    return largest;
  };
  EXPECT_NEAR(std::log2(error(20) / error(40)), 4.0, 0.1);
}

TEST(TableFunction, PeriodicCubicTakesOneOrTwoIntervals) {
  EXPECT_EQ(io::TableFunction({0.0, 1.0}, {3.0, 3.0}, io::Interpolation::kCubic, true)(0.4), 3.0);
  // Through (0, 1), (1, -1), (2, 1): symmetric about t = 1, zero half way by symmetry of the
  // curvatures.
  const io::TableFunction f({0.0, 1.0, 2.0}, {1.0, -1.0, 1.0}, io::Interpolation::kCubic, true);
  EXPECT_NEAR(f(0.5), 0.0, 1e-15);
  EXPECT_NEAR(f(0.3), f(1.7), 1e-15);
}

}  // namespace
}  // namespace polhode::time_function_tests
