// SPDX-License-Identifier: Apache-2.0
// Resistances that jump with the rate, such as a cutting force or dry friction, against closed
// forms.
#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include <polhode/core/format.hpp>
#include <polhode/loads/force_law.hpp>
#include <support/run_text.hpp>

namespace polhode::test::law_jumps_tests {
namespace {

constexpr double kWidth = 1e-9;  ///< Of a jump, as documented [m/s or rad/s].

/// A tool of 2 kg on a slide with a resistance and a force.
std::string tool(const std::string& load, const std::string& force, double v, double T, double h) {
  return format(R"yaml(
format: 1
bodies: {{tool: {{mass: 2, inertia: [1, 1, 1], velocity: [{}, 0, 0], position: [1, 0, 0]}}}}
joints: {{slide: {{type: prismatic, bodies: [ground, tool], at: [0, 0, 0], axis: x}}}}
loads:
  cut: {}
  drive: {{type: force, body: tool, force: ["{}", 0, 0]}}
analysis: {{type: dynamics, duration: {}, step: {}}}
output: {{hdf5: false}}
)yaml",
                v, load, force, T, h);
}

/// A law of the slide's rate, as a spring of the joint and as a damper between two points.
std::vector<std::string> both_kinds(const std::string& law) {
  return {"{type: translational_spring, joint: slide, damper_force: \"" + law + "\"}",
          "{type: spring_damper, bodies: [ground, tool], at: [[0, 0, 0], [1, 0, 0]], stiffness: 0, "
          "damper_force: \"" +
              law + "\"}"};
}

void step_to(Simulation& s, double t) {
  while (s.time() < t) ASSERT_TRUE(s.step(t).accepted);
}

RunSummary settled(Simulation& s) {
  const RunSummary r = finished(s);
  EXPECT_EQ(r.rejected_steps, 0);
  EXPECT_LT(r.linear_momentum_drift, 1e-12);
  EXPECT_LT(r.energy_drift, 1e-11);  // round-off of up to 1e4 steps
  return r;
}

}  // namespace

// Forwards against 1500 + 500 N to rest, then back with 500 N: v = -250 (T - t_1), t_1 = v_0/1000.
// Balances hold to round-off at any step; in the step of the crossing the side is that of its end,
// so that the impulse misses less than that of the jump in a step.
// @tests{law-jump}
TEST(LawJumps, OfACuttingForceLoseNoMomentum) {
  const double v_0 = 3.3, T = 0.01, t_1 = v_0 / 1000.0;
  const double x = 0.5 * v_0 * t_1 - 125.0 * (T - t_1) * (T - t_1);
  for (const std::string& load : both_kinds("v > 0 ? 1500 : 0"))
    for (const double h : {5e-3, 5e-4, 5e-5}) {
      Simulation s = made(tool(load, "-500", v_0, T, h));
      settled(s);
      EXPECT_NEAR(s.body(0).v[0], -250.0 * (T - t_1), 750.0 * h) << h;
      EXPECT_NEAR(s.body(0).r[0] - 1.0, x, 750.0 * h * T) << h;
    }
}

// A tool that swings crosses the jump twice a period, at any phase of its steps.
TEST(LawJumps, OfAnOscillationRejectNoStep) {
  for (const std::string& load : both_kinds("v > 0 ? 1500 : 0"))
    for (const double h : {1e-3, 1e-4, 1e-5}) {
      Simulation s = made(tool(load, "4000*sin(300*t)", 0.0, 0.1, h));
      settled(s);
    }
}

// 100 N against 50 N: at rest after v_0²/2a = 0.02 m, a = 25 m/s², where it stays. The step in
// which it comes to rest is as long as the others, an error of a h²/8 at most.
// @tests{law-jump}
TEST(LawJumps, HoldWhatTheyCanHold) {
  for (const std::string& load : both_kinds("100*sign(v)"))
    for (const double h : {1e-2, 1e-3, 1e-4}) {
      Simulation s = made(tool(load, "50", 1.0, 0.5, h));
      step_to(s, 0.1);
      const double at = s.body(0).r[0];
      EXPECT_NEAR(at, 1.02, 25.0 * h * h / 8.0 + 1e-12) << h;
      settled(s);
      EXPECT_NEAR(s.body(0).r[0], at, 0.4 * kWidth) << h;
      EXPECT_NEAR(s.body(0).v[0], 0.0, kWidth) << h;
      EXPECT_NEAR(s.load("cut")[0], -50.0, 1e-9) << h;
    }
}

// A force of 200 t N against 100 N: at rest up to 0.5 s, then v = 50 (t - 0.5)².
TEST(LawJumps, LetGoWhatTheyCannotHold) {
  for (const std::string& load : both_kinds("100*sign(v)"))
    for (const double h : {1e-2, 1e-3, 1e-4}) {
      Simulation s = made(tool(load, "200*t", 0.0, 1.0, h));
      step_to(s, 0.4);
      EXPECT_NEAR(s.body(0).r[0], 1.0, 0.4 * kWidth) << h;
      settled(s);
      EXPECT_NEAR(s.body(0).v[0], 12.5, 25.0 * h * h) << h;
      EXPECT_NEAR(s.body(0).r[0], 1.0 + 50.0 / 24.0, 25.0 * h * h) << h;
    }
}

// A law that falls from 100 to 60 N at 0.1 m/s, against 80 N: the tool stops from below, and runs
// away from above.
TEST(LawJumps, MayFall) {
  const std::string law = "(abs(v) < 0.1 ? 100 : 60)*sign(v)";
  for (const std::string& load : both_kinds(law))
    for (const double h : {1e-2, 1e-3, 1e-4}) {
      Simulation stops = made(tool(load, "80", 0.05, 0.1, h));
      settled(stops);
      EXPECT_NEAR(stops.body(0).r[0], 1.0 + 0.05 * 0.05 / 20.0, 10.0 * h * h / 8.0 + 1e-10) << h;
      EXPECT_NEAR(stops.body(0).v[0], 0.0, kWidth) << h;
      Simulation runs = made(tool(load, "80", 0.2, 0.1, h));
      settled(runs);
      EXPECT_NEAR(runs.body(0).v[0], 1.2, 1e-12) << h;
    }
}

// Two free bodies that turn about their common centre at 3/s, 2 m apart: 9 N hold them, 1 kg each.
// With 10 N they stay apart as they are; nothing outside acts on them.
TEST(LawJumps, HoldBodiesThatTurnTogether) {
  for (const double h : {2e-2, 2e-3, 2e-4}) {
    Simulation s = made(format(R"yaml(
format: 1
gravity: [0, 0, 0]
bodies:
  a: {{mass: 1, inertia: [1, 1, 1], position: [-1, 0, 0], velocity: [0, -3, 0], angular_velocity: [0, 0, 3]}}
  b: {{mass: 1, inertia: [1, 1, 1], position: [1, 0, 0], velocity: [0, 3, 0], angular_velocity: [0, 0, 3]}}
joints: {{slide: {{type: prismatic, bodies: [a, b], at: [0, 0, 0], axis: x}}}}
loads: {{grip: {{type: translational_spring, joint: slide, damper_force: "10*sign(v)"}}}}
analysis: {{type: dynamics, duration: 1, step: {}}}
output: {{hdf5: false}}
)yaml",
                               h));
    const RunSummary r = finished(s);
    EXPECT_EQ(r.rejected_steps, 0) << h;
    EXPECT_NEAR((s.body(1).r - s.body(0).r).norm(), 2.0, 1e-8) << h;
    EXPECT_LT(r.angular_momentum_drift, 1e-12) << h;
    EXPECT_LT(r.energy_drift, 1e-9) << h;
  }
}

// A wheel of 3 kg m² with 5 N m of dry friction in its hinge, from 2 rad/s: it rests after
// 2²·3/(2·5) rad.
TEST(LawJumps, StopAWheel) {
  for (const double h : {1e-1, 1e-2, 1e-3}) {
    Simulation s = made(format(R"yaml(
format: 1
gravity: [0, 0, 0]
bodies: {{wheel: {{mass: 1, inertia: [2, 2, 3], angular_velocity: [0, 0, 2]}}}}
joints: {{axle: {{type: revolute, bodies: [ground, wheel], at: [0, 0, 0], axis: z}}}}
loads: {{brake: {{type: torsional_spring, joint: axle, damper_moment: "5*sign(v)"}}}}
analysis: {{type: dynamics, duration: 2, step: {}}}
output: {{hdf5: false}}
)yaml",
                               h));
    const RunSummary r = finished(s);
    EXPECT_EQ(r.rejected_steps, 0) << h;
    EXPECT_NEAR(s.joint(0).coordinates.at(0), 1.2, 5.0 / 3.0 * h * h / 8.0 + 1e-9) << h;
    EXPECT_LT(r.angular_momentum_drift, 1e-12) << h;
  }
}

// Held up to 0.1 s, free for 0.1 s at 25 m/s², then stopped in the same time and held again.
TEST(LawJumps, AreSwitchedByEvents) {
  for (const std::string& load : both_kinds("100*sign(v)"))
    for (const double h : {1e-2, 1e-3, 1e-4}) {
      Simulation s = made(tool(load, "50", 0.0, 0.4, h) +
                          "events: {off: {at: 0.1, off: [cut]}, on: {at: 0.2, on: [cut]}}\n");
      settled(s);
      EXPECT_NEAR(s.body(0).r[0], 1.25, 25.0 * h * h / 8.0 + 1e-9) << h;
      EXPECT_NEAR(s.body(0).v[0], 0.0, kWidth) << h;
    }
}

// The tool with a counterweight of the same mass that a second slide holds: rows of laws between
// two moving bodies, in models with and without other forces, by every engine.
std::string two_tools(const std::string& solver, const std::string& law, const std::string& force,
                      double h) {
  return format(R"yaml(
format: 1
gravity: [0, 0, 0]
bodies:
  a: {{mass: 2, inertia: [1, 1, 1], velocity: [-1, 0, 0], position: [-1, 0, 0]}}
  b: {{mass: 2, inertia: [1, 1, 1], velocity: [1, 0, 0], position: [1, 0, 0]}}
joints:
  ways: {{type: prismatic, bodies: [ground, a], at: [0, 0, 0], axis: x}}
  slide: {{type: prismatic, bodies: [a, b], at: [0, 0, 0], axis: x}}
loads: {{cut: {}{}}}
analysis: {{type: dynamics, solver: {}, duration: 0.5, step: {}}}
output: {{hdf5: false}}
)yaml",
                law, force, solver, h);
}

// The relative rate of 2 m/s comes to rest with (100 - 50) N on each 2 kg after 0.04 s, at
// 2 + 2²/(2·50) m; without other forces with 100 N after 0.02 s, at 2 + 0.02 m.
// @tests{law-jump}
TEST(LawJumps, BetweenMovingBodiesAreThoseOfEveryEngine) {
  const std::string axial =
      "{type: spring_damper, bodies: [a, b], at: [[-1, 0, 0], [1, 0, 0]], stiffness: 0, "
      "damper_force: \"100*sign(v)\"}";
  const std::string of_joint =
      "{type: translational_spring, joint: slide, damper_force: \"100*sign(v)\"}";
  const std::string pulls =
      ", to: {type: force, body: b, force: [50, 0, 0]}, fro: {type: force, body: a, force: [-50, "
      "0, "
      "0]}";
  for (const std::string& law : {axial, of_joint})
    for (const std::string& force : {std::string(), pulls})
      for (const double h : {1e-2, 1e-3, 1e-4})
        for (const char* solver : {"tree", "block_lu", "klu"}) {
          Simulation s = made(two_tools(solver, law, force, h));
          const RunSummary r = settled(s);
          const double a = force.empty() ? 100.0 : 50.0;
          EXPECT_NEAR((s.body(1).r - s.body(0).r).norm(), 2.0 + 2.0 / a, a * h * h / 8.0 + 1e-9)
              << solver << " " << h;
          EXPECT_LT(r.newton_iterations, 2 * r.steps + 10) << solver << " " << h;
        }
}

TEST(LawJumps, OfStaircasesAreRefused) {
  expect_fault(tool(both_kinds("100*floor(v/0.1)")[0], "50", 1.0, 0.5, 1e-3),
               "jumps at more than 64 rates, which are not followed");
}

// Numerical damping moves the place of rest by an error of second order: a h²/8 where all of the
// step is at its end, with (1 - ρ)/(1 + ρ) of a step's lag twice. Sums of impulses miss the momenta
// by a part of a step's impulse then, as those of any force do. @tests{law-jump}
TEST(LawJumps, HoldWithNumericalDamping) {
  for (const std::string& load : both_kinds("100*sign(v)"))
    for (const double rho : {0.8, 0.5, 0.0})
      for (const double h : {1e-2, 1e-3, 1e-4}) {
        std::string text = tool(load, "50", 1.0, 0.3, h);
        text.replace(text.find("step: "), 6, format("rho_inf: {}, step: ", rho));
        Simulation s = made(text);
        finished(s);
        EXPECT_NEAR(s.body(0).r[0], 1.02, 25.0 * h * h / 2.0 + 1e-9) << rho << " " << h;
        EXPECT_NEAR(s.body(0).v[0], 0.0, kWidth) << rho << " " << h;
      }
}

// Error control finds a stop as a corner of the velocity: each rejection at least halves the step,
// twice on the way from a tenth of the run to that with an error of a h²/8 below the tolerance.
TEST(LawJumps, AreFoundByAutomaticSteps) {
  for (const double tolerance : {1e-4, 1e-5, 1e-7}) {
    std::string text = tool(both_kinds("100*sign(v)")[0], "50", 1.0, 1.0, 1.0);
    text.replace(text.find("step: 1"), 7, format("tolerance: {}", tolerance));
    Simulation s = made(text);
    const RunSummary r = finished(s);
    EXPECT_NEAR(s.body(0).r[0], 1.02, tolerance) << tolerance;
    EXPECT_LT(r.rejected_steps, 2.0 * std::log2(0.1 / std::sqrt(8.0 * tolerance / 25.0)))
        << tolerance;
  }
}

// @tests{law-jump}
TEST(LawJumps, AreFoundByBounds) {
  const auto jumps = [](const std::string& law) {
    Simulation s = made(tool(both_kinds(law)[0], "0", 0.0, 1.0, 0.1));
    for (const LoadSpec& load : s.model().loads)
      if (load.name == "cut") return jumps_of(*load.laws.at("damper_force"));
    return std::vector<LawJump>{};
  };
  EXPECT_TRUE(jumps("30*v + 5*abs(v)*v").empty());
  EXPECT_TRUE(jumps("tanh(1000*v)").empty());
  const std::vector<LawJump> several = jumps("v < -2.5 ? -7 : v > 0.001 ? 20 : 3*v");
  ASSERT_EQ(several.size(), 2u);
  EXPECT_NEAR(several[0].at, -2.5, 1e-9);
  EXPECT_NEAR(several[0].size, -0.5, 1e-9);
  EXPECT_NEAR(several[1].at, 0.001, 1e-9);
  EXPECT_NEAR(several[1].size, 20.0 - 0.003, 1e-9);
  const std::vector<LawJump> dry = jumps("4*sign(v)");
  ASSERT_EQ(dry.size(), 1u);
  EXPECT_EQ(dry[0].at, 0.0);
  EXPECT_EQ(dry[0].rest, 4.0);
  EXPECT_EQ(jumps("floor(20*v/2^20)").size(), 40u);
}

}  // namespace polhode::test::law_jumps_tests
