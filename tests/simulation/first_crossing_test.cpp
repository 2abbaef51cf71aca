// SPDX-License-Identifier: Apache-2.0
// The first of several zero crossings over a step, each by its own margin.
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include <polhode/simulation/first_crossing.hpp>

namespace polhode::first_crossing_tests {
namespace {

using Functions = std::vector<std::function<double(double)>>;

struct Found {
  double at;
  int trials;
  std::vector<int> crossed;
};

Found search(const Functions& functions, double length) {
  const auto values = [&](double t) {
    std::vector<double> list;
    for (const auto& f : functions) list.push_back(f(t));
    return list;
  };
  FirstCrossing first(values(0.0), values(length), length, 1e-13 * length);
  Found found{length, 0, {}};
  while (!first.found()) {
    const double t = first.next();
    EXPECT_GT(t, 0.0);
    EXPECT_LT(t, length);
    (void)first.add(t, values(t));
    ++found.trials;
  }
  found.at = first.far_side();
  found.crossed = first.crossed();
  return found;
}

TEST(FirstCrossing, IsThatOfASmoothFunction) {
  const Found found = search({[](double t) { return t * t - 0.3; }}, 1.0);
  EXPECT_NEAR(found.at, std::sqrt(0.3), 2e-13);
  EXPECT_GE(found.at, std::sqrt(0.3) - 1e-15);
  EXPECT_LE(found.trials, 12);
}

// A function that is nearly met all the time has no part in it, whatever its unit.
TEST(FirstCrossing, IsNotDelayedByAFunctionThatIsNearlyMet) {
  for (const double level : {1.0, 1e-6, 1e-12}) {
    const Found found =
        search({[=](double) { return -level; }, [](double t) { return t - 0.7; }}, 1.0);
    EXPECT_NEAR(found.at, 0.7, 2e-13) << level;
    EXPECT_EQ(found.crossed, std::vector<int>{1});
    EXPECT_LE(found.trials, 4);
  }
}

TEST(FirstCrossing, IsTheEarliestOfSeveral) {
  const Functions functions = {[](double t) { return 1e6 * (t - 0.9); },
                               [](double t) { return 1e-9 * (t * t * t - 0.2); },
                               [](double t) { return std::expm1(5.0 * (t - 0.6)); }};
  const Found found = search(functions, 1.0);
  EXPECT_NEAR(found.at, std::cbrt(0.2), 1e-12);
  EXPECT_EQ(found.crossed, std::vector<int>{1});
  EXPECT_LE(found.trials, 30);
}

// Jumps and margins without a value are bisected: 44 halvings to 1e-13, each after three trials at
// most.
TEST(FirstCrossing, IsLocatedWhereAFunctionJumps) {
  constexpr double kUnknown = -std::numeric_limits<double>::infinity();
  for (const double before : {-1.0, -1e-9, kUnknown}) {
    const Found found = search({[=](double t) { return t < 0.123 ? before : 5.0; }}, 1.0);
    EXPECT_NEAR(found.at, 0.123, 2e-13) << before;
    EXPECT_LE(found.trials, 4 * 44);
  }
}

TEST(FirstCrossing, LeavesOutWhatIsNotWatched) {
  const double none = std::numeric_limits<double>::quiet_NaN();
  const Found found =
      search({[=](double) { return none; }, [](double t) { return t - 0.25; }}, 1.0);
  EXPECT_NEAR(found.at, 0.25, 2e-13);
  EXPECT_EQ(found.crossed, std::vector<int>{1});
}

}  // namespace
}  // namespace polhode::first_crossing_tests
