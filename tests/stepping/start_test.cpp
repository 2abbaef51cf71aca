// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <polhode/engines/sparse_engine.hpp>
#include <polhode/math/quaternion.hpp>
#include <polhode/stepping/start.hpp>

#include "engines/mechanisms.hpp"

namespace polhode::start_tests {
namespace {

using namespace test;

GeneralizedAlpha ga(double rho) { return GeneralizedAlpha::from_spectral_radius(rho); }

TEST(Start, MakesAStateConsistentAndReportsChanges) {
  Mechanism m = double_pendulum();
  m.model.bodies[1].position += Vec3(0.01, 0.02, 0.0);  // joints were placed before
  const System system = m.system();
  State state = system.initial_state();
  const StartReport report = start(system, state, ga(1.0), 0.01);
  EXPECT_TRUE(report.assembled && report.consistent);
  EXPECT_NEAR(report.position_residual, 0.02, 1e-12);
  EXPECT_GT(report.largest_move, 1e-3);
  EXPECT_FALSE(report.moved_body.empty());
  EXPECT_GT(report.velocity_residual, 0.0);
  EXPECT_TRUE(
      std::any_of(state.lambda.begin(), state.lambda.end(), [](double l) { return l != 0; }));
  State again = state;
  const StartReport second = start(system, again, ga(1.0), 0.01);
  EXPECT_EQ(second.largest_move, 0.0);
  EXPECT_EQ(second.velocity_change, 0.0);
}

TEST(Start, StopsAtConstraintsThatContradictOneAnother) {
  Mechanism m;
  const int rod = m.body("rod", {0.5, 0, 0});
  m.joint("left", "spherical", kGround, rod, {0, 0, 0});
  m.joint("right", "spherical", kGround, rod, {1.0, 0, 0});
  m.model.joints.back().Z_a = {1.2, 0.0, 0.0};
  const System system = m.system();
  State state = system.initial_state();
  const StartReport report = start(system, state, ga(1.0), 0.01);
  EXPECT_FALSE(report.assembled);
  EXPECT_THAT(report.unsatisfied, testing::ElementsAre("joint 'left'", "joint 'right'"));
}

/// Angular acceleration of a free body a short time later, by many small steps of Euler's equations
/// (whose error, 1e-12, is negligible).
Vec3 later_acceleration(const Vec3& W_0, const Mat3& J, double tau) {
  const Mat3 J_inverse = J.inverse();
  const auto A = [&](const Vec3& W) -> Vec3 { return -(J_inverse * W.cross(J * W)); };
  Vec3 W = W_0;
  const int n = 1000;
  const double h = tau / n;
  for (int i = 0; i < n; ++i) {
    const Vec3 k1 = A(W), k2 = A(W + 0.5 * h * k1), k3 = A(W + 0.5 * h * k2), k4 = A(W + h * k3);
    W += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
  }
  return A(W);
}

TEST(StartAccelerations, BelongToTheEffectiveTimeToSecondOrder) {
  Mechanism m;
  const int top = m.body("top", {0, 0, 0}, 1.0, {1.0, 2.0, 2.7});
  m.velocity(top, {1, 2, 3}, {1.0, 1.5, 0.5});
  const System system = m.system();
  for (const double rho : {0.0, 0.5, 0.9}) {
    double error[2];
    for (int k = 0; k < 2; ++k) {
      const double dt = k == 0 ? 0.02 : 0.01;
      State state = system.initial_state();
      start(system, state, ga(rho), dt);
      const Vec3 exact =
          later_acceleration({1.0, 1.5, 0.5}, system.bodies()[0].inertia, ga(rho).delta * dt);
      error[k] = (system.motion(state, 0).A - exact).norm();
      EXPECT_LT(system.motion(state, 0).h_dot.norm(), 1e-12);  // no moment acts
    }
    EXPECT_GT(error[0] / error[1], 3.5) << rho;
    EXPECT_LT(error[0], 1e-3);
  }
}

TEST(StartAccelerations, MakeTheMethodSecondOrderBelowRhoOne) {
  // rigid.md: with zero accelerations at the start all is of first order. Positions after a
  // quarter of a second against half the step.
  const System system = double_pendulum("spherical").system();
  const auto end = [&](int steps, bool zero) {
    State state = system.initial_state();
    const double dt = 0.25 / steps;
    start(system, state, ga(0.5), dt);
    if (zero)
      for (int b = 0; b < 2; ++b) {
        BodyMotion motion = system.motion(state, b);
        motion.a = motion.A = motion.h_dot = Vec3::Zero();
        state.set_motion(system.slot(b), motion);
      }
    SparseEngine engine(system, "block_lu");
    for (int i = 0; i < steps; ++i) take_step(system, state, engine, dt, 0.5);
    return system.motion(state, 1).r;
  };
  const auto order = [&](bool zero) {
    const Vec3 coarse = end(25, zero), middle = end(50, zero), fine = end(100, zero);
    return std::log2((coarse - middle).norm() / (middle - fine).norm());
  };
  EXPECT_NEAR(order(false), 2.0, 0.15);
  EXPECT_LT(order(true), 1.5);
}

TEST(StartSmoothMultipliers, RemovesTheAlternatingPartAtRhoOne) {
  const System system = double_pendulum("spherical").system();
  const auto alternation = [&](bool smooth, double& energy_change) {
    State state = system.initial_state();
    start(system, state, ga(1.0), 0.005);
    const double before = energy(system, state);
    if (smooth) start_smooth_multipliers(system, state, ga(1.0), 0.005);
    energy_change = std::abs(energy(system, state) - before);
    SparseEngine engine(system, "block_lu");
    std::vector<std::vector<double>> lambda;
    for (int i = 0; i < 12; ++i) {
      take_step(system, state, engine, 0.005, 1.0);
      lambda.push_back(state.lambda);
    }
    double largest = 0.0;  // fourth difference: the alternating part only
    for (std::size_t row = 0; row < lambda[0].size(); ++row)
      largest =
          std::max(largest, std::abs(lambda[4][row] - 4 * lambda[5][row] + 6 * lambda[6][row] -
                                     4 * lambda[7][row] + lambda[8][row]) /
                                16.0);
    return largest;
  };
  double change = 0.0;
  const double naive = alternation(false, change);
  const double smooth = alternation(true, change);
  EXPECT_LT(smooth, 0.02 * naive);
  EXPECT_LT(change, 1e-6);  // O(Δt⁴) of some joules
}

TEST(Start, KeepsTheBranchOfAFlatFourBar) {
  const System system = four_bars(1, 0.0).system();
  State state = system.initial_state();
  const StartReport report = start(system, state, ga(1.0), 0.01);
  EXPECT_TRUE(report.assembled && report.consistent);
  EXPECT_EQ(report.largest_move, 0.0);
  SparseEngine engine(system, "block_lu");
  const double before = energy(system, state);
  for (int i = 0; i < 50; ++i) ASSERT_FALSE(take_step(system, state, engine, 0.01, 1.0).empty());
  EXPECT_NEAR(energy(system, state), before, 1e-9);
  // The linkage stays a parallelogram: cranks turn alike, the coupler does not.
  EXPECT_LT((system.motion(state, 0).r + Vec3(1, 0, 0) - system.motion(state, 1).r).norm(), 1e-8);
}

}  // namespace
}  // namespace polhode::start_tests
