// SPDX-License-Identifier: Apache-2.0
#include <array>

#include <gtest/gtest.h>

#include <polhode/core/assert.hpp>
#include <polhode/equations/newton_system.hpp>
#include <polhode/linear/mumps.hpp>
#include <polhode/system/system.hpp>

namespace polhode::assert_tests {
namespace {

System one_body() {
  System system;
  system.add_body({.name = "b", .mass = 1.0, .inertia = Mat3::Identity()}, {});
  return system;
}

TEST(Assert, AbortsWithTextFileAndLine) {
  POLHODE_ASSERT(2 > 1);
  EXPECT_DEATH(POLHODE_ASSERT(1 > 2), "assert_test.cpp:[0-9]+: assertion failed: 1 > 2");
}

TEST(Assert, KeepsASystemUnchangedAfterFinish) {
  System system = one_body();
  system.finish();
  EXPECT_DEATH(system.add_body({}, {}), "assertion failed: !finished_");
  EXPECT_DEATH(system.add_node({}), "assertion failed");
  EXPECT_DEATH(system.finish(), "assertion failed: !finished_");
}

TEST(Assert, WantsInteractionsInOrder) {
  System system = one_body();
  system.finish();
  EXPECT_DEATH(InteractionSweep(system, {1, 0}), "assertion failed: is_strictly_ascending");
}

TEST(Assert, WantsAFactorBeforeASolution) {
  linear::Mumps mumps(linear::Mumps::Symmetry::symmetric);
  mumps.analyse(1, {0}, {0});
  double x = 2.0;
  EXPECT_DEATH(mumps.solve(&x, 1), "assertion failed: factored");
  const double four = 4.0;
  ASSERT_TRUE(mumps.factor(&four));
  mumps.solve(&x, 1);
  EXPECT_EQ(x, 0.5);
}

TEST(Assert, IsOnlyEvaluatedOnRequest) {
  int evaluated = 0;
  evaluates_assertions = false;
  POLHODE_ASSERT(++evaluated < 0);
  evaluates_assertions = true;
  EXPECT_EQ(evaluated, 0);
}

TEST(Assert, NeedsElementsThatGrow) {
  EXPECT_TRUE(is_strictly_ascending(std::array<int, 0>{}));
  EXPECT_TRUE(is_strictly_ascending(std::array{1, 2, 4}));
  EXPECT_FALSE(is_strictly_ascending(std::array{1, 2, 2}));
  EXPECT_FALSE(is_strictly_ascending(std::array{1, 3, 2}));
}

}  // namespace
}  // namespace polhode::assert_tests
