// SPDX-License-Identifier: Apache-2.0
// Summary of a run: estimated errors, warnings, drifts of models at rest.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include <polhode/io/read/read_model.hpp>
#include <polhode/simulation/simulation_details.hpp>

namespace polhode::run_errors_tests {
namespace {

RunSummary run(const std::string& text, const io::Overrides& overrides = {}) {
  Simulation s(io::read_model_text(text, "run.yaml", overrides));
  const RunSummary r = s.run();
  EXPECT_EQ(r.end, RunEnd::finished) << r.message;
  return r;
}

bool warns(const RunSummary& r, const std::string& part) {
  return std::any_of(r.warnings.begin(), r.warnings.end(),
                     [&](const std::string& w) { return w.find(part) != std::string::npos; });
}

// A mass on a spring: x = a cos ωt, so that a step errs by Δt³ a ω³/12 at most.
constexpr const char* kSpring = R"(
format: 1
variables: {h: 1 ms}
bodies: {mass: {mass: 1, inertia: [1, 1, 1], position: [0.1, 0, 0]}}
joints: {guide: {type: prismatic, bodies: [ground, mass], at: [0, 0, 0], axis: x}}
loads: {spring: {type: spring_damper, bodies: [ground, mass], at: [[-1, 0, 0], [0.1, 0, 0]], stiffness: 400, free_length: 1}}
analysis: {type: dynamics, duration: 1 s, step: h}
output: {hdf5: false}
)";

// @tests{step-error}
TEST(RunErrors, OfAnOscillatorAreThoseOfTheMidpointRule) {
  for (const double h : {0.01, 1e-3, 1e-4}) {
    Simulation s(io::read_model_text(kSpring, "run.yaml", {"variables.h=" + std::to_string(h)}));
    const RunSummary r = s.run();
    ASSERT_TRUE(r.errors);
    const double length = s.system().length_scale();
    EXPECT_NEAR(r.errors->largest, h * h * h * 0.1 * 8000.0 / 12.0 / length,
                0.05 * r.errors->largest)
        << h;
    // The sum over a second, with |sin| in the mean.
    EXPECT_NEAR(r.errors->sum, h * h * 0.1 * 8000.0 / 12.0 / length * 2.0 / std::numbers::pi,
                0.1 * r.errors->sum)
        << h;
    EXPECT_EQ(r.errors->whose, "body 'mass'");
    EXPECT_EQ(r.errors->steps, r.steps - 2);
    EXPECT_TRUE(r.warnings.empty());
  }
}

// A pole of 1 g on a cart of 1 kg, with its centre of mass 1 mm above the hinge: it turns over in a
// few steps.
constexpr const char* kPole = R"(
format: 1
gravity: [0, 0, -9.81]
variables: {h: 10 ms}
bodies:
  cart: {mass: 1, inertia: [1, 1, 1], position: [0, 0, 0]}
  pole: {mass: 1 g, inertia: [1e-9, 1e-9, 1e-9], position: [0, 0, 0.001], angular_velocity: [0, 20, 0], velocity: [0.02, 0, 0]}
joints:
  rail: {type: prismatic, bodies: [ground, cart], at: [0, 0, 0], axis: x}
  hinge: {type: revolute, bodies: [cart, pole], at: [0, 0, 0], axis: y}
analysis: {type: dynamics, duration: 2 s, step: h}
output: {hdf5: false}
)";

TEST(RunErrors, StepsTooLongForTheMotionAreReported) {
  const RunSummary coarse = run(kPole);
  ASSERT_TRUE(coarse.errors);
  EXPECT_GT(coarse.errors->largest, 1e-2);
  EXPECT_TRUE(
      warns(coarse, "steps are too long for the motion: the estimated error of body 'pole'"));
  const RunSummary fine = run(kPole, {"variables.h=0.1 ms"});
  EXPECT_LT(fine.errors->largest, 1e-4);
  EXPECT_TRUE(fine.warnings.empty()) << fine.warnings.front();
}

// Round-off over round-off is no drift. @tests{drift-floor}
TEST(RunErrors, BodiesAtRestDoNotDrift) {
  for (const char* step : {"10 ms", "1 ms", "0.1 ms"}) {
    const RunSummary r = run(R"(
format: 1
gravity: [0, 0, -9.81]
bodies:
  arm: {mass: 2, inertia: [1, 1, 1], position: [3, 0, 5]}
  bob: {mass: 1, inertia: [1, 1, 1], position: [3, 0, 4]}
joints:
  wall: {type: revolute, bodies: [ground, arm], at: [3, 0, 5.5], axis: y}
  hook: {type: spherical, bodies: [arm, bob], at: [3, 0, 4.5]}
analysis: {type: dynamics, duration: 1 s, step: 1 ms}
output: {hdf5: false}
)",
                             {std::string("analysis.step=") + step});
    EXPECT_LT(r.energy_drift, 1e-10) << step;
    EXPECT_LT(r.linear_momentum_drift, 1e-10) << step;
    EXPECT_LT(r.angular_momentum_drift, 1e-10) << step;
  }
}

// Two wheels about fixed centres of mass have no momentum, and bearings of 1 kN that cancel: their
// round-off is no drift. @tests{drift-floor}
TEST(RunErrors, BearingsThatCancelDoNotDrift) {
  for (const char* step : {"10 ms", "1 ms", "0.1 ms"}) {
    const RunSummary r = run(R"yaml(
format: 1
bodies:
  one: {mass: 2, inertia: [1, 1, 1]}
  two: {mass: 1, inertia: [1, 1, 1], position: [0.3, 0, 0]}
joints:
  a: {type: revolute, bodies: [ground, one], at: [0, 0, 0], axis: z}
  b: {type: revolute, bodies: [ground, two], at: [0.3, 0, 0], axis: z}
loads:
  teeth: {type: gear, joints: [a, b], ratio: -2}
  engine: {type: rotary_motor, joint: a, angle: "sin(20*t)"
  }
analysis : {
type:
  dynamics, duration : 1 s, step : 1 ms
}
output : {
hdf5:
  false
}
)yaml",
                             {std::string("analysis.step=") + step});
    EXPECT_LT(r.linear_momentum_drift, 1e-9) << step;
    EXPECT_LT(r.angular_momentum_drift, 1e-9) << step;
    EXPECT_LT(r.energy_drift, 1e-9) << step;
  }
}

// An impact with a given stiffness lasts 3 ms: steps of 1 ms do not resolve its force.
TEST(RunErrors, ImpactsWithTooFewStepsAreReported) {
  const char* text = R"(
format: 1
gravity: [0, 0, -9.81]
bodies:
  ball: {shape: {sphere: {diameter: 0.2}}, mass: 1, position: [0, 0, 0.3]}
  floor: {fixed: true, shape: {plane: z}}
contacts: {default: {law: linear, stiffness: 1e6, restitution: 0.5}}
analysis: {type: dynamics, duration: 0.4 s, step: 1 ms}
output: {hdf5: false}
)";
  EXPECT_TRUE(warns(run(text), "impacts took fewer than twenty steps"));
  EXPECT_FALSE(warns(run(text, {"analysis.step=0.05 ms"}), "fewer than twenty steps"));
}

// A guide that is too short for its friction: the moment of a force causes more friction than the
// force itself overcomes.
TEST(RunErrors, NamesTheJointWhoseFrictionLocksIt) {
  Simulation s(io::read_model_text(R"(
format: 1
gravity: [0, 0, 0]
bodies:
  slider: {mass: 1, inertia: [0.01, 0.01, 0.01], position: [0, 0.06, 0], velocity: [1, 0, 0]}
joints:
  guide:
    {type: prismatic, bodies: [ground, slider], at: [0, 0, 0], axis: x,
     friction: {mu: 0.2, radius: 0.01}}
loads: {push: {type: force, body: slider, force: [0, 0, 3]}}
analysis: {type: dynamics, duration: 0.3 s, step: 10 ms, min_step: 10 ms}
output: {hdf5: false}
)",
                                   "run.yaml"));
  const RunSummary end = s.run();
  EXPECT_EQ(end.end, RunEnd::not_converged);
  EXPECT_NE(end.message.find("friction or a stop that locks joint 'guide'"), std::string::npos)
      << end.message;
}

}  // namespace
}  // namespace polhode::run_errors_tests
