// SPDX-License-Identifier: Apache-2.0
// Sequences with a known error: |f_h − exact| = C hᵖ and exceptions from it.
#include <polhode/study/grid_convergence.hpp>

#include <cmath>
#include <functional>

#include <gtest/gtest.h>

namespace polhode::grid_convergence_tests {
namespace {

constexpr std::array<double, 3> kHalves = {0.1, 0.05, 0.025};

/// A series of vectors of two components given by a function of time and step.
RefinedSeries series(const std::array<double, 3>& h, int samples, double end,
                     const std::function<Eigen::Vector2d(double, double)>& f) {
  RefinedSeries s;
  for (int i = 0; i <= samples; ++i) s.t.push_back(end * i / samples);
  for (std::size_t k = 0; k < 3; ++k) {
    s.values[k].resize(samples + 1, 2);
    for (int i = 0; i <= samples; ++i)
      s.values[k].row(i) = f(s.t[static_cast<std::size_t>(i)], h[k]);
  }
  return s;
}

/// A point on a circle whose angle lags by C hᵖ t.
RefinedSeries circle(const std::array<double, 3>& h, double order, double C = 0.3) {
  return series(h, 400, 20.0, [=](double t, double step) {
    const double angle = t * (1.0 - C * std::pow(step, order));
    return Eigen::Vector2d(std::cos(angle), std::sin(angle));
  });
}

double circle_error(const RefinedSeries& s, const Mat& values, std::size_t i) {
  return (values.row(static_cast<Eigen::Index>(i)) -
          Eigen::RowVector2d(std::cos(s.t[i]), std::sin(s.t[i])))
      .norm();
}

RefinementRule rule_of(const std::array<double, 3>& h, std::vector<double> orders) {
  RefinementRule rule;
  rule.h = h;
  rule.orders = std::move(orders);
  rule.floor = 1e-15;
  rule.negligible = 1e-12;
  return rule;
}

// @tests{certify-order}
TEST(ObservedOrder, IsThatOfAPowerLawAtAnySteps) {
  for (const std::array<double, 3>& h :
       {kHalves, std::array{1.0, 0.1, 0.01}, std::array{1.0, 0.7, 0.6}, std::array{1.0, 0.9, 0.3}})
    for (const double p : {-1.0, 0.3, 1.0, 2.0, 4.0, 6.0, 8.0}) {
      const double coarse = std::abs(std::pow(h[0], p) - std::pow(h[1], p));
      const double fine = std::abs(std::pow(h[1], p) - std::pow(h[2], p));
      EXPECT_NEAR(observed_order(coarse, fine, h), p, 1e-7);
    }
  EXPECT_NEAR(observed_order(1.0, 1.0, kHalves), 0.0, 1e-7);
}

// @tests{certify-bar}
TEST(EstimateError, HasATightBarThatContainsTheError) {
  for (const double order : {1.0, 2.0, 4.0}) {
    const RefinedSeries s = circle(kHalves, order);
    const ConvergenceReport r = estimate_error(s, rule_of(kHalves, {order}));
    ASSERT_TRUE(r.order.has_value());
    EXPECT_NEAR(*r.order, order, 0.08);
    EXPECT_TRUE(r.as_expected);
    EXPECT_FALSE(r.lost_from.has_value());
    double largest = 0.0, own = 0.0;
    for (std::size_t i = 0; i < s.t.size(); ++i) {
      const double error = circle_error(s, s.values[2], i);
      EXPECT_LE(error, r.bar[i]) << "at " << s.t[i];
      // The window adds half its width to the time of an error that grows with time.
      if (s.t[i] > 5.0) {
        EXPECT_LE(r.bar[i], 1.25 * 1.25 * error) << "at " << s.t[i];
      }
      largest = std::max(largest, error);
      own = std::max(own, circle_error(s, s.values[0], i));
    }
    EXPECT_LE(largest, r.largest_bar);
    EXPECT_LE(r.largest_bar, 1.4 * largest);
    EXPECT_LE(own, r.largest_own);
    EXPECT_LE(r.largest_own, 1.3 * own);
  }
}

// @tests{certify-extrapolated}
TEST(EstimateError, ExtrapolatesToAMuchCloserValue) {
  const RefinedSeries s = circle(kHalves, 2.0);
  const ConvergenceReport r = estimate_error(s, rule_of(kHalves, {2.0}));
  for (std::size_t i = 1; i < s.t.size(); ++i)
    EXPECT_LE(circle_error(s, r.extrapolated, i), 0.05 * circle_error(s, s.values[2], i));
}

TEST(EstimateError, IsWiderWhereTheOrderIsNotTheExpectedOne) {
  const RefinedSeries s = circle(kHalves, 1.0, 0.03);
  const ConvergenceReport r = estimate_error(s, rule_of(kHalves, {2.0}));
  ASSERT_TRUE(r.order.has_value());
  EXPECT_NEAR(*r.order, 1.0, 0.05);
  EXPECT_FALSE(r.as_expected);
  for (std::size_t i = 20; i < s.t.size(); ++i) {
    const double error = circle_error(s, s.values[2], i);
    EXPECT_LE(2.5 * error, r.bar[i]);
    EXPECT_LE(r.bar[i], 5.0 * error);
  }
}

TEST(EstimateError, HandlesUnequalRefinements) {
  const std::array<double, 3> h = {0.1, 0.07, 0.052};
  const RefinedSeries s = circle(h, 4.0);
  const ConvergenceReport r = estimate_error(s, rule_of(h, {4.0}));
  EXPECT_NEAR(r.order.value_or(0.0), 4.0, 0.1);
  for (std::size_t i = 0; i < s.t.size(); ++i) EXPECT_LE(circle_error(s, s.values[2], i), r.bar[i]);
}

// Differences that grow as in chaos, each until it is as large as the motion: those of the middle
// and the fine run are at t = ln(1/(C h²))/λ, with h the middle step.
// @tests{certify-lost}
TEST(EstimateError, ReportsWhenConvergenceIsLost) {
  const double rate = 2.0, C = 1e-4;
  const auto chaos = [&](double t, double h) -> Eigen::Vector2d {
    const double size = C * h * h * std::exp(rate * t), share = size / (1.0 + size);
    const double wild = 7.0 * t + 1e3 * h * t;
    return Eigen::Vector2d(std::cos(t), std::sin(t)) +
           2.0 * share * Eigen::Vector2d(std::cos(wild), std::sin(wild));
  };
  const RefinedSeries s = series(kHalves, 1000, 20.0, chaos);
  const ConvergenceReport r = estimate_error(s, rule_of(kHalves, {2.0}));
  const double expected = std::log(1.0 / (C * kHalves[1] * kHalves[1])) / rate;
  ASSERT_TRUE(r.lost_from.has_value());
  EXPECT_NEAR(*r.lost_from, expected, 1.0);
  EXPECT_NEAR(r.order.value_or(0.0), 2.0, 0.1);
  for (std::size_t i = 0; i < s.t.size(); ++i) {
    const double error = (Eigen::Vector2d(s.values[2].row(static_cast<Eigen::Index>(i))) -
                          Eigen::Vector2d(std::cos(s.t[i]), std::sin(s.t[i])))
                             .norm();
    EXPECT_LE(error, r.bar[i] + 1e-14) << "at " << s.t[i];
    EXPECT_EQ(s.t[i] >= *r.lost_from, std::isinf(r.bar[i]));
  }
  EXPECT_TRUE(std::isfinite(r.largest_bar));
}

TEST(EstimateError, AllowsRoundingErrorsThatDoNotDecrease) {
  const RefinedSeries s = series(kHalves, 200, 1.0, [](double t, double h) {
    const double noise = 1e-14 * std::sin(1e5 * t / h);
    return Eigen::Vector2d(1.0 + noise, 2.0);
  });
  const ConvergenceReport r = estimate_error(s, rule_of(kHalves, {2.0}));
  EXPECT_TRUE(r.noise);
  EXPECT_FALSE(r.order.has_value());
  EXPECT_FALSE(r.lost_from.has_value());
  EXPECT_GE(r.largest_bar, 1e-14);
  EXPECT_LE(r.largest_bar, 1e-13);
}

TEST(EstimateError, RejectsRunsWithNearlyEqualSteps) {
  const std::array<double, 3> h = {0.1, 0.099, 0.098};
  const RefinedSeries s = circle({0.1, 0.08, 0.079}, 2.0);
  const ConvergenceReport r = estimate_error(s, rule_of(h, {2.0}));
  ASSERT_TRUE(r.lost_from.has_value());
  EXPECT_EQ(*r.lost_from, 0.0);
}

// A speed that jumps at 3 s + 2 h: certain except near the jump, where the error bar is as large as
// the jump.
TEST(EstimateError, IsOfOrderOneNearAJumpAndPreciseElsewhere) {
  const RefinedSeries s = series(kHalves, 1000, 10.0, [](double t, double h) {
    return Eigen::Vector2d(t < 3.0 + 2.0 * h ? 1.0 : -0.5, 0.0);
  });
  const ConvergenceReport r = estimate_error(s, rule_of(kHalves, {1.0, 2.0}));
  EXPECT_NEAR(r.order.value_or(0.0), 1.0, 0.1);
  EXPECT_FALSE(r.lost_from.has_value());
  for (std::size_t i = 0; i < s.t.size(); ++i) {
    const double exact = s.t[i] < 3.0 ? 1.0 : -0.5;
    EXPECT_LE(std::abs(s.values[2](static_cast<Eigen::Index>(i), 0) - exact), r.bar[i]);
    if (std::abs(s.t[i] - 3.0) > 0.6) {
      EXPECT_LE(r.bar[i], 1e-12);
    }
  }
}

TEST(EstimateError, SkipsValuesThatDoNotExist) {
  RefinedSeries s = circle(kHalves, 2.0);
  for (Mat& values : s.values) values.topRows(100).setConstant(std::nan(""));
  const ConvergenceReport r = estimate_error(s, rule_of(kHalves, {2.0}));
  EXPECT_NEAR(r.order.value_or(0.0), 2.0, 0.1);
  EXPECT_LE(r.bar[10], 1e-14);
  EXPECT_GE(r.bar[300], circle_error(s, s.values[2], 300));
}

TEST(EstimateError, RefusesRunsOfDifferentSizes) {
  RefinedSeries s = circle(kHalves, 2.0);
  s.values[1].conservativeResize(10, 2);
  EXPECT_THROW((void)estimate_error(s, rule_of(kHalves, {2.0})), std::invalid_argument);
  EXPECT_THROW((void)estimate_error(circle(kHalves, 2.0), rule_of(kHalves, {})),
               std::invalid_argument);
}

}  // namespace
}  // namespace polhode::grid_convergence_tests
