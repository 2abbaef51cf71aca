// SPDX-License-Identifier: Apache-2.0
// Lengths of steps before limits and breaks.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include <polhode/stepping/step_lengths.hpp>

namespace polhode::step_control {
namespace {

TEST(StepLengths, DivideAShortRestIntoEqualParts) {
  EXPECT_EQ(part_of(1.0, 0.1), 0.1);
  EXPECT_EQ(part_of(0.15, 0.1), 0.075);
  EXPECT_EQ(part_of(0.2, 0.1), 0.1);
  EXPECT_EQ(part_of(0.04, 0.1), 0.04);
  // Up to a thousandth more is one step, so that no tiny one follows.
  EXPECT_EQ(part_of(0.10005, 0.1), 0.10005);
  EXPECT_EQ(part_of(0.1002, 0.1), 0.0501);
}

TEST(StepLengths, OfAnEqualRestAreEqualToTheLastBit) {
  const double end = 0.1 + 0.2;  // 0.30000000000000004
  EXPECT_EQ(part_of(end - 0.2, 0.1), 0.1);
  EXPECT_EQ(part_of(0.1 * (1.0 + 1e-12), 0.1), 0.1);
}

TEST(StepLengths, SumUpToTheWayWithoutATinyStep) {
  for (const double dt : {0.1, 0.01, 1e-3})
    for (double way = 0.3 * dt; way < 4.0 * dt; way *= 1.01) {
      double t = 0.0, least = dt;
      int steps = 0;
      while (way - t > 1e-12 * way) {
        const double step = part_of(way - t, dt);
        ASSERT_GT(step, 0.0);
        least = std::min(least, step);
        t += step;
        ASSERT_LT(++steps, 10) << way << ' ' << dt;
      }
      EXPECT_NEAR(t, way, 1e-9 * way);
      EXPECT_GE(least, std::min(way, 0.49 * dt) * (1.0 - 1e-9)) << way << ' ' << dt;
    }
}

TEST(StepLengths, OfFixedStepsEndOnTheirGrid) {
  const double H = 0.1;
  double t = 0.0;
  for (int k = 1; k <= 1000; ++k) {
    const double start = t;
    t = on_grid(t + H, H, start);
    EXPECT_EQ(t, std::round(k) * H) << k;  // no sum of roundings
  }
  EXPECT_EQ(on_grid(0.149, H, 0.1), 0.149);
  // A step that is shorter than the distance to the grid does not go back to it.
  EXPECT_EQ(on_grid(0.375 + 1e-12, 0.125, 0.375), 0.375 + 1e-12);
}

// @tests{shortest-step}
TEST(StepLengths, AreNotShorterThanRoundOffResolves) {
  const double eps = std::numeric_limits<double>::epsilon();
  for (const double H : {0.1, 1e-3, 1e-5}) {
    // The error of velocities by the round-off of positions, and that by not moving, are equal.
    const double t = 1e5 * H, shortest = shortest_step(t, H);
    EXPECT_NEAR(eps * (t + kFarAway * H) / shortest, shortest / H, 1e-12);
    EXPECT_GT(shortest_step(100.0 * t, H), shortest);
    EXPECT_EQ(shortest_step(-t, H), shortest);
    EXPECT_LT(shortest_step(0.0, H), 1e-5 * H);
  }
}

}  // namespace
}  // namespace polhode::step_control
