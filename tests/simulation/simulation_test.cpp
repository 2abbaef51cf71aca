// SPDX-License-Identifier: Apache-2.0
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <polhode/polhode.hpp>

namespace polhode::simulation_tests {
namespace {

TEST(Simulation, RefusesAStepThatEndsBeforeItBegins) {
  Simulation run(io::read_model_text(R"(
format: 1
bodies: {ball: {mass: 1, inertia: [1, 1, 1], velocity: [1, 0, 0]}}
analysis: {duration: 1 s, step: 0.1 s}
)",
                                     "ball.yaml"));
  while (run.time() < 1.0 - 1e-9) ASSERT_TRUE(run.step(1.0).accepted);
  for (const double end : {run.time(), 0.5, std::numeric_limits<double>::quiet_NaN()}) {
    try {
      (void)run.step(end);
      ADD_FAILURE() << end;
    } catch (const InputError& e) {
      EXPECT_THAT(e.what(), testing::HasSubstr("must be after the present time, 1."));
    }
  }
  EXPECT_TRUE(run.step(1.05).accepted);
}

}  // namespace
}  // namespace polhode::simulation_tests
