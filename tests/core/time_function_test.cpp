// SPDX-License-Identifier: Apache-2.0
// What functions of time have by default: derivatives at either side, bounds, and the size of a
// jump.
#include <polhode/core/time_function.hpp>

#include <cmath>

#include <gtest/gtest.h>

namespace polhode::time_function_tests {
namespace {

/// A function in code, with nothing but its value.
template <class F>
class Coded final : public TimeFunction {
 public:
  explicit Coded(F f) : f_(f) {}
  double operator()(double t) const override { return f_(t); }

 private:
  F f_;
};

TEST(TimeFunction, HasDerivativesByDifferences) {
  const Coded f([](double t) { return std::sin(3.0 * t) + t * t; });
  for (const double t : {0.0, 0.7, 5.0})
    for (const TimeSide side : {TimeSide::kBefore, TimeSide::kAfter}) {
      const TimeRates r = f.rates(t, side);
      EXPECT_NEAR(r.value, std::sin(3.0 * t) + t * t, 1e-11);
      EXPECT_NEAR(r.rate, 3.0 * std::cos(3.0 * t) + 2.0 * t, 1e-6);
      EXPECT_NEAR(r.second, 2.0 - 9.0 * std::sin(3.0 * t), 1e-2);
    }
}

// At a kink each side has its own slope, and at a jump its own value.
TEST(TimeFunction, TakesTheLimitOfTheSideAskedFor) {
  const Coded kink([](double t) { return t < 2.0 ? 0.0 : 5.0 * (t - 2.0); });
  EXPECT_NEAR(kink.rates(2.0, TimeSide::kBefore).rate, 0.0, 1e-9);
  EXPECT_NEAR(kink.rates(2.0, TimeSide::kAfter).rate, 5.0, 1e-7);
  const Coded jump([](double t) { return t < 2.0 ? 1.0 : -3.0; });
  EXPECT_EQ(jump.rates(2.0, TimeSide::kBefore).value, 1.0);
  EXPECT_EQ(jump.rates(2.0, TimeSide::kAfter).value, -3.0);
}

TEST(TimeRates, MoveAlongTheirParabola) {
  const TimeRates r = TimeRates{1.0, -2.0, 6.0}.moved(0.5);
  EXPECT_EQ(r.value, 0.0);
  EXPECT_EQ(r.rate, 1.0);
  EXPECT_EQ(r.second, 6.0);
}

TEST(TimeFunction, HasBoundsBySamples) {
  const Coded f([](double t) { return 2.0 * std::sin(4.0 * t) - 1.0; });
  const TimeBounds b = f.bounds(0.0, 3.0);
  EXPECT_NEAR(b.size, 3.0, 0.01);
  EXPECT_NEAR(b.curvature, 32.0, 0.5);
  // No span: the value, and nothing about its change.
  const TimeBounds at = f.bounds(1.0, 1.0);
  EXPECT_EQ(at.size, std::abs(2.0 * std::sin(4.0) - 1.0));
  EXPECT_EQ(at.curvature, 0.0);
}

TEST(TimeFunction, HasNoBreakUnlessItSaysSo) {
  const Coded f([](double t) { return t < 2.0 ? 1.0 : -3.0; });
  EXPECT_FALSE(f.next_break(0.0, 10.0).exists());
  EXPECT_FALSE(f.is_constant());
  EXPECT_EQ(f.controller(), -1);
}

// Times beside an instant are nearer than two different times of a model, and are different.
TEST(TimeSide, IsBesideAnInstant) {
  for (const double t : {0.0, 1e-3, 1.0, 86400.0}) {
    EXPECT_LT(beside(t, TimeSide::kBefore), t);
    EXPECT_GT(beside(t, TimeSide::kAfter), t);
    EXPECT_NEAR(beside(t, TimeSide::kAfter), t, 1e-13 * std::max(t, 1e-6));
  }
}

TEST(Jump, IsZeroWithinRounding) {
  EXPECT_EQ(jump_at(1.0, 5.0, 7.0, 0.0), 2.0);
  EXPECT_EQ(jump_at(1.0, 5.0, 5.0 + 1e-10, 0.0), 0.0);
  EXPECT_NE(jump_at(1.0, 5.0, 5.0 + 1e-8, 0.0), 0.0);
  // A steep function changes between the two sides without a jump.
  EXPECT_NE(jump_at(1e4, 0.0, 1e-8, 0.0), 0.0);
  EXPECT_EQ(jump_at(1e4, 0.0, 1e-8, 1e4), 0.0);
}

}  // namespace
}  // namespace polhode::time_function_tests
