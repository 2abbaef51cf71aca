// SPDX-License-Identifier: Apache-2.0
// Inerters against closed forms: accelerations, momentum, energy, stops, orders, modes, messages.
#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/simulation/modal.hpp>
#include <validation/connector_runs.hpp>

namespace polhode::inerter_tests {

using connectors::kPi, connectors::kSteps, connectors::Outcome, connectors::run, connectors::slider,
    connectors::Step, connectors::step_of;
using ::testing::HasSubstr;

/// Rounding of sums over a run.
constexpr double kRounding = 1e-12;

// A constant force along a slide, and a rate at the start: x = v t + F t² / (2 (m + b)), exact at
// every step.
// @tests{inerter}
TEST(Inerters, AddToTheMassAlongASlide) {
  for (const Step& s : kSteps) {
    const Outcome o = run(slider("type: linear_inerter, inertance: 3 kg}, push: {type: "
                                 "linear_motor, joint: rail, force: 10 N",
                                 "1", ", velocity: [0.5, 0, 0]"),
                          {step_of(s)});
    EXPECT_NEAR(o.body(0).r.x(), 0.8 + 0.5 + 0.5 * 10.0 / 5.0, kRounding) << s.text;
    EXPECT_NEAR(o.body(0).v.x(), 0.5 + 10.0 / 5.0, kRounding) << s.text;
    EXPECT_NEAR(o.load[0], -3.0 * 2.0, 1e-10) << s.text;  // On the cart.
    EXPECT_NEAR(o.load[5], 0.5 * 3.0 * 2.5 * 2.5, kRounding) << s.text;
    EXPECT_LT(o.summary.energy_drift, kRounding) << s.text;
  }
}

// Two free bodies in a slide: the force is internal, their momentum remains, and the relative
// acceleration is F over the reduced mass and the inertance.
TEST(Inerters, ActEquallyOnBothBodies) {
  for (const Step& s : kSteps) {
    const Outcome o = run(R"(
format: 1
variables: {h: 2 ms}
bodies:
  one: {mass: 2, inertia: [1, 1, 1]}
  two: {mass: 6, inertia: [1, 1, 1], position: [1, 0, 0]}
joints: {rail: {type: prismatic, bodies: [one, two], at: [0, 0, 0], axis: x}}
loads:
  it: {type: linear_inerter, joint: rail, inertance: 0.5 kg}
  push: {type: linear_motor, joint: rail, force: 4 N}
analysis: {duration: 1 s, step: h}
output: {hdf5: false}
)",
                          {step_of(s)});
    const double apart = 4.0 / (1.5 + 0.5);
    EXPECT_NEAR(o.body(1).v.x() - o.body(0).v.x(), apart, kRounding) << s.text;
    EXPECT_NEAR(2.0 * o.body(0).v.x() + 6.0 * o.body(1).v.x(), 0.0, kRounding) << s.text;
  }
}

std::string pendulum(const std::string& analysis, const std::string& more = "") {
  return format(R"(
format: 1
gravity: [0, -9.81, 0]
bodies: {{bob: {{mass: 2, inertia: [0.1, 0.1, 0.1], position: [0.5, 0, 0], velocity: [0, 0.4, 0], angular_velocity: [0, 0, 0.8]}}}}
joints: {{pin: {{type: revolute, bodies: [ground, bob], at: [0, 0, 0], axis: z{}}}}}
loads: {{it: {{type: rotary_inerter, joint: pin, inertance: 0.7 kg*m^2}}, drive: {{type: rotary_motor, joint: pin, moment: 0}}}}
analysis: {{{}}}
output: {{hdf5: false}}
)",
                more, analysis);
}

// The energy (J + m l² + b) q̇² / 2 + m g y of a pendulum, whose rate at the start is kept.
TEST(Inerters, APendulumMovesByItsEnergyAtEveryOrder) {
  const double inertia = 0.1 + 2.0 * 0.25 + 0.7;
  for (const int order : {2, 4, 6})
    for (const double h : {0.01, 1e-3, 1e-4}) {
      if (order > 2 && h < 1e-3) continue;
      const Outcome o = run(pendulum(format("duration: 0.7 s, step: {}, order: {}", h, order)));
      EXPECT_LT(o.summary.energy_drift, kRounding) << h;
      const double rate = o.body(0).W.z();
      const double error = 0.5 * inertia * (rate * rate - 0.64) + 2.0 * 9.81 * o.body(0).r.y();
      // Rates at the ends of steps are of second order at ρ∞ = 1.
      EXPECT_NEAR(error, 0.0, order == 2 ? 400.0 * h * h : 5e3 * std::pow(h, order) + 1e-11)
          << h << " " << order;
    }
}

// A body whose axes are not those of the world starts with the rate that its angular velocity
// gives.
TEST(Inerters, KeepTheRateOfTheStart) {
  for (const Step& s : kSteps) {
    const Outcome o = run(R"(
format: 1
variables: {h: 2 ms}
bodies: {wheel: {mass: 2, inertia: [0.1, 0.2, 0.3], orientation: {axis: [1, 1, 0], angle: 70 deg}, angular_velocity: [0, 0, 0.8]}}
joints: {pin: {type: revolute, bodies: [ground, wheel], at: [0, 0, 0], axis: z}}
loads: {it: {type: rotary_inerter, joint: pin, inertance: 0.7 kg*m^2}}
analysis: {duration: 1 s, step: h}
output: {hdf5: false}
)",
                          {step_of(s)});
    EXPECT_NEAR(o.load[4], 0.8, kRounding) << s.text;
    EXPECT_NEAR(o.load[3], 0.8, s.h * s.h) << s.text;  // Rates at the ends of steps: order 2.
    EXPECT_LT(o.summary.energy_drift, kRounding) << s.text;
  }
}

// Without gravity the stop of a hinge takes the energy of both; with e = 1 the rate is reversed.
TEST(Inerters, BounceWithTheirJoint) {
  for (const char* h : {"20 ms", "2 ms", "0.2 ms"}) {
    const Outcome o = run(pendulum(format("duration: 1 s, step: {}", h),
                                   ", limits: {lower: -1 rad, upper: 0.3 rad, restitution: 1}"),
                          {"gravity=[0, 0, 0]"});
    EXPECT_NEAR(o.body(0).W.z(), -0.8, 1e-5) << h;  // The stop's own accuracy.
    EXPECT_LT(o.summary.energy_drift, 1e-9) << h;
  }
}

// Acceleration at the start, before any step: M / (J + b).
TEST(Inerters, CountInAccelerationsAtAnInstant) {
  Simulation s(io::read_model_text(pendulum("duration: 1 s, step: 1 ms"), "inerter.yaml",
                                   {"gravity=[0, 0, 0]", "loads.drive.moment=2.6"}));
  EXPECT_NEAR(s.body("bob").A.z(), 2.6 / 1.3, kRounding);
}

// ω² = m g l / (J + m l² + b) of the hanging pendulum; equilibria do not feel it.
TEST(Inerters, LowerFrequenciesAndLeaveEquilibriaAlone) {
  const std::string hanging = R"(
format: 1
gravity: [0, -9.81, 0]
bodies: {bob: {mass: 2, inertia: [0.1, 0.1, 0.1], position: [0, -0.5, 0]}}
joints: {pin: {type: revolute, bodies: [ground, bob], at: [0, 0, 0], axis: z}}
loads: {it: {type: rotary_inerter, joint: pin, inertance: 0.7 kg*m^2}}
analysis: {type: modes}
output: {hdf5: false}
)";
  const ModalAnalysis modes(io::read_model_text(hanging, "inerter.yaml"));
  EXPECT_TRUE(modes.converged()) << modes.message();
  ASSERT_EQ(modes.report().modes.size(), 1U);
  EXPECT_NEAR(2.0 * kPi * modes.report().modes[0].frequency, std::sqrt(2.0 * 9.81 * 0.5 / 1.3),
              1e-9);
}

TEST(Inerters, AreRefusedWhereTheyCannotAct) {
  const auto fault = [](const std::string& text, const io::Overrides& overrides) -> std::string {
    try {
      Simulation s(io::read_model_text(text, "inerter.yaml", overrides));
    } catch (const std::exception& e) {
      return e.what();
    }
    return "none";
  };
  const std::string model = pendulum("duration: 1 s, step: 1 ms");
  EXPECT_THAT(fault(model, {"loads.it.inertance=0"}), HasSubstr("loads.it.inertance"));
  EXPECT_THAT(fault(model, {"events.stop={at: 0.5, off: [it]}"}),
              HasSubstr("'it' is a rotary_inerter, which cannot be switched"));
  EXPECT_THAT(fault(model, {"events.stop={at: 0.5, off: [pin]}"}),
              HasSubstr("'pin' is in the rotary_inerter 'it', so it cannot be switched or break"));
  EXPECT_THAT(fault(model, {"loads.it.type=linear_inerter", "loads.it.inertance=1"}),
              HasSubstr("does not have exactly one free displacement"));
}

}  // namespace polhode::inerter_tests
