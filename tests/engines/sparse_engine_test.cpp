// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <polhode/engines/sparse_engine.hpp>
#include <polhode/stepping/instant.hpp>

#include "engines/mechanisms.hpp"

namespace polhode::sparse_engine_tests {
namespace {

using namespace test;

State consistent(const System& system) {
  State state = system.initial_state();
  project_velocities(system, state);
  return state;
}

class SparseEngines : public testing::TestWithParam<const char*> {};

// @tests{eq:ga-Newton-scheme} @tests{eq:ga-Newton-iterations}
TEST_P(SparseEngines, ConvergeQuadratically) {
  for (const Mechanism& m : {double_pendulum("spherical"), double_pendulum("universal")})
    for (const double rho : {1.0, 0.5}) {
      const System system = m.system();
      State state = consistent(system);
      SparseEngine engine(system, GetParam());
      const std::vector<double> e = take_step(system, state, engine, 0.05, rho);
      ASSERT_GE(e.size(), 3u);
      // e_{k+1} <= C e_k² until rounding; C is of the order of one in scaled variables.
      for (std::size_t k = 1; k < e.size(); ++k)
        EXPECT_LT(e[k], 10.0 * e[k - 1] * e[k - 1] + 1e-13) << GetParam() << " rho " << rho;
      EXPECT_LT(e.back(), 1e-12);
    }
}

// @tests{eq:ga-residual-vector}
TEST_P(SparseEngines, SatisfyEquationsAndConstraints) {
  const System system = four_bars(2, 1.1).system();
  State state = consistent(system);
  SparseEngine engine(system, GetParam());
  Trial trial;
  trial.context.ga = GeneralizedAlpha::from_spectral_radius(1.0);
  trial.context.dt = 0.01;
  start_trial(system, state, trial);
  for (int i = 0; i < 8; ++i) {
    ASSERT_TRUE(engine.iterate(state, trial, true, 1.0).solved);
    if (i >= 5) trial.lambda_centre = trial.lambda;
  }
  const ConstraintCheck check = engine.check(state, trial);
  EXPECT_LT(check.residual, 1e-14);
  EXPECT_LE(check.work_defect, 4.0 * std::numeric_limits<double>::epsilon() * check.work_scale);
  // Rounding of positions, 1e-16, divided by βΔt² = 2.5e-5 is 1e-11 of force per unit mass.
  NewtonSystem newton(system, MomentumRate::momentum);
  newton.assemble(state, trial, false);
  for (int b = 0; b < system.body_count(); ++b)
    EXPECT_LT(newton.body_residual(b).lpNorm<Eigen::Infinity>(), 1e-9);
  EXPECT_FALSE(worst_residual(newton).text(system).empty());
}

TEST_P(SparseEngines, ConserveEnergyOfLoopsWithRedundantRows) {
  for (const Mechanism& m : {four_bars(3, 1.3), bricard_system()}) {
    const System system = m.system();
    State state = consistent(system);
    SparseEngine engine(system, GetParam());
    const double before = energy(system, state);
    double scale = 0.0;
    for (int i = 0; i < 100; ++i) {
      ASSERT_FALSE(take_step(system, state, engine, 0.01, 1.0).empty());
      for (int b = 0; b < system.body_count(); ++b)
        scale = std::max(scale, system.bodies()[b].mass * system.motion(state, b).v.squaredNorm());
    }
    EXPECT_GT(scale, 0.1);  // the model moved
    // 100 steps with a constraint error of round-off each, times multipliers of 100 N.
    EXPECT_NEAR(energy(system, state), before, 1e-11);
  }
}

TEST_P(SparseEngines, ConvergeWithReusedFactors) {
  const System system = double_pendulum().system();
  State state = consistent(system);
  SparseEngine engine(system, GetParam());
  Trial trial;
  trial.context.dt = 0.01;
  start_trial(system, state, trial);
  double increment = 1.0;
  for (int i = 0; i < 25 && increment > 1e-12; ++i)
    increment = engine.iterate(state, trial, i == 0, 1.0).increment;
  EXPECT_LT(increment, 1e-12);
}

TEST_P(SparseEngines, DampTheIncrementByAGivenFactor) {
  const System system = double_pendulum().system();
  const State state = consistent(system);
  SparseEngine engine(system, GetParam());
  Trial whole, half;
  whole.context.dt = half.context.dt = 0.01;
  start_trial(system, state, whole);
  start_trial(system, state, half);
  const double full_size = engine.iterate(state, whole, true, 1.0).increment;
  EXPECT_DOUBLE_EQ(engine.iterate(state, half, true, 0.5).increment, full_size);
  for (int b = 0; b < 2; ++b)
    EXPECT_LT(
        (2.0 * body_step(system, state, half, b).u - body_step(system, state, whole, b).u).norm(),
        1e-15);
}

TEST_P(SparseEngines, ReportASingularMatrix) {
  Mechanism m = double_pendulum();
  m.model.bodies[0].velocity.x() = std::numeric_limits<double>::quiet_NaN();
  const System system = m.system();
  const State state = system.initial_state();
  SparseEngine engine(system, GetParam());
  Trial trial;
  trial.context.dt = 0.01;
  start_trial(system, state, trial);
  EXPECT_FALSE(engine.iterate(state, trial, true, 1.0).solved);
}

INSTANTIATE_TEST_SUITE_P(All, SparseEngines, testing::Values("block_lu", "klu", "sparse_lu"),
                         [](const auto& one) { return std::string(one.param); });

TEST(SparseEngine, IteratesTheSameWithEachLinearSolver) {
  for (const Mechanism& m : {double_pendulum(), spherical_chain(5)}) {
    const System system = m.system();
    const State state = consistent(system);
    const char* const names[] = {"block_lu", "klu", "sparse_lu"};
    Trial trial[3];
    for (Trial& t : trial) {
      t.context.dt = 0.02;
      start_trial(system, state, t);
    }
    std::vector<std::unique_ptr<SparseEngine>> engine;
    for (const char* name : names) engine.push_back(std::make_unique<SparseEngine>(system, name));
    for (int i = 0; i < 5; ++i) {
      for (std::size_t k = 0; k < 3; ++k)
        ASSERT_TRUE(engine[k]->iterate(state, trial[k], true, 1.0).solved);
      for (int b = 0; b < system.body_count(); ++b)
        for (const int k : {1, 2}) {
          const BodyStep x = body_step(system, state, trial[0], b);
          const BodyStep y = body_step(system, state, trial[k], b);
          // The scaled system has a condition of some hundreds.
          EXPECT_LT((x.u - y.u).norm() + (x.theta - y.theta).norm(), 1e-12) << names[k];
        }
    }
  }
}

}  // namespace
}  // namespace polhode::sparse_engine_tests
