// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include <polhode/equations/line_search.hpp>

namespace polhode::line_search_tests {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Parts tried and the result of a search on a merit that is 1 at the start.
struct Search {
  std::vector<double> tried;
  bool accepted = false;
};

template <class Merit>
Search search(const LineSearchRule& rule, Merit&& merit, double part = 1.0) {
  Search s;
  s.accepted = search_along(
      rule, 1.0, part,
      [&](double tried) {
        s.tried.push_back(tried);
        return 1.0;
      },
      [&] { return merit(s.tried.back()); });
  return s;
}

// J. E. Dennis and R. B. Schnabel, Numerical Methods for Unconstrained Optimization and Nonlinear
// Equations (1983), example 2.4.3: Newton's method for arctan(x) = 0 diverges for |x| > 1.3917.
TEST(LineSearch, MakesNewtonsMethodConvergeWhereItDiverges) {
  for (const double start : {1.0, 1.39, 1.4, 3.0, 20.0}) {
    double x = start, whole = start;
    for (int it = 0; it < 30 && std::abs(x) > 1e-12; ++it) {
      const double from = x, step = -std::atan(x) * (1.0 + x * x);
      const auto merit = [&] { return std::pow(std::atan(x), 2); };
      EXPECT_TRUE(search_along(
          kReduceMerit, merit(), 1.0,
          [&](double part) {
            x = from + part * step;
            return std::abs(step);
          },
          merit));
      EXPECT_LE(std::abs(std::atan(x)), std::abs(std::atan(from)));
      if (std::abs(whole) < 1e6) whole -= std::atan(whole) * (1.0 + whole * whole);
    }
    EXPECT_LT(std::abs(x), 1e-12) << start;
    EXPECT_EQ(std::abs(whole) < 1e-6, start < 1.3917) << start;
  }
}

// The merit of Newton's increment has the slope −2 at its start, which with two values determines
// the parabola.
TEST(LineSearch, GoesToTheMinimumOfTheParabola) {
  LineSearchRule rule = kReduceMerit;
  rule.searches_for_kink = false;
  for (const double best : {0.12, 0.25, 0.45}) {
    const auto parabola = [&](double p) { return 1.0 - 2.0 * p + p * p / best; };
    const Search s = search(rule, parabola);
    EXPECT_TRUE(s.accepted);
    ASSERT_EQ(s.tried.size(), 2U);
    EXPECT_NEAR(s.tried[1], best, 1e-15);
  }
}

// A barrier that begins at a small part of the increment.
TEST(LineSearch, LengthensAStepFarBelowARejectedOneIfTheRuleAllows) {
  for (const double kink : {0.9, 0.3, 0.11}) {
    const auto merit = [&](double p) { return p <= kink ? std::pow(1.0 - p, 2) : 1e6; };
    const Search s = search(kReduceMerit, merit);
    EXPECT_TRUE(s.accepted);
    EXPECT_LE(s.tried.back(), kink);
    EXPECT_GT(s.tried.back(), kink / 3.0);
    LineSearchRule without = kReduceMerit;
    without.searches_for_kink = false;
    EXPECT_EQ(search(without, merit).tried.back(), 0.1);
  }
}

TEST(LineSearch, HalvesUntilAdmissibleOrReportsFailure) {
  const Search s =
      search(kUntilAdmissible, [](double p) { return p < 0.3 ? kAdmissible : kInadmissible; });
  EXPECT_TRUE(s.accepted);
  EXPECT_EQ(s.tried, (std::vector<double>{1.0, 0.5, 0.25}));
  int evaluations = 0;
  const Search none =
      search(kUntilAdmissible, [&](double) { return ++evaluations, kInadmissible; });
  EXPECT_FALSE(none.accepted);
  EXPECT_EQ(evaluations, kUntilAdmissible.max_trials);
  EXPECT_FALSE(search(kReduceMerit, [](double) { return std::nan(""); }).accepted);
  EXPECT_TRUE(search(kReduceMerit, [](double p) { return p < 0.5 ? 0.5 : kInfinity; }).accepted);
}

TEST(LineSearch, StartsFromTheAdmissibleStepAndStopsAtRoundOff) {
  EXPECT_EQ(search(
                kReduceMerit, [](double) { return 0.1; }, 0.7)
                .tried,
            std::vector<double>{0.7});
  EXPECT_EQ(search(kReduceMerit, [](double) { return -1.0; }).tried, std::vector<double>{1.0});
  // Below a small increment the merit is not evaluated.
  const auto never = [] { return ADD_FAILURE(), 0.0; };
  EXPECT_TRUE(search_along(
      kReduceMerit, 1.0, 1.0, [](double) { return 1e-7; }, never));
}

}  // namespace
}  // namespace polhode::line_search_tests
