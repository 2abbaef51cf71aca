// SPDX-License-Identifier: Apache-2.0
// Warnings about a tolerance that was not reached.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <polhode/stepping/step_reach.hpp>

namespace polhode {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

TEST(StepReach, IsSilentWhereEveryStepReachesItsError) {
  for (const int order : {2, 4, 8}) {
    StepReach reach;
    EXPECT_THAT(reach.warnings(1e-6, order), IsEmpty());
    for (int k = 0; k < 100; ++k) reach.count(0.01 * k, 0.5e-8, 1e-8, false);
    EXPECT_THAT(reach.warnings(1e-6, order), IsEmpty()) << order;
  }
}

TEST(StepReach, NamesTheFirstStepBeyondAndTheWorst) {
  StepReach reach;
  for (int k = 0; k < 10; ++k) reach.count(0.1 * k, k >= 6 ? k * 1e-6 : 1e-9, 1e-8, false);
  for (const int order : {2, 6})
    EXPECT_THAT(
        reach.warnings(1e-6, order),
        ElementsAre(AllOf(HasSubstr("4 of 10 steps, the first at t = 0.6 s"),
                          HasSubstr("errors up to 9.0e-06"), HasSubstr("add up to 3.0e-05"))));
}

// The higher orders apply the tolerance to each step: the sum may be much larger.
TEST(StepReach, TellsWhatTheErrorsOfAllStepsAddUpTo) {
  StepReach reach;
  for (int k = 0; k < 1000; ++k) reach.count(1e-3 * k, 0.9e-6, 1e-6, false);
  EXPECT_THAT(reach.warnings(1e-6, 8),
              ElementsAre(HasSubstr("errors of 1000 steps add up to 9.0e-04")));
  EXPECT_THAT(reach.warnings(1e-4, 8), IsEmpty());
}

// Steps accepted as noise are below round-off at order 2 as long as they do not add up.
TEST(StepReach, TakesNoiseThatDoesNotAddUpForRoundOff) {
  StepReach reach;
  reach.count(0.5, 1e-12, 1e-13, true);
  EXPECT_THAT(reach.warnings(1e-6, 2), IsEmpty());
  EXPECT_THAT(reach.warnings(1e-6, 4), IsEmpty());
  reach.count(0.6, 2e-6, 1e-6, true);
  EXPECT_THAT(reach.warnings(1e-6, 4), ElementsAre(HasSubstr("was not reached: 2 of 2 steps")));
}

}  // namespace
}  // namespace polhode
