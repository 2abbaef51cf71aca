// SPDX-License-Identifier: Apache-2.0
// Newton's method in a step: how fast it converges, what it keeps, and what it says if it does not.
#include <polhode/newton/newton.hpp>

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <polhode/stepping/step_error.hpp>
#include <stepping/stepped_model.hpp>

namespace polhode::newton_tests {
namespace {

using test::SteppedModel;
using testing::HasSubstr;

constexpr const char* kPendulum = R"(
format: 1
gravity: [0, 0, -9.81]
bodies:
  upper: {mass: 2, inertia: [0.2, 0.3, 0.1], position: [1, 0, 0]}
  lower: {mass: 1, inertia: [0.1, 0.2, 0.3], position: [2, 0.5, 0]}
joints:
  j: {type: spherical, bodies: [ground, upper], at: [0, 0, 0]}
  k: {type: universal, bodies: [upper, lower], at: [2, 0, 0], axes: [y, z]}
analysis: {duration: 1, step: 0.01}
)";

NewtonReport take(SteppedModel& model, double dt, const NewtonOptions& options = {}) {
  return model.step.take(model.state, dt, options, {.degree = -1});
}

TEST(Newton, ConvergesQuadratically) {
  SteppedModel model(kPendulum);
  for (int k = 0; k < 50; ++k) ASSERT_TRUE(take(model, 0.01).converged);
  for (const double dt : {0.1, 0.03, 0.01}) {
    SteppedModel other(kPendulum);
    other.state = model.state;
    other.step.ledger().forget();
    const NewtonReport r = take(other, dt, {.jacobian = JacobianPolicy::every_iteration});
    ASSERT_TRUE(r.converged) << r.text();
    ASSERT_GE(r.increments.size(), 3u);
    for (std::size_t k = 1; k < r.increments.size(); ++k)
      EXPECT_LE(r.increments[k], 3.0 * r.increments[k - 1] * r.increments[k - 1] + 1e-13)
          << dt << ", iteration " << k;
    EXPECT_EQ(r.iterations, static_cast<int>(r.increments.size()));
    EXPECT_EQ(r.dt, dt);
  }
}

TEST(Newton, SolvesALinearProblemAtOnce) {
  SteppedModel model(R"(
format: 1
gravity: [0, 0, -10]
bodies: {stone: {mass: 2, inertia: [1, 1, 1], position: [0, 0, 3], velocity: [4, 0, 5]}}
analysis: {duration: 1, step: 0.1}
)");
  const NewtonReport r = take(model, 0.3);
  ASSERT_TRUE(r.converged);
  EXPECT_LE(r.iterations, 2);
  EXPECT_LT(r.increments.back(), 1e-14);
  const Vec3 at = model.system.motion(model.state, 0).r;
  EXPECT_NEAR(at.x(), 1.2, 1e-15);
  EXPECT_NEAR(at.z(), 3.0 + 1.5 - 0.45, 1e-15);
}

TEST(Newton, FindsTheSameMotionWheneverItFactorises) {
  SteppedModel every(kPendulum);
  for (int k = 0; k < 40; ++k)
    ASSERT_TRUE(take(every, 0.01, {.jacobian = JacobianPolicy::every_iteration}).converged);
  for (const JacobianPolicy policy : {JacobianPolicy::automatic, JacobianPolicy::every_step}) {
    SteppedModel other(kPendulum);
    for (int k = 0; k < 40; ++k) ASSERT_TRUE(take(other, 0.01, {.jacobian = policy}).converged);
    EXPECT_LT(state_difference(every.system, every.state, other.state, 0.01), 1e-12);
  }
}

// An increment of the coarsest tolerance is 1e-2: the extra iterations are what makes conservation
// independent of it.
TEST(Newton, KeepsEnergyAndConstraintsWhateverItsTolerance) {
  for (const double tolerance : {1e-2, 1e-5, 1e-9}) {
    SteppedModel model(kPendulum);
    for (int k = 0; k < 300; ++k) {
      const NewtonReport r = take(model, 0.01, {.tolerance = tolerance});
      ASSERT_TRUE(r.converged) << tolerance << ": " << r.text();
      EXPECT_LT(r.constraints.residual, 1e-12) << tolerance;
      EXPECT_FALSE(r.leaks);
      EXPECT_FALSE(r.hard);
      model.step.ledger().close_step(model.state);
    }
    // Each of 300 steps leaves a distance of 1e-13 at most.
    EXPECT_LT(drifts(model.state.ledger).energy, 300 * 1e-13) << tolerance;
  }
}

TEST(Newton, SaysThatItHadTooFewIterations) {
  SteppedModel model(kPendulum);
  const NewtonReport r = take(model, 0.1, {.max_iterations = 1});
  EXPECT_FALSE(r.converged);
  EXPECT_EQ(r.reason, "has not converged in 1 iterations");
  EXPECT_EQ(r.iterations, 1);
  EXPECT_THAT(r.text(), testing::AllOf(HasSubstr("Newton failed at t = 0 s (step 0.1 s): has not"),
                                       HasSubstr("; largest increment at body '")));
  EXPECT_EQ(model.state.t, 0.0);
}

// A body that spins freely about a principal axis: |Θ| is the speed times the step.
TEST(Newton, RefusesARotationThatItsFormulaDoesNotResolve) {
  const char* top = R"(
format: 1
bodies: {top: {mass: 1, inertia: [1, 1, 2], angular_velocity: [0, 0, 30]}}
analysis: {duration: 1, step: 0.1}
)";
  SteppedModel model(top);
  const NewtonReport r = take(model, 0.1);
  EXPECT_FALSE(r.converged);
  EXPECT_EQ(r.reason,
            "a body rotates by |Θ| = 3 (113 deg) in one step, more than max_step_rotation = 2 (90 "
            "deg)");
  const NewtonReport allowed = take(model, 0.1, {.max_rotation = 3.5});
  EXPECT_TRUE(allowed.converged);
  EXPECT_NEAR(allowed.rotation, 3.0, 1e-13);
  const Mat3 turned = model.system.motion(model.state, 0).Lambda();
  EXPECT_NEAR(std::atan2(turned(1, 0), turned(0, 0)), 2.0 * std::atan(1.5), 1e-13);
}

TEST(Newton, NamesAValueThatIsNotFinite) {
  SteppedModel model(R"m(
format: 1
bodies: {a: {mass: 1, inertia: [1, 1, 1]}}
loads: {f: {type: force, body: a, force: ["sqrt(0.05 - t)", 0, 0]
}
}
analysis: {duration: 0.04, step: 0.01}
)m");
  const State before = model.state;
  const NewtonReport r = take(model, 0.2);
  EXPECT_FALSE(r.converged);
  EXPECT_THAT(r.reason, HasSubstr("finite"));
  EXPECT_EQ(model.system.motion(model.state, 0).v, model.system.motion(before, 0).v);
  EXPECT_TRUE(take(model, 0.04).converged);
}

// Rows that no motion satisfies: two drives of one slider.
TEST(Newton, DoesNotAcceptOpenRows) {
  SteppedModel model(R"(
format: 1
bodies: {a: {mass: 1, inertia: [1, 1, 1]}}
joints: {guide: {type: prismatic, bodies: [ground, a], at: [0, 0, 0], axis: x}}
loads:
  one: {type: linear_motor, joint: guide, displacement: "t^2"}
  two: {type: linear_motor, joint: guide, displacement: "2*t^2"}
analysis: {duration: 1, step: 0.1}
)");
  const NewtonReport r = take(model, 0.1);
  EXPECT_FALSE(r.converged);
  EXPECT_FALSE(r.reason.empty());
  EXPECT_EQ(model.state.t, 0.0);
}

}  // namespace
}  // namespace polhode::newton_tests
