// SPDX-License-Identifier: Apache-2.0
// The ledger of energy and momenta against closed forms.
#include <cmath>

#include <gtest/gtest.h>

#include <stepping/stepped_model.hpp>

namespace polhode::ledger_tests {
namespace {

using test::SteppedModel;

void take(SteppedModel& run, double dt, int count) {
  for (int k = 0; k < count; ++k) {
    ASSERT_TRUE(run.step.take(run.state, dt, NewtonOptions{}, {}).converged);
    run.step.ledger().close_step(run.state);
  }
}

constexpr const char* kFree = R"(
format: 1
gravity: [0, 0, -10]
bodies:
  a: {mass: 2, inertia: [1, 2, 3], position: [1, 2, 3], velocity: [4, 5, 6], angular_velocity: [0, 0, 2]}
  b: {mass: 3, inertia: [2, 2, 2], velocity: [0, -1, 0]}
analysis: {duration: 1, step: 0.1}
)";

TEST(EnergyLedger, SumsAreThoseOfTheBodies) {
  SteppedModel run(kFree);
  const BodySums s = run.step.ledger().sums(run.state);
  EXPECT_NEAR(s.kinetic, 0.5 * 2 * 77 + 0.5 * 3 * 4 + 0.5 * 3 * 1, 1e-12);
  EXPECT_NEAR(s.gravity_potential, 2 * 10 * 3, 1e-12);
  // r × m v of a is (1, 2, 3) × (8, 10, 12) = (-6, 12, -6), and its spin 3 · 2 about z.
  const double p[3] = {8, 7, 12}, l[3] = {-6, 12, 0};
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(s.p[i], p[i], 1e-12) << i;
    EXPECT_NEAR(s.l[i], l[i], 1e-12) << i;
  }
  EXPECT_NEAR(s.p_scale, 2 * std::sqrt(77) + 3, 1e-12);
}

TEST(EnergyLedger, GravityIsAnImpulseOnTheMomenta) {
  for (const double dt : {0.1, 0.01, 1e-3}) {
    SteppedModel run(kFree);
    take(run, dt, static_cast<int>(std::lround(0.5 / dt)));
    const Ledger& l = run.state.ledger;
    EXPECT_NEAR(l.impulse[2].value(), -5 * 10 * 0.5, 1e-11) << dt;
    EXPECT_NEAR(l.impulse[0].value(), 0.0, 1e-12) << dt;
    // ∫ r × m g dt of both, with x = 1 + 4 t and y = 2 + 5 t, and y = -t.
    EXPECT_NEAR(l.angular_impulse[0].value(), -10 * (2 * (1 + 5.0 / 8) + 3 * (-1.0 / 8)), 1e-11);
    EXPECT_NEAR(l.angular_impulse[1].value(), 10 * 2 * (0.5 + 0.5), 1e-11) << dt;
    const Drifts d = drifts(l);
    EXPECT_LT(d.energy, 1e-12) << dt;
    EXPECT_LT(d.linear_momentum, 1e-12) << dt;
    EXPECT_LT(d.angular_momentum, 1e-12) << dt;
    EXPECT_EQ(l.put_in.value(), 0.0);
    EXPECT_EQ(l.dissipated.value(), 0.0);
  }
}

constexpr const char* kDriven = R"(
format: 1
bodies: {a: {mass: 2, inertia: [1, 1, 1]}}
joints: {j: {type: prismatic, bodies: [ground, a], at: [0, 0, 0], axis: x}}
loads: {m: {type: linear_motor, joint: j, displacement: "3*t^2"}}
analysis: {duration: 1, step: 0.1}
)";

// @tests{drive-work}
TEST(EnergyLedger, TheWorkOfADriveIsTheEnergyThatItGives) {
  for (const double dt : {0.1, 0.01, 1e-3}) {
    SteppedModel run(kDriven);
    take(run, dt, static_cast<int>(std::lround(1.0 / dt)));
    EXPECT_NEAR(run.state.ledger.put_in.value(), 0.5 * 2 * 36, 1e-9) << dt;
    EXPECT_NEAR(run.state.ledger.impulse[0].value(), 2 * 6, 1e-9) << dt;
    EXPECT_LT(drifts(run.state.ledger).energy, 1e-11) << dt;
  }
}

constexpr const char* kDamped = R"(
format: 1
bodies: {a: {mass: 2, inertia: [1, 1, 1], position: [1, 0, 0], velocity: [3, 0, 0]}}
joints: {j: {type: prismatic, bodies: [ground, a], at: [0, 0, 0], axis: x}}
loads:
  s: {type: spring_damper, bodies: [ground, a], at: [[0, 0, 0], [1, 0, 0]], stiffness: 50, damping: 4, free_length: 1}
analysis: {duration: 1, step: 0.1}
)";

TEST(EnergyLedger, WhatADamperTakesIsWhatIsLost) {
  for (const double dt : {0.05, 0.01, 5e-4}) {
    SteppedModel run(kDamped);
    take(run, dt, static_cast<int>(std::lround(1.0 / dt)));
    const Balance b = run.step.ledger().balance(run.state);
    EXPECT_GT(b.dissipated, 5.0);
    EXPECT_NEAR(b.kinetic + b.potential + b.dissipated, 0.5 * 2 * 9, 1e-11) << dt;
    EXPECT_EQ(b.put_in, 0.0);
  }
}

// Its force on the body is an impulse from outside: of the ground.
TEST(EnergyLedger, TheImpulseOfTheGroundIsTheChangeOfMomentum) {
  SteppedModel run(kDamped);
  const BodySums before = run.step.ledger().sums(run.state);
  take(run, 0.01, 37);
  const BodySums after = run.step.ledger().sums(run.state);
  EXPECT_NEAR(run.state.ledger.impulse[0].value(), after.p[0] - before.p[0], 1e-12);
}

// @tests{jump-work}
TEST(EnergyLedger, AJumpIsALossAndAnImpulse) {
  SteppedModel run(kFree);
  EnergyLedger& ledger = run.step.ledger();
  const BodySums before = ledger.sums(run.state);
  BodyMotion m = run.system.motion(run.state, 1);
  m.v = Vec3(0.0, 0.5, 0.0);  // a rebound with e = 0.5
  run.state.set_motion(run.system.slot(1), m);
  ledger.add_jump(run.state, before, 0.0);
  ledger.forget();  // as after_commit() does
  ledger.close_step(run.state);
  EXPECT_NEAR(run.state.ledger.dissipated.value(), 0.5 * 3 * (1 - 0.25), 1e-12);
  EXPECT_NEAR(run.state.ledger.impulse[1].value(), 3 * 1.5, 1e-12);
  EXPECT_LT(drifts(run.state.ledger).energy, 1e-13);
}

// @tests{drift-floor}
TEST(EnergyLedger, DriftsAreRelativeToTheLargestMagnitudesButNotToRounding) {
  Ledger l;
  l.energy_drift = 1e-6;
  l.energy_scale = 10.0;
  l.p_drift = 2.0;
  EXPECT_DOUBLE_EQ(drifts(l).energy, 1e-7);
  EXPECT_DOUBLE_EQ(drifts(l).linear_momentum, 2.0);  // nothing to compare it with
  l.energy_scale = 0.0;
  l.energy_noise = 1e-6;  // all of it is rounding
  EXPECT_LE(drifts(l).energy, 1e-10 * (1.0 + 1e-12));
}

TEST(EnergyLedger, AJumpOfTheStateIsADrift) {
  SteppedModel run(kFree);
  BodyMotion m = run.system.motion(run.state, 1);
  m.v *= 1.01;  // energy and momentum from nowhere
  run.state.set_motion(run.system.slot(1), m);
  run.step.ledger().forget();
  run.step.ledger().close_step(run.state);
  EXPECT_NEAR(run.state.ledger.energy_drift, 0.5 * 3 * (1.01 * 1.01 - 1), 1e-12);
  EXPECT_NEAR(run.state.ledger.p_drift, 3 * 0.01, 1e-12);
}

}  // namespace
}  // namespace polhode::ledger_tests
