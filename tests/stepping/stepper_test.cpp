// SPDX-License-Identifier: Apache-2.0
// Steps of every kind on an oscillator of closed form: their ends, orders, tolerances and failures.
#include <polhode/stepping/stepper.hpp>

#include <cmath>
#include <cstring>
#include <memory>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <polhode/compile/build_system.hpp>
#include <polhode/engines/tree_engine.hpp>
#include <polhode/io/read/read_model.hpp>
#include <polhode/stepping/start.hpp>

namespace polhode::stepper_tests {
namespace {

using testing::HasSubstr;

/// 4 kg on a spring of 100 N/m: x = 0.3 cos(5 t) about 1.
constexpr const char* kOscillator = R"(
format: 1
bodies: {a: {mass: 4, inertia: [1, 1, 1], position: [1.3, 0, 0]}}
joints: {guide: {type: prismatic, bodies: [ground, a], at: [0, 0, 0], axis: x}}
loads: {s: {type: spring_damper, bodies: [ground, a], at: [[0, 0, 0], [1.3, 0, 0]], stiffness: 100, free_length: 1}}
analysis: {duration: 1, step: 0.1}
)";

StepControl fixed(double H, int order = 2, bool extrapolated = false) {
  StepControl control;
  control.step = H;
  control.order = order;
  control.extrapolated = extrapolated;
  return control;
}

struct Bench {
  explicit Bench(const StepControl& control, const char* text = kOscillator)
      : system(build_system(io::read_model_text(text, "m.yaml", {}))),
        state(system.initial_state()),
        stepper(system, std::make_unique<TreeEngine>(system),
                GeneralizedAlpha::from_spectral_radius(1.0), control, lane_kernels("automatic")) {
    (void)start(system, state, GeneralizedAlpha::from_spectral_radius(1.0), 0.01);
    stepper.begin(state);
  }
  /// Steps to a time. @returns their number
  int run_to(double until) {
    int steps = 0;
    while (state.t < until) {
      const StepReport r = stepper.advance(state, until);
      EXPECT_TRUE(r.accepted) << r.message;
      if (!r.accepted) break;
      EXPECT_EQ(r.t, state.t);
      rejected += r.rejected;
      ++steps;
    }
    return steps;
  }
  [[nodiscard]] double error() const {
    return std::abs(system.motion(state, 0).r.x() - 1.0 - 0.3 * std::cos(5.0 * state.t));
  }
  [[nodiscard]] double energy() const {
    const Balance b = stepper.balance(state);
    return b.kinetic + b.potential;
  }

  System system;
  State state;
  Stepper stepper;
  int rejected = 0;
};

TEST(Stepper, EndsAtTheLimitAndGoesBackToItsGrid) {
  Bench bench(fixed(0.1));
  double before = 0.0;
  while (bench.state.t < 0.75) {
    const StepReport r = bench.stepper.advance(bench.state, 0.75);
    ASSERT_TRUE(r.accepted) << r.message;
    EXPECT_EQ(r.rejected, 0);
    EXPECT_NEAR(r.t - before, r.dt, 1e-15);
    EXPECT_LE(r.dt, 0.1 * (1.0 + 1e-12));
    before = r.t;
  }
  EXPECT_EQ(bench.state.t, 0.75);
  for (const double next : {0.8, 0.9, 1.0}) {
    ASSERT_TRUE(bench.stepper.advance(bench.state, 10.0).accepted);
    EXPECT_NEAR(bench.state.t, next, 1e-15);
  }
}

/// Error after 2 s.
double error_of(const StepControl& control) {
  Bench bench(control);
  bench.run_to(2.0);
  return bench.error();
}

TEST(Stepper, HasTheOrderItIsAskedFor) {
  struct Case {
    int order;
    bool extrapolated;
    double coarse;
  };
  for (const Case& c :
       {Case{2, false, 0.02}, Case{4, false, 0.1}, Case{6, false, 0.1}, Case{8, false, 0.2},
        Case{4, true, 0.1}, Case{6, true, 0.2}, Case{8, true, 0.2}}) {
    const double coarse = error_of(fixed(c.coarse, c.order, c.extrapolated)),
                 fine = error_of(fixed(c.coarse / 2, c.order, c.extrapolated));
    EXPECT_NEAR(std::log2(coarse / fine), c.order, 0.35)
        << c.order << (c.extrapolated ? " extrapolated " : " composed ") << coarse << ' ' << fine;
  }
}

// The phase of a step with the conserving rule is 2 atan(ωH/2).
TEST(Stepper, MovesAnOscillatorByTheArctangentOfItsStep) {
  for (const double H : {0.2, 0.05, 0.005}) {
    Bench bench(fixed(H));
    const int steps = bench.run_to(1.0);
    EXPECT_NEAR(bench.system.motion(bench.state, 0).r.x(),
                1.0 + 0.3 * std::cos(2.0 * steps * std::atan(2.5 * H)), 1e-11)
        << H;
    EXPECT_NEAR(bench.energy(), 0.5 * 100 * 0.09, 1e-12) << H;
  }
}

TEST(Stepper, MeetsItsToleranceWithAutomaticSteps) {
  int last = 0;
  for (const double tolerance : {1e-3, 1e-5, 1e-7}) {
    StepControl control = fixed(0.0, 6, true);
    control.step.reset();
    control.tolerance = tolerance;
    control.horizon = 2.0;
    Bench bench(control);
    const int steps = bench.run_to(2.0);
    EXPECT_EQ(bench.state.t, 2.0);
    // The tolerance is that of one step, relative to the model's size.
    EXPECT_LT(bench.error(), 30.0 * tolerance * bench.system.length_scale()) << tolerance;
    EXPECT_GT(steps, last) << tolerance;
    last = steps;
  }
}

TEST(Stepper, DoesNotExceedItsLongestStep) {
  StepControl control;
  control.tolerance = 0.1;
  control.horizon = 2.0;
  control.max_step = 0.03;
  Bench bench(control);
  while (bench.state.t < 1.0) {
    const StepReport r = bench.stepper.advance(bench.state, 1.0);
    ASSERT_TRUE(r.accepted) << r.message;
    EXPECT_LE(r.dt, 0.03 * (1.0 + 1e-12));
  }
}

// Steps are cut where Newton's method has too few iterations, down to the shortest one; then the
// state is as it was, and the message says what to do.
TEST(Stepper, LeavesTheStateAfterAFailureAndSaysWhere) {
  const char* pendulum = R"(
format: 1
gravity: [0, 0, -9.81]
bodies: {rod: {mass: 2, inertia: [0.2, 0.3, 0.1], position: [1, 0, 0]}}
joints: {j: {type: revolute, bodies: [ground, rod], at: [0, 0, 0], axis: y}}
analysis: {duration: 1, step: 0.1}
)";
  StepControl control = fixed(0.1);
  control.min_step = 0.02;
  control.newton.max_iterations = 1;
  Bench bench(control, pendulum);
  const State before = bench.state;
  const StepReport r = bench.stepper.advance(bench.state, 1.0);
  EXPECT_FALSE(r.accepted);
  EXPECT_GT(r.rejected, 1);
  EXPECT_THAT(r.message, HasSubstr("body 'rod'"));
  EXPECT_EQ(bench.state.t, before.t);
  EXPECT_EQ(std::memcmp(bench.state.blocks.data(), before.blocks.data(),
                        before.blocks.size() * sizeof(BodyBlock)),
            0);
  // With enough iterations the same state goes on.
  Bench other(fixed(0.1), pendulum);
  other.state = bench.state;
  other.stepper.leave();
  EXPECT_TRUE(other.stepper.advance(other.state, 1.0).accepted);
}

// A run from a stored state is that of one in one go, bit for bit.
TEST(Stepper, ContinuesFromAnotherStateAfterLeaving) {
  Bench bench(fixed(0.05));
  bench.run_to(0.5);
  const State middle = bench.state;
  bench.run_to(1.0);
  const State end = bench.state;
  bench.state = middle;
  bench.stepper.leave();
  bench.run_to(1.0);
  EXPECT_EQ(std::memcmp(bench.state.blocks.data(), end.blocks.data(),
                        end.blocks.size() * sizeof(BodyBlock)),
            0);
  EXPECT_EQ(bench.state.ledger.iterations, end.ledger.iterations);
}

}  // namespace
}  // namespace polhode::stepper_tests
