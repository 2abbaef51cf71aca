// SPDX-License-Identifier: Apache-2.0
// Ends of steps that coincide up to round-off: events, kinks, outputs, samples, ends of runs. No
// step is shorter than what the arithmetic resolves.
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include <polhode/core/format.hpp>
#include <support/run_text.hpp>

namespace polhode::test::step_ends_tests {
namespace {

/// An arm driven by a motor, with a bob on it; an event on its angle switches a force off.
std::string driven_arm(const std::string& angle, double level, const std::string& analysis,
                       const std::string& more = "") {
  return R"(
format: 1
gravity: [0, 0, -9.81]
bodies:
  arm: {mass: 2, inertia: [0.1, 0.2, 0.2], position: [0.5, 0, 0]}
  bob: {mass: 1, inertia: [0.01, 0.01, 0.01], position: [1, 0, -0.7]}
joints:
  base: {type: revolute, bodies: [ground, arm], at: [0, 0, 0], axis: z}
  pin: {type: revolute, bodies: [arm, bob], at: [1, 0, 0], axis: y}
loads:
  drive: {type: rotary_motor, joint: base, angle: )" +
         angle + R"(}
  push: {type: force, body: bob, force: [1, 0, 0]}
events:
  off: {when: {joint: base, channel: rz, above: )" +
         format("{:.17g}", level) + R"(}, off: [push]}
analysis: {type: dynamics, )" +
         analysis + "}\n" + more;
}

/// Checks the time of the event, and that balances close: a step of no length loses the energy to
/// round-off over its length.
void expect_event(const std::string& text, double time, double accuracy) {
  Simulation s = made(text);
  const RunSummary r = finished(s);
  ASSERT_EQ(r.events.size(), 1u);
  EXPECT_EQ(r.events[0].count, 1) << text;
  EXPECT_NEAR(r.events[0].time, time, accuracy) << text;
  EXPECT_LT(r.energy_drift, 1e-10) << text;
  EXPECT_LT(r.velocity_constraint_residual_max, 0.05) << text;
}

}  // namespace

// @tests{shortest-step}
TEST(StepEnds, AreOneWhereAnEventMeetsAKink) {
  for (const double h : {5e-3, 5.1e-3, 5e-4, 5e-5})
    for (const auto& [kink, level] :
         {std::pair{0.0692, 0.124}, std::pair{0.1, 0.2}, std::pair{0.03, 0.021}})
      expect_event(driven_arm(format("{{table: [[0, 0], [{0}, {1}], [1, 2]]}}", kink, level), level,
                              format("duration: {} s, step: {}", h < 1e-4 ? 0.15 : 1.0, h)),
                   kink, 1e-12);
}

TEST(StepEnds, AreOneWhereAnEventMeetsAnOutput) {
  for (const char* how :
       {"step: auto, tolerance: 1e-4", "step: auto, tolerance: 1e-6", "step: auto, tolerance: 1e-8",
        "step: auto, tolerance: 1e-6, order: 2", "step: 20 ms", "step: 5 ms", "step: 0.05 ms"})
    for (const double level : {0.04, 0.28, 0.56, 1.12, 1.9})
      expect_event(driven_arm("\"2*t\"", level, format("duration: 1 s, {}", how),
                              "output: {every: 10 ms, hdf5: false}\n"),
                   0.5 * level, 1e-9);
}

TEST(StepEnds, AreOneWhereAnEventMeetsASample) {
  for (const double level : {0.06, 0.28, 0.56})
    for (const double h : {5e-3, 2e-3, 5e-5})
      expect_event(
          driven_arm(
              "\"2*t\"", level, format("duration: 0.4 s, step: {}", h),
              "controllers: {c: {joint: pin, channel: rz, proportional: 1, sample: 10 ms}}\n"),
          0.5 * level, 1e-9);
}

// A body falls through 1 m in sqrt(2/g); another condition is nearly met all the time.
TEST(StepEnds, OfTwoEventsAreLocatedEachByItself) {
  for (const char* idle : {"1", "1e-6", "1e-9", "1e-12"})
    for (const char* step : {"step: 70 ms", "step: 7 ms", "step: 0.07 ms", "tolerance: 1e-8"}) {
      Simulation s = made(format(R"(
format: 1
gravity: [0, 0, -9.81]
bodies:
  ball: {{mass: 1, point_mass: true}}
  wheel: {{mass: 1, inertia: [0.1, 0.1, 0.1], position: [1, 0, 0]}}
joints: {{axle: {{type: revolute, bodies: [ground, wheel], at: [1, 0, 0], axis: z}}}}
events:
  idle: {{when: {{joint: axle, channel: rate rz, above: {}}}, stop: true}}
  down: {{when: {{body: ball, channel: z, below: -1}}, stop: true}}
analysis: {{type: dynamics, duration: 1 s, {}}}
)",
                                 idle, step));
      const RunSummary r = finished(s);
      EXPECT_EQ(r.events[0].count, 0);
      EXPECT_NEAR(r.events[1].time, std::sqrt(2.0 / 9.81), 2e-13) << idle << ' ' << step;
    }
}

// Everything happens within a tiny part of the step: one step, of that length.
TEST(StepEnds, OfARunFarShorterThanItsStep) {
  for (const char* duration : {"1e-15", "1e-12", "1e-10", "1e-8", "1e-3"}) {
    Simulation s = made(
        format("{{format: 1, bodies: {{a: {{mass: 1, inertia: [1, 1, 1], velocity: [3, 0, 0]}}}}, "
               "analysis: {{duration: {}, step: 1}}}}",
               duration));
    const RunSummary r = finished(s);
    const double T = std::stod(duration);
    EXPECT_DOUBLE_EQ(r.t, T);
    EXPECT_EQ(r.steps, 1);
    EXPECT_NEAR(s.body(0).r[0], 3.0 * T, 1e-12 * T);
  }
}

// Whoever asks for ends of steps by himself comes to each of them, and no step is shorter than
// resolved.
TEST(StepEnds, GivenByTheUserAreReached) {
  for (const char* how : {"step: 5 ms", "tolerance: 1e-6", "tolerance: 1e-6, order: 2"}) {
    Simulation s = made(driven_arm("\"2*t\"", 0.5, format("duration: 1 s, {}", how)));
    for (const double t : {0.1, std::nextafter(0.1, 1.0), 0.1 + 1e-15, 0.1 + 1e-12, 0.2, 0.3})
      while (s.time() < t) ASSERT_TRUE(s.step(t).accepted);
    EXPECT_EQ(s.time(), 0.3);
    EXPECT_LT(s.summary().energy_drift, 1e-9) << how;
  }
}

// A run that ends where an event is due, and one that goes on from there.
TEST(StepEnds, OfARunIsThatOfItsEvent) {
  for (const auto& [level, step] :
       {std::pair{0.28, "20 ms"}, std::pair{0.06, "5 ms"}, std::pair{0.28, "5 ms"},
        std::pair{0.56, "5 ms"}, std::pair{0.28, "0.05 ms"}}) {
    const auto text = [&, level = level, step = step](double T) {
      return driven_arm("\"2*t\"", level, format("duration: {} s, step: {}", T, step));
    };
    Simulation whole = made(text(0.4));
    (void)finished(whole);
    Simulation first = made(text(0.5 * level));
    (void)finished(first);
    Simulation second(io::read_model_text(text(0.4), "model.yaml"), first.state());
    const RunSummary r = finished(second);
    EXPECT_EQ(r.events[0].count, 1);
    EXPECT_LT(r.energy_drift, 1e-10);
    EXPECT_NEAR((second.body(1).r - whole.body(1).r).norm(), 0.0, 1e-9) << level;
  }
}

// A smooth pulse of unit impulse on a unit mass is never passed over: v = 1 behind it. The run's
// tolerance bounds the error of positions, so that of the velocity is looser by the time behind the
// pulse.
// @tests{sampled-loads}
TEST(StepEnds, ResolveASmoothPulse) {
  for (const char* width : {"0.1", "1e-2", "3e-4", "1e-4", "1e-6"})
    for (const char* how : {"tolerance: 1e-6", "tolerance: 1e-9", "tolerance: 1e-6, order: 2"}) {
      Simulation s = made(format(R"yaml(
format: 1
variables: {{w: {}}}
bodies: {{a: {{mass: 1, inertia: [0.1, 0.2, 0.3]}}}}
loads: {{f: {{type: force, body: a, force: ["1/(w*sqrt(pi))*exp(-((t-5.3)/w)^2)", 0, 0]}}}}
analysis: {{duration: 10 s, {}}}
)yaml",
                                 width, how));
      (void)finished(s);
      EXPECT_NEAR(s.body(0).v[0], 1.0, 1e-3) << width << ' ' << how;
    }
}

}  // namespace polhode::test::step_ends_tests
