// SPDX-License-Identifier: Apache-2.0
// Single steps: what they leave after a failure, their order, their error estimate, their
// prediction.
#include <cmath>
#include <cstring>

#include <gtest/gtest.h>

#include <polhode/stepping/step_error.hpp>
#include <stepping/stepped_model.hpp>

namespace polhode::single_step_tests {
namespace {

using test::SteppedModel;

constexpr const char* kPendulum = R"(
format: 1
gravity: [0, 0, -9.81]
bodies:
  a: {mass: 2, inertia: [0.2, 0.3, 0.1], position: [1, 0, 0]}
  b: {mass: 1, inertia: [0.1, 0.2, 0.3], position: [2, 0.5, 0]}
joints:
  j: {type: spherical, bodies: [ground, a], at: [0, 0, 0]}
  k: {type: universal, bodies: [a, b], at: [2, 0, 0], axes: [y, z]}
analysis: {duration: 1, step: 0.01}
)";

bool same_bits(const State& x, const State& y) {
  return x.t == y.t && x.lambda == y.lambda && x.history == y.history &&
         x.past_count == y.past_count && x.dt_last == y.dt_last &&
         std::memcmp(x.blocks.data(), y.blocks.data(), x.blocks.size() * sizeof(BodyBlock)) == 0;
}

TEST(SingleStep, AFailureLeavesTheStateAsItWas) {
  for (const double rho_inf : {1.0, 0.7}) {
    SteppedModel bench(kPendulum, rho_inf);
    ASSERT_TRUE(bench.step.take(bench.state, 0.01, {}, {}).converged);
    const State before = bench.state;
    const NewtonReport report = bench.step.take(bench.state, 40.0, {}, {});
    ASSERT_FALSE(report.converged);
    EXPECT_FALSE(report.text().empty());
    State after = bench.state;
    after.ledger = before.ledger;
    EXPECT_TRUE(same_bits(before, after)) << rho_inf;
    // The next step is that which would have followed.
    SteppedModel other(kPendulum, rho_inf);
    ASSERT_TRUE(other.step.take(other.state, 0.01, {}, {}).converged);
    ASSERT_TRUE(other.step.take(other.state, 0.01, {}, {}).converged);
    ASSERT_TRUE(bench.step.take(bench.state, 0.01, {}, {}).converged);
    EXPECT_LT(state_difference(bench.system, bench.state, other.state, 0.01), 1e-13) << rho_inf;
  }
}

/// Difference of the motion after `time` from that with steps of a quarter.
double error_at(double dt, double rho_inf) {
  SteppedModel coarse(kPendulum, rho_inf), fine(kPendulum, rho_inf);
  const int steps = static_cast<int>(std::lround(0.4 / dt));
  for (int k = 0; k < steps; ++k) EXPECT_TRUE(coarse.step.take(coarse.state, dt, {}, {}).converged);
  for (int k = 0; k < 4 * steps; ++k)
    EXPECT_TRUE(fine.step.take(fine.state, 0.25 * dt, {}, {}).converged);
  return state_difference(coarse.system, coarse.state, fine.state, 0.0);
}

TEST(SingleStep, HasOrderTwo) {
  for (const double rho_inf : {1.0, 0.6})
    for (const double dt : {0.02, 0.01, 5e-3})
      EXPECT_NEAR(std::log2(error_at(dt, rho_inf) / error_at(0.5 * dt, rho_inf)), 2.0, 0.2)
          << rho_inf << ' ' << dt;
}

// The estimate is of third order, as the error of one step is, and of its size. It is made on the
// way, since the rate of the acceleration is zero where the bodies are let go.
TEST(SingleStep, EstimatesItsErrorFromItsPrediction) {
  double last = 0.0;
  for (const double dt : {0.02, 0.01, 5e-3}) {
    SteppedModel bench(kPendulum);
    const int steps = static_cast<int>(std::lround(0.3 / dt));
    for (int k = 0; k < steps; ++k) ASSERT_TRUE(bench.step.take(bench.state, dt, {}, {}).converged);
    const State before = bench.state;
    ASSERT_TRUE(bench.step.take(bench.state, dt, {}, {.degree = 1, .remember = true}).converged);
    const double estimate = bench.step.error_estimate();
    if (last > 0.0) {
      EXPECT_NEAR(std::log2(last / estimate), 3.0, 0.35) << dt;
    }
    last = estimate;

    const State one = bench.state;
    bench.state = before;
    bench.step.ledger().forget();
    for (int k = 0; k < 2; ++k)
      ASSERT_TRUE(bench.step.take(bench.state, 0.5 * dt, {}, {}).converged);
    const double error = 4.0 / 3.0 * state_difference(bench.system, one, bench.state, 0.0);
    EXPECT_LT(estimate, 5.0 * error) << dt;
    EXPECT_GT(estimate, 0.2 * error) << dt;
  }
}

TEST(SingleStep, PredictsBetterFromMorePastSteps) {
  int iterations[2] = {0, 0};
  for (const int which : {0, 1}) {
    SteppedModel bench(kPendulum);
    for (int k = 0; k < 100; ++k) {
      const NewtonReport r = bench.step.take(bench.state, 2e-3, {}, {which == 0 ? -1 : 3, false});
      ASSERT_TRUE(r.converged);
      iterations[which] += r.iterations;
    }
    EXPECT_EQ(bench.state.ledger.iterations, iterations[which]);
  }
  EXPECT_LT(iterations[1], iterations[0]);
}

TEST(SingleStep, TakenBackEndsWhereItBegan) {
  for (const double dt : {0.05, 0.01, 5e-4}) {
    SteppedModel bench(kPendulum);
    for (int k = 0; k < 10; ++k) ASSERT_TRUE(bench.step.take(bench.state, dt, {}, {}).converged);
    for (int k = 0; k < 10; ++k)
      ASSERT_TRUE(bench.step.take(bench.state, -dt, {}, {-1, false}).converged);
    SteppedModel at_start(kPendulum);
    EXPECT_LT(state_difference(bench.system, bench.state, at_start.state, dt), 1e-11) << dt;
    EXPECT_NEAR(bench.state.t, 0.0, 1e-15);
  }
}

TEST(SingleStep, SaysWhetherAStopWasMet) {
  SteppedModel bench(R"(
format: 1
bodies: {a: {mass: 1, inertia: [1, 1, 1], velocity: [1, 0, 0]}}
joints: {j: {type: prismatic, bodies: [ground, a], at: [0, 0, 0], axis: x, limits: {upper: 0.05, restitution: 0.5}}}
analysis: {duration: 1, step: 0.01}
)");
  int jumps = 0;
  for (int k = 0; k < 10; ++k) {
    ASSERT_TRUE(bench.step.take(bench.state, 0.01, {}, {}).converged);
    jumps += bench.step.jumped() ? 1 : 0;
  }
  EXPECT_EQ(jumps, 1);
  EXPECT_NEAR(bench.system.motion(bench.state, 0).v.x(), -0.5, 1e-12);
  EXPECT_NEAR(bench.state.ledger.dissipated.value(), 0.5 * (1.0 - 0.25), 1e-12);
}

}  // namespace
}  // namespace polhode::single_step_tests
