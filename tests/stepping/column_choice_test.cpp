// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include <polhode/stepping/column_choice.hpp>

namespace polhode::column_choice_tests {
namespace {

constexpr int kMost = 6;

/// Errors of a motion with the rate ω: column j has (ωH)^(2j−1) / (2j−1)!.
double error(int column, double H, double omega) {
  const int power = std::max(3, 2 * column - 1);
  return std::exp(power * std::log(omega * H) - std::lgamma(power + 1.0));
}

/// Single steps per unit of time of a column at the length with the allowed error.
double work(int column, double allowed, double omega) {
  const int power = std::max(3, 2 * column - 1);
  const double H = std::exp((std::log(allowed) + std::lgamma(power + 1.0)) / power) / omega;
  return column * (column + 1) / H;
}

// @tests{column-work}
TEST(ColumnChoice, SettlesAtTheLeastWork) {
  for (const double allowed : {1e-3, 1e-5, 1e-7, 1e-9, 1e-11})
    for (const double omega : {1e-3, 1.0, 1e3}) {
      double least = std::numeric_limits<double>::infinity();
      for (int j = kLeastColumns; j <= kMost; ++j) least = std::min(least, work(j, allowed, omega));
      for (int first = kLeastColumns; first <= kMost; ++first) {
        ColumnPlan plan{first, 1.0};
        double H = 1e-2 / omega;
        for (int i = 0; i < 60; ++i) {
          const ColumnErrors errors{plan.columns, error(plan.columns, H, omega),
                                    error(plan.columns - 1, H, omega)};
          plan = plan_columns(errors, allowed, kLeastColumns,
                              errors.last <= allowed ? kMost : plan.columns);
          H *= plan.factor;
        }
        EXPECT_LT(work(plan.columns, allowed, omega), 1.3 * least)
            << allowed << ", from " << first << " members to " << plan.columns;
        // The length is that of the members chosen, with the safety factor.
        EXPECT_LE(error(plan.columns, H, omega), allowed);
        EXPECT_GE(error(plan.columns, H, omega), 0.001 * allowed);
      }
    }
}

TEST(ColumnChoice, KeepsToTheMembersAllowed) {
  for (int k = 2; k <= kMost; ++k)
    for (const double last : {0.0, 1e-12, 1e-6, 1.0})
      EXPECT_EQ(plan_columns({k, last, 10.0 * last}, 1e-8, k, k).columns, k);
  // A refused step is shorter.
  EXPECT_LT(plan_columns({3, 1e-6, 1e-4}, 1e-8, 3, 3).factor, 0.5);
}

TEST(ColumnChoice, BeginsWithMoreMembersForASmallerTolerance) {
  EXPECT_EQ(first_columns(1e-2, kMost), kLeastColumns);
  EXPECT_EQ(first_columns(1e-6, kMost), 3);
  EXPECT_EQ(first_columns(1e-10, kMost), 5);
  EXPECT_EQ(first_columns(1e-15, kMost), kMost);
  EXPECT_EQ(first_columns(1e-10, 2), 2);
}

}  // namespace
}  // namespace polhode::column_choice_tests
