// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <polhode/core/error.hpp>
#include <polhode/kernels/dispatch.hpp>

namespace polhode::dispatch_tests {
namespace {

TEST(Dispatch, ChoosesTheWidestSetOfTheMachine) {
  const std::vector<std::string> sets = available_instruction_sets();
  ASSERT_FALSE(sets.empty());
  EXPECT_EQ(sets.back(), "baseline");
  EXPECT_EQ(&lane_kernels("automatic"), &lane_kernels(sets.front()));
}

TEST(Dispatch, RefusesUnknownSets) {
  try {
    (void)lane_kernels("sse9");
    FAIL() << "accepted";
  } catch (const InputError& e) {
    EXPECT_THAT(e.what(), testing::HasSubstr("sse9"));
    EXPECT_THAT(e.what(), testing::HasSubstr("baseline"));
  }
}

}  // namespace
}  // namespace polhode::dispatch_tests
