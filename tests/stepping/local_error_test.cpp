// SPDX-License-Identifier: Apache-2.0
// Estimated errors of steps, against motions whose third derivative is known.
#include <polhode/stepping/local_error.hpp>

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include <polhode/core/format.hpp>
#include <stepping/stepped_model.hpp>

namespace polhode::local_error_tests {
namespace {

using test::SteppedModel;

/// Estimate after three steps.
StepError estimate(SteppedModel& model, double dt) {
  for (int k = 0; k < 3; ++k) {
    EXPECT_EQ(error_of_last_step(model.system, model.state).has_value(), false) << k;
    EXPECT_TRUE(model.step.take(model.state, dt, {}, {}).converged);
  }
  const auto error = error_of_last_step(model.system, model.state);
  EXPECT_TRUE(error.has_value());
  return error.value_or(StepError{});
}

// A force that grows evenly: x‴ = j, and the method's error in a step is Δt³ j/12.
TEST(LocalError, IsThatOfAnEvenJerk) {
  for (const double dt : {0.2, 0.02, 2e-3}) {
    SteppedModel model(R"(
format: 1
bodies:
  still: {mass: 1, inertia: [1, 1, 1], position: [0, 5, 0]}
  pushed: {mass: 2, inertia: [1, 1, 1], position: [1, 0, 0]}
loads: {f: {type: force, body: pushed, force: ["6*t", 0, "8*t"]}}
analysis: {duration: 1, step: 0.1}
)");
    const StepError error = estimate(model, dt);
    const double exact = dt * dt * dt * 5.0 / 12.0 / model.system.length_scale();
    EXPECT_NEAR(error.value, exact, 1e-6 * exact + 1e-15) << dt;
    EXPECT_EQ(model.system.bodies()[error.body].name, "pushed");
    EXPECT_EQ(error.node, -1);
  }
}

// A step with the rotation vector ωΔt rotates by 2 atan(ωΔt/2), (ωΔt)³/12 less. @tests{step-error}
TEST(LocalError, IsThatOfThePhaseOfASpin) {
  for (const double dt : {0.05, 0.01, 1e-3}) {
    SteppedModel model(R"(
format: 1
bodies:
  slow: {mass: 1, inertia: [1, 2, 3], position: [0, 5, 0], angular_velocity: [0, 0, 1]}
  fast: {mass: 1, inertia: [1, 2, 3], position: [1, 0, 0], angular_velocity: [0, 0, 4]}
analysis: {duration: 1, step: 0.1}
)");
    const StepError error = estimate(model, dt);
    EXPECT_NEAR(error.value, std::pow(4.0 * dt, 3) / 12.0, 1e-6 * std::pow(dt, 3) + 1e-14) << dt;
    EXPECT_EQ(model.system.bodies()[error.body].name, "fast");
    const double missing = 4.0 * dt - 2.0 * std::atan(2.0 * dt);
    EXPECT_NEAR(error.value, missing, 2.0 * dt * dt * missing * 4.0 + 1e-15) << dt;
  }
}

// It is relative to the model's size: of a model a thousand times as large it is the same.
TEST(LocalError, DoesNotDependOnTheUnitOfLength) {
  double value[2];
  for (const int k : {0, 1}) {
    const double L = k == 0 ? 1.0 : 1e3;
    SteppedModel model(format(R"(
format: 1
bodies:
  a: {{mass: 2, inertia: [{0}, {0}, {0}], position: [{1}, 0, 0]}}
  b: {{mass: 1, inertia: [{0}, {0}, {0}], position: [0, {1}, 0]}}
loads: {{f: {{type: force, body: a, force: ["{2}*t", 0, 0]}}}}
analysis: {{duration: 1, step: 0.1}}
)",
                              L * L, L, 6.0 * L));
    value[k] = estimate(model, 0.05).value;
  }
  EXPECT_GT(value[0], 1e-6);
  EXPECT_NEAR(value[1], value[0], 1e-9 * value[0]);
}

TEST(LocalError, RecordsSumsAndTheLargestWithItsTime) {
  State state;
  state.t = 1.0;
  record_error(state, {.value = 1e-3, .body = 4});
  state.t = 2.0;
  record_error(state, {.value = 5e-3, .node = 7}, 3);
  state.t = 3.0;
  record_error(state, {.value = 2e-3, .body = 1});
  const StepErrors& e = state.ledger.errors;
  EXPECT_EQ(e.steps, 5);
  EXPECT_DOUBLE_EQ(e.sum, 1e-3 + 3.0 * 5e-3 + 2e-3);
  EXPECT_EQ(e.largest, 5e-3);
  EXPECT_EQ(e.time, 2.0);
  EXPECT_EQ(e.body, -1);
  EXPECT_EQ(e.node, 7);
}

TEST(LocalError, RecordsTheFirstOfTheHardSteps) {
  State state;
  for (const double t : {0.5, 0.7, 0.9}) {
    state.t = t;
    record_hard(state);
  }
  EXPECT_EQ(state.ledger.errors.hard, 3);
  EXPECT_EQ(state.ledger.errors.hard_time, 0.5);
}

// A rotor that a drive turns by half a radian in each step is where the drive puts it: its rotation
// is no error. @tests{step-error-projected}
TEST(LocalError, LeavesOutWhatADrivePrescribes) {
  SteppedModel model(R"(
format: 1
bodies: {rotor: {mass: 1, inertia: [1, 2, 3], position: [0, 0, 0], angular_velocity: [0, 0, 50]}}
joints: {axle: {type: revolute, bodies: [ground, rotor], at: [0, 0, 0], axis: z}}
loads: {drive: {type: rotary_motor, joint: axle, speed: 50}}
analysis: {duration: 1, step: 0.01}
)");
  for (int k = 0; k < 4; ++k)
    ASSERT_TRUE(model.step.take(model.state, 0.01, {}, {}).converged) << k;
  const auto raw = error_of_last_step(model.system, model.state);
  ASSERT_TRUE(raw.has_value());
  // The step's rotation vector for half a radian is 2 tan(1/4).
  EXPECT_NEAR(raw->value, std::pow(2.0 * std::tan(0.25), 3) / 12.0, 1e-9);
  record_last_step(model.system, model.state);
  EXPECT_EQ(model.state.ledger.errors.steps, 1);
  EXPECT_LT(model.state.ledger.errors.sum, 1e-6);
}

}  // namespace
}  // namespace polhode::local_error_tests
