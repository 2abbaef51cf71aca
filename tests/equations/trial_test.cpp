// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <polhode/equations/trial.hpp>

#include "engines/mechanisms.hpp"

namespace polhode::trial_tests {
namespace {

using namespace test;

// @tests{eq:td-Newmark-COM} @tests{eq:td-Newmark-mrot} @tests{eq:td-incremental-rotation}
TEST(BodyStepOfATrial, IsTheNewmarkStepOfThatBody) {
  const System system = double_pendulum().system();
  State state = system.initial_state();
  for (int b = 0; b < 2; ++b) {
    BodyMotion m = system.motion(state, b);
    m.a = Vec3(0.3, -2.0, 1.0 + b);
    m.A = Vec3(-0.5, 0.7, 2.0 - b);
    state.set_motion(system.slot(b), m);
  }
  for (const double rho : {0.0, 0.5, 1.0}) {
    Trial trial;
    trial.context.ga = GeneralizedAlpha::from_spectral_radius(rho);
    trial.context.dt = 0.05;
    start_trial(system, state, trial);
    for (int b = 0; b < 2; ++b) {
      const Vec3 u(0.1, 0.2 - b, 0.3), theta(-0.2, 0.4, 0.1 * b);
      move_body(state, trial, system.slot(b), u, theta);
      const BodyStep ours = body_step(system, state, trial, b);
      const BodyStep plain = newmark_step(system.motion(state, b), u, theta, trial.context);
      // A few roundings of numbers up to c/Δt = 40.
      EXPECT_LT((ours.v_n1 - plain.v_n1).norm() + (ours.W_n1 - plain.W_n1).norm(), 1e-13);
      EXPECT_LT((ours.r_n1 - plain.r_n1).norm() + (ours.Lambda_n1 - plain.Lambda_n1).norm(), 1e-14);
      EXPECT_EQ(ours.rate, plain.rate);
      EXPECT_EQ(ours.alpha_f, plain.alpha_f);
      EXPECT_EQ(ours.u, u);
    }
    EXPECT_FALSE(body_step(system, state, trial, kGround).moves);
  }
}

}  // namespace
}  // namespace polhode::trial_tests
