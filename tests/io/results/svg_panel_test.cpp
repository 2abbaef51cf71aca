// SPDX-License-Identifier: Apache-2.0
#include <polhode/io/results/svg_panel.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace polhode::svg_panel_tests {
namespace {

using testing::DoubleNear;
using testing::Pointwise;

void expect_ticks(double low, double high, const std::vector<double>& wanted) {
  EXPECT_THAT(io::round_ticks(low, high, 4), Pointwise(DoubleNear(1e-12 * (high - low)), wanted));
}

TEST(RoundTicks, AreRoundAndShowTheScale) {
  expect_ticks(0.0, 1.0, {0.0, 0.5, 1.0});
  expect_ticks(-0.1, 4.1, {0.0, 2.0, 4.0});
  expect_ticks(-4.6e-4, 4.6e-4, {-4e-4, -2e-4, 0.0, 2e-4, 4e-4});  // 0 alone would say nothing
  expect_ticks(-0.005, 0.086, {0.0, 0.02, 0.04, 0.06, 0.08});
}

TEST(RoundTicks, AreAtLeastThreeInAnyRange) {
  for (double size = 1e-9; size < 1e9; size *= 1.07)
    for (const double part : {-1.0, -0.5, 0.0, 0.37, 12.3}) {
      const std::vector<double> ticks = io::round_ticks(part * size, (part + 1.0) * size, 4);
      EXPECT_GE(ticks.size(), 3U) << size << " " << part;
      EXPECT_LE(ticks.size(), 7U) << size << " " << part;
    }
}

}  // namespace
}  // namespace polhode::svg_panel_tests
