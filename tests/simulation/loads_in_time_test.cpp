// SPDX-License-Identifier: Apache-2.0
// Loads that depend on time: with every kind of step control none is skipped.
#include <cmath>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include <polhode/core/format.hpp>
#include <polhode/io/read/read_model.hpp>
#include <polhode/simulation/simulation_details.hpp>

namespace polhode::loads_in_time_tests {
namespace {

/// A free ball of 2 kg on which a force along x acts.
Model pushed_ball(const std::string& force, double duration) {
  return io::read_model_text(format(R"(
format: 1
bodies:
  ball: {{mass: 2, inertia: [1, 1, 1], position: [0, 0, 0]}}
loads:
  push: {{type: force, body: ball, at: [0, 0, 0], force: [{}, 0, 0]}}
analysis: {{duration: {} s}}
)",
                                    force, duration),
                             "ball.yaml");
}

struct End {
  double x, v;
  RunSummary summary;
};

End end_of(Model model) {
  Simulation s(std::move(model));
  const RunSummary r = s.run();
  EXPECT_EQ(r.end, RunEnd::finished) << r.message;
  return {s.body(0).r.x(), s.body(0).v.x(), r};
}

/// All kinds of step control, as `set(model)` and a name.
template <class Test>
void for_all_steps(const Model& model, const Test& test) {
  for (const int order : {2, 6, 8})
    for (const double tolerance : {1e-3, 1e-6, 1e-9}) {
      Model m = model;
      m.analysis.order = order;
      m.analysis.tolerance = tolerance;
      test(m, format("order {}, tolerance {}", order, tolerance));
    }
  for (const int order : {2, 4, 6})
    for (const double step : {1.0, 0.13, 0.02}) {
      Model m = model;
      m.analysis.order = order;
      m.analysis.step = step;
      test(m, format("order {}, step {}", order, step));
    }
}

/// F over L gives F L/m, and a motion that is a parabola between the breaks: exact at any order.
/// @tests{sampled-loads}
TEST(LoadsInTime, PulsesOfAnyLengthGiveTheirWholeImpulse) {
  for (const double length : {1.0, 0.2, 1e-2, 1e-4, 1e-6, 1e-8}) {
    const double force = 1.0 / length;
    const std::string text =
        format("\"t > 5.3 && t < 5.3 + {:.17g} ? {:.17g} : 0\"", length, force);
    for_all_steps(pushed_ball(text, 10.0), [&](const Model& m, const std::string& how) {
      const End end = end_of(m);
      EXPECT_NEAR(end.v, 0.5, 1e-6 * 1e-8 / length + 1e-12) << length << " s, " << how;
      EXPECT_NEAR(end.x, 0.5 * (4.7 - 0.5 * length), 1e-6 * 1e-8 / length + 1e-11)
          << length << " s, " << how;
    });
  }
}

TEST(LoadsInTime, TablesOfStepsGiveTheirImpulses) {
  const Model model = pushed_ball(
      "{table: [[0.7, 0], [1.3, 4], [1.31, -100], [1.32, 0], [2.5, 6], [3, 0]], interpolation: "
      "step}",
      4.0);
  for_all_steps(model, [&](const Model& m, const std::string& how) {
    EXPECT_NEAR(end_of(m).v, 0.5 * (4.0 * 0.01 - 100.0 * 0.01 + 6.0 * 0.5), 1e-12) << how;
  });
}

TEST(LoadsInTime, SwitchedForcesBeginWhenTheyAreSwitchedOn) {
  for_all_steps(pushed_ball("\"t > 0.7 ? 4 : 0\"", 1.62),
                [&](const Model& m, const std::string& how) {
                  EXPECT_NEAR(end_of(m).x, 0.92 * 0.92, 1e-12) << how;
                });
}

TEST(LoadsInTime, NumericalDampingDoesNotChangeAnImpulse) {
  for (const double rho_inf : {0.0, 0.3, 0.8})
    for (const double step : {0.0, 0.2, 0.013}) {
      Model m = pushed_ball("\"t > 5.3 && t < 6.4 ? 4 : 0\"", 10.0);
      m.analysis.rho_inf = rho_inf;
      if (step > 0.0)
        m.analysis.step = step;
      else
        m.analysis.tolerance = 1e-6;
      const End end = end_of(m);
      EXPECT_NEAR(end.v, 2.2, 1e-9) << rho_inf << ", " << step;
      EXPECT_NEAR(end.x, 2.2 * (3.6 + 0.55), 1e-8) << rho_inf << ", " << step;
    }
}

/// Pulses of loads on solids, as on bodies: the velocity of a free block is its impulse over its
/// mass.
TEST(LoadsInTime, PulsesOnSolidsGiveTheirWholeImpulse) {
  const char* pulse = "\"t > 0.0317 && t < 0.0324 ? 300 : 0\"";
  const std::string kinds[] = {
      format("{{type: body_force, solid: block, acceleration: [{}, 0, 0]}}", pulse),
      format("{{type: traction, solid: block, surface: xmax, traction: [{}, 0, 0]}}", pulse),
      format("{{type: pressure, solid: block, surface: xmin, follower: false, pressure: {}}}",
             pulse)};
  const double impulses[] = {0.3 * 0.2 * 0.1 * 1000.0 * 300.0 * 7e-4, 0.2 * 0.1 * 300.0 * 7e-4,
                             0.2 * 0.1 * 300.0 * 7e-4};
  for (int k = 0; k < 3; ++k)
    for (const bool fixed : {false, true}) {
      Model m = io::read_model_text(format(R"(
format: 1
materials:
  rubber: {{type: neo_hookean, youngs_modulus: 1 MPa, poisson_ratio: 0.3, density: 1000}}
solids:
  block: {{mesh: {{block: {{size: [0.3, 0.2, 0.1], cells: [1, 1, 1]}}}}, element: hex8_eas9, material: rubber}}
loads:
  push: {}
analysis: {{duration: 0.05 s}}
)",
                                           kinds[k]),
                                    "block.yaml");
      if (fixed)
        m.analysis.step = 0.01;
      else
        m.analysis.tolerance = 1e-3;
      Simulation s(m);
      const RunSummary r = s.run();
      EXPECT_EQ(r.end, RunEnd::finished) << r.message;
      EXPECT_NEAR(s.balance().linear_momentum.x(), impulses[k], 1e-10 * impulses[k]) << k;
    }
}

/// Straight lines between points: the force is continuous, and midpoints integrate it exactly.
TEST(LoadsInTime, RampsOfTablesGiveTheirImpulse) {
  const Model model = pushed_ball("{table: [[1, 0], [1.01, 50], [1.03, 0], [4, 1], [5, 0]]}", 6.0);
  for_all_steps(model, [&](const Model& m, const std::string& how) {
    EXPECT_NEAR(end_of(m).v, 0.5 * (0.01 * 25.0 + 0.02 * 25.0 + 2.97 * 0.5 + 0.5), 1e-12) << how;
  });
}

/// F sin ωt moves by F/(m ω²) (ω t − sin ω t), at 50 Hz.
TEST(LoadsInTime, FastForcesAreSampled) {
  const double omega = 100.0 * std::numbers::pi, T = 1.993;
  const double right = 10.0 / (omega * omega) * (omega * T - std::sin(omega * T));
  for (const int order : {2, 6, 8})
    for (const double tolerance : {1e-3, 1e-5, 1e-7, 1e-9}) {
      if (order == 2 && tolerance < 1e-6) continue;  // a million steps
      Model m = pushed_ball("20*sin(100*pi*t)", T);
      m.analysis.order = order;
      m.analysis.tolerance = tolerance;
      EXPECT_NEAR(end_of(m).x, right, 200.0 * tolerance) << order << ", " << tolerance;
    }
}

/// A bump of a hundredth of a second far from the start: exp(−(τ/w)²) has the impulse √π w.
TEST(LoadsInTime, SmoothBumpsAreNotSkipped) {
  for (const int order : {2, 6, 8})
    for (const double tolerance : {1e-3, 1e-6}) {
      Model m = pushed_ball("1000*exp(-((t - 7.1)/0.01)^2)", 10.0);
      m.analysis.order = order;
      m.analysis.tolerance = tolerance;
      EXPECT_NEAR(end_of(m).v, 5.0 * std::sqrt(std::numbers::pi), 200.0 * tolerance)
          << order << ", " << tolerance;
    }
}

/// The grid of fixed steps is kept: only a step that contains a break is divided.
TEST(LoadsInTime, FixedStepsReturnToTheirGrid) {
  Model m = pushed_ball("\"t > 0.733 ? 4 : 0\"", 2.0);
  m.analysis.step = 0.1;
  Simulation s(m);
  std::vector<double> times;
  s.run({}, [&](Simulation& now) { times.push_back(now.time()); });
  ASSERT_EQ(times.size(), 21u) << testing::PrintToString(times);
  for (int k = 0; k < 7; ++k) EXPECT_NEAR(times[static_cast<std::size_t>(k)], 0.1 * (k + 1), 1e-14);
  EXPECT_NEAR(times[7], 0.733, 1e-14);
  for (int k = 8; k < 21; ++k) EXPECT_NEAR(times[static_cast<std::size_t>(k)], 0.1 * k, 1e-14);
}

/// Breaks on the grid to rounding, or nearly: they cause no tiny steps.
TEST(LoadsInTime, BreaksOnTheGridCauseNoExtraStep) {
  for (const char* at : {"0.7", "0.7 + 1e-13", "0.7 - 1e-13"}) {
    Model m = pushed_ball(format("\"t > {} ? 4 : 0\"", at), 2.0);
    m.analysis.step = 0.1;
    const End end = end_of(m);
    EXPECT_EQ(end.summary.steps, 20) << at;
    EXPECT_NEAR(end.v, 2.6, 1e-9) << at;
  }
}

TEST(LoadsInTime, ContinuedRunsAreTheSame) {
  for (const int order : {2, 6}) {
    Model m = pushed_ball("\"sin(7*t) > 0.3 ? 4*cos(3*t) : t\"", 3.0);
    m.analysis.order = order;
    m.analysis.tolerance = 1e-6;
    Simulation whole(m), first(m);
    whole.run();
    while (first.time() < 1.5) first.step(3.0);
    Simulation second(m, first.state());
    second.run();
    EXPECT_EQ(second.state_hash(), whole.state_hash()) << order;
  }
}

}  // namespace
}  // namespace polhode::loads_in_time_tests
