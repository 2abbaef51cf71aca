// SPDX-License-Identifier: Apache-2.0
// Cascades of controllers, controllers switched and reset by events, anti-windup; loads of joints
// that are switched off.
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <polhode/core/format.hpp>
#include <support/run_text.hpp>

namespace polhode::test::switched_controllers_tests {
namespace {

/// A cart of 2 kg on a rail, with these controllers and events.
std::string cart(const std::string& controllers, const std::string& events, double h, double T,
                 const std::string& loads = "") {
  return format(R"(
format: 1
bodies: {{cart: {{mass: 2, inertia: [1, 1, 1]}}}}
joints: {{rail: {{type: prismatic, bodies: [ground, cart], at: [0, 0, 0], axis: x}}}}
loads:
  push: {{type: linear_motor, joint: rail, force: {{controller: c}}}}
  {}
controllers: {{{}}}
{}
analysis: {{type: dynamics, duration: {}, step: {}}}
output: {{hdf5: false}}
)",
                loads, controllers, events.empty() ? "" : format("events: {{{}}}", events), T, h);
}

double end_of(const std::string& text) {
  Simulation s = made(text);
  (void)finished(s);
  return s.body(0).r[0];
}

}  // namespace

// u = 5 (4 (w - x) - v), 2 x'' = u - 3 x - x', w = 1 then -0.5 from 1 s: x(2) by DOP853 with a
// tolerance of 1e-13.
// @tests{controller-steps}
TEST(Cascades, KeepTheirOrderWhereTheOuterSetpointJumps) {
  const auto x = [](double h) {
    return end_of(format(R"(
format: 1
bodies: {{s: {{mass: 2, inertia: [0.01, 0.01, 0.01]}}}}
joints: {{rail: {{type: prismatic, bodies: [ground, s], at: [0, 0, 0], axis: x}}}}
loads:
  f: {{type: linear_motor, joint: rail, force: {{controller: inner}}}}
  d: {{type: translational_spring, joint: rail, stiffness: 3, damping: 1}}
controllers:
  outer: {{joint: rail, channel: z, setpoint: {{table: [[0, 1], [1, -0.5]], interpolation: step}}, proportional: 4}}
  inner: {{joint: rail, channel: rate z, setpoint: {{controller: outer}}, proportional: 5}}
analysis: {{type: dynamics, duration: 2 s, step: {}}}
output: {{hdf5: false}}
)",
                         h));
  };
  const double truth = -0.7481772074;
  const double first = std::abs(x(8e-3) - truth), second = std::abs(x(4e-3) - truth);
  EXPECT_LT(first, 2e-4);
  EXPECT_NEAR(std::log2(first / second), 2.0, 0.3) << first << ' ' << second;
  EXPECT_LT(std::abs(x(8e-5) - truth), 2e-4 * first + 1e-9);
}

// Proportional control from x = 0 to 0.1: x = 0.1 (1 - cos ωt) with ω² = 50/2; off at 0.3 s the
// cart coasts, and from 0.5 s it swings about 0.1 again.
TEST(SwitchedControllers, HaveNoOutputWhileTheyAreOff) {
  const double w = 5.0, t = 0.3, gap = 0.2, rest = 0.4;
  const double x_off = 0.1 * (1.0 - std::cos(w * t)), v_off = 0.1 * w * std::sin(w * t);
  const double x_on = x_off + gap * v_off - 0.1;
  const double x = 0.1 + x_on * std::cos(w * rest) + v_off / w * std::sin(w * rest);
  const auto of = [](double h) {
    return end_of(cart("c: {joint: rail, channel: z, setpoint: 0.1, proportional: 50}",
                       "release: {at: 0.3, off: [c]}, catch: {at: 0.5, on: [c]}", h, 0.9));
  };
  const double first = std::abs(of(0.02) - x), second = std::abs(of(0.01) - x);
  EXPECT_NEAR(std::log2(first / second), 2.0, 0.4) << first << ' ' << second;
  EXPECT_LT(std::abs(of(2e-4) - x), 4e-4 * first + 1e-9);
}

// A sampled loop is a recurrence, satisfied to rounding: the sum of the integral restarts at the
// event.
TEST(SwitchedControllers, BeginAnewWhereTheyAreReset) {
  const double T = 0.04, m = 2.0, kp = 50.0, kd = 6.0, ki = 300.0;
  for (const bool off : {false, true}) {
    double x = 0.0, v = 0.0, sum = 0.0, last = 0.0, u = 0.0;
    for (int k = 0; k < 20; ++k) {
      const double e = 0.1 - x;
      if (k == 10) sum = 0.0;
      if (k > 0 && k != 10) sum += 0.5 * T * (e + last);
      last = e;
      u = kp * e + ki * sum - kd * v;
      if (off && k >= 8 && k < 10) u = 0.0;
      x += v * T + 0.5 * u / m * T * T;
      v += u / m * T;
    }
    for (const double h : {0.02, 0.003, 0.0002})
      EXPECT_NEAR(
          end_of(
              cart("c: {joint: rail, channel: z, setpoint: 0.1, proportional: 50, derivative: 6, "
                   "integral: 300, sample: 40 ms}",
                   off ? "a: {at: 0.32, off: [c]}, b: {at: 0.4, on: [c]}" : "a: {at: 0.4, on: [c]}",
                   h, 0.8)),
          x, 1e-12)
          << h << ' ' << off;
  }
}

// The motor is off for 0.5 s; the run from then on is that of a motor that is on from the start.
TEST(SwitchedControllers, DoNotWindUpWhileTheirMotorIsOff) {
  const std::string pi =
      "c: {joint: rail, channel: z, setpoint: 0.1, proportional: 50, integral: 60}";
  for (const double h : {0.02, 5e-3, 2e-4}) {
    const double late =
        end_of(cart(pi, "wait: {at: 0, off: [push]}, go: {at: 0.5, on: [push]}", h, 1.0));
    EXPECT_NEAR(late, end_of(cart(pi, "", h, 0.5)), 1e-10) << h;
  }
}

// The inner controller is at its limit of 0 and holds the cart at rest: the outer one's integral
// stays 0.
TEST(SwitchedControllers, DoNotWindUpWhileTheInnerOneIsLimited) {
  const auto text = [](double h) {
    return cart(
        "outer: {joint: rail, channel: z, setpoint: 0.1, proportional: 4, integral: 10}, "
        "c: {joint: rail, channel: rate z, setpoint: {controller: outer}, proportional: 5, "
        "maximum: 0}",
        "", h, 1.0);
  };
  for (const double h : {0.02, 5e-3, 2e-4}) {
    Simulation s = made(text(h));
    (void)finished(s);
    EXPECT_EQ(s.body(0).r[0], 0.0);
    EXPECT_NEAR(s.controller(0)[2], 0.4, 1e-12) << h;
  }
}

// A misspelt controller is told, with the names of all that can be switched.
TEST(SwitchedControllers, AreNamedInMessages) {
  expect_fault(cart("speed: {joint: rail, channel: z, proportional: 1}, c: {joint: rail, channel: "
                    "z, proportional: 1}",
                    "e: {at: 0, off: [sped]}", 0.01, 0.1),
               "unknown joint, load or controller 'sped'. Did you mean 'speed'?");
}

// A hinge breaks at 5 N: I = 0.27 about it, F² = (0.5 ω²)² + (0.5 α)² = 25 with α = 0.5/0.27. Its
// motor ends with it and the arm flies with constant spin; one that stays accelerates it by
// 0.5/0.02.
TEST(LoadsInJoints, EndWithTheJointThatBreaks) {
  const double alpha = 0.5 / 0.27;
  const double w = std::sqrt(2.0 * std::sqrt(25.0 - 0.25 * alpha * alpha)), t = w / alpha;
  for (const double h : {0.02, 5e-3, 5e-4})
    for (const bool stays : {false, true}) {
      Simulation s = made(format(R"(
format: 1
bodies: {{a: {{mass: 1, inertia: [0.02, 0.02, 0.02], position: [0.5, 0, 0]}}}}
joints: {{ja: {{type: revolute, bodies: [ground, a], at: [0, 0, 0], axis: z, breaks: {{force: 5}}}}}}
loads: {{m: {{type: rotary_motor, joint: ja, moment: 0.5{}}}}}
analysis: {{type: dynamics, duration: 3 s, step: {}}}
output: {{hdf5: false}}
)",
                                 stays ? ", stays: true" : "", h));
      const RunSummary r = finished(s);
      EXPECT_NEAR(r.events[0].time, t, 3.0 * h * h + 1e-9) << h;
      const double end = stays ? w + 0.5 / 0.02 * (3.0 - t) : w;
      EXPECT_NEAR(s.body(0).omega()[2], end, 2000.0 * h * h + 1e-9) << h << stays;
      EXPECT_LT(r.energy_drift, 1e-11);
    }
}

// Springs, dampers, servos and gears go with their joint, and come back with it.
TEST(LoadsInJoints, ComeBackWithTheirJoint) {
  const auto run = [](const std::string& loads, const std::string& events, double T = 1.0) {
    Simulation s = made(format(R"(
format: 1
bodies:
  a: {{mass: 1, inertia: [0.1, 0.1, 0.2], angular_velocity: [0, 0, 3]}}
  b: {{mass: 1, inertia: [0.1, 0.1, 0.2], position: [1, 0, 0]}}
joints:
  ja: {{type: revolute, bodies: [ground, a], at: [0, 0, 0], axis: z}}
  jb: {{type: revolute, bodies: [ground, b], at: [1, 0, 0], axis: z}}
loads: {{{}}}
events: {{{}}}
analysis: {{type: dynamics, duration: {}, step: 5 ms}}
output: {{hdf5: false}}
)",
                               loads, events, T));
    (void)finished(s);
    return std::pair(s.body(0).omega()[2], s.body(1).omega()[2]);
  };
  const std::string damper = "d: {type: torsional_spring, joint: ja, damping: 0.4}";
  // ω decays with 0.4/0.2 while the joint is closed.
  EXPECT_NEAR(run(damper, "open: {at: 0, off: [ja]}").first, 3.0, 1e-12);
  EXPECT_NEAR(run(damper, "open: {at: 0.2, off: [ja]}, close: {at: 0.6, on: [ja]}").first,
              3.0 * std::exp(-2.0 * 0.6), 1e-4);
  // An event that names the load governs it.
  EXPECT_NEAR(run(damper, "open: {at: 0.2, off: [ja, d]}, close: {at: 0.6, on: [ja]}").first,
              3.0 * std::exp(-2.0 * 0.2), 1e-4);
  // A gear ends with either joint, and the motor with its own: both wheels then keep their speeds.
  const std::string geared =
      "g: {type: gear, joints: [ja, jb], ratio: -1}, m: {type: rotary_motor, joint: ja, moment: "
      "0.4}";
  const auto early = run(geared, "open: {at: 0.5, off: [ja]}", 0.5);
  const auto late = run(geared, "open: {at: 0.5, off: [ja]}", 1.0);
  EXPECT_GT(early.first, 1.5);
  EXPECT_NEAR(std::abs(early.second), early.first, 1e-9);
  EXPECT_NEAR(late.first, early.first, 1e-9);
  EXPECT_NEAR(late.second, early.second, 1e-9);
}

}  // namespace polhode::test::switched_controllers_tests
