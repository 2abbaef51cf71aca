// SPDX-License-Identifier: Apache-2.0
#include <polhode/loads/force_law.hpp>

#include <cmath>

#include <gtest/gtest.h>

namespace polhode::force_law_tests {
namespace {

/// log(end − x).
struct Logarithm final : TimeFunction {
  double end = 0.5;
  double operator()(double x) const override { return std::log(end - x); }
};

}  // namespace

TEST(MeanValue, IsThatOfTheClosedFormUpToASingularEnd) {
  const Logarithm f;
  // The mean of log(0.5 − x) over [0, 0.5] is log(0.5) − 1; an integrable end costs digits.
  EXPECT_NEAR(mean_value(f, 0.0, 0.5), std::log(0.5) - 1.0, 1e-10);
}

TEST(MeanValue, EndsWhereAFunctionHasNoValue) {
  const Logarithm f;
  EXPECT_TRUE(std::isnan(mean_value(f, 0.0, 1.0)));
  EXPECT_TRUE(std::isnan(mean_value(f, 0.4, 0.6)));
}

}  // namespace polhode::force_law_tests
