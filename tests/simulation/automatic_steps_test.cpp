// SPDX-License-Identifier: Apache-2.0
// Automatic steps where estimates from earlier steps, or all estimates of the error, are
// misleading.
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <polhode/core/format.hpp>
#include <polhode/io/read/read_model.hpp>
#include <polhode/simulation/simulation_details.hpp>

#include "support/paths.hpp"

namespace polhode::automatic_steps_tests {
namespace {

Model with(const std::string& text, int order, double tolerance) {
  Model m = io::read_model_text(text, "model.yaml");
  m.analysis.order = order;
  m.analysis.tolerance = tolerance;
  return m;
}

/// A slider that falls 0.5 m onto a stop and rebounds repeatedly.
std::string slider_on_stop(double restitution) {
  return format(R"(
format: 1
gravity: [0, 0, -9.81]
bodies:
  slider: {{shape: {{box: [0.4, 0.4, 0.4]}}, density: 1000, position: [0, 0, 0]}}
joints:
  rail: {{type: prismatic, bodies: [ground, slider], at: [0, 0, 0], axis: z, limits: {{lower: -0.5, restitution: {}}}}}
analysis: {{duration: 1.25 s}}
)",
                restitution);
}

/// Height of a point that falls from zero onto −0.5 m with restitution e, at time t.
double bounced(double e, double t) {
  const double g = 9.81, drop = 0.5;
  double at = std::sqrt(2.0 * drop / g), v = e * g * at;
  if (t < at) return -0.5 * g * t * t;
  while (v > 1e-9 && t > at + 2.0 * v / g) {
    at += 2.0 * v / g;
    v *= e;
  }
  const double s = t - at;
  return -drop + std::max(0.0, v * s - 0.5 * g * s * s);
}

/// Position of the lower body of a pendulum of two, at the end of a run that ends at each of the
/// times and is continued with a longer duration.
Vec3 swung_on(int order, double tolerance, const std::vector<double>& ends) {
  std::optional<State> reached;
  Vec3 end = Vec3::Zero();
  for (const double T : ends) {
    const Model m = with(format(R"(
format: 1
gravity: [0, 0, -9.81]
bodies:
  upper: {{shape: {{box: [1, 0.05, 0.05]}}, density: 1000, position: [0.5, 0, 0]}}
  lower: {{shape: {{box: [1, 0.05, 0.05]}}, density: 1000, position: [1.5, 0, 0]}}
joints:
  A: {{type: revolute, bodies: [ground, upper], at: [0, 0, 0], axis: y}}
  B: {{type: spherical, bodies: [upper, lower], at: [1, 0, 0]}}
loads: {{push: {{type: force, body: lower, force: ['t > 0.31 ? 30 : 0', 0, '20*sin(9*t)']}}}}
analysis: {{duration: {}}}
)",
                                T),
                         order, tolerance);
    Simulation s = reached ? Simulation(m, *reached) : Simulation(m);
    const RunSummary r = s.run();
    EXPECT_EQ(r.end, RunEnd::finished) << r.message;
    EXPECT_EQ(r.t, T);
    EXPECT_LT(r.energy_drift, 1e-10);
    reached = s.state();
    end = s.body(1).r;
  }
  return end;
}

class Stops : public testing::TestWithParam<double> {};

/// Impacts within the stop's band, whose time is uncertain by band over speed: 2e-5 s here.
TEST_P(Stops, AreReachedWithinTheTolerance) {
  const double e = GetParam();
  for (const double tolerance : {1e-3, 1e-4, 1e-5, 1e-6}) {
    Simulation s(with(slider_on_stop(e), 2, tolerance));
    const RunSummary r = s.run();
    ASSERT_EQ(r.end, RunEnd::finished) << tolerance << ": " << r.message;
    EXPECT_NEAR(s.body(0).r.z(), bounced(e, 1.25), 100.0 * tolerance + 1e-4) << tolerance;
    EXPECT_LT(r.steps, 40000) << tolerance;
  }
}
INSTANTIATE_TEST_SUITE_P(Of, Stops, testing::Values(0.0, 0.3, 0.5, 0.8, 1.0),
                         [](const auto& p) { return format("restitution_{:.0f}", 10 * p.param); });

/// A light pole on a cart with a spring; at times the pole turns over quickly.
std::string cart_pole(double mass) {
  return format(R"(
format: 1
gravity: [0, 0, -9.81]
bodies:
  cart: {{mass: 1, inertia: [0.01, 0.01, 0.01], position: [0, 0, 0]}}
  pole: {{mass: {0}, inertia: [{1}, {1}, {1}], position: [0, 0, 0.5], angular_velocity: [0, 0.1, 0], velocity: [0.05, 0, 0]}}
joints:
  slide: {{type: prismatic, bodies: [ground, cart], at: [0, 0, 0], axis: x}}
  hinge: {{type: revolute, bodies: [cart, pole], at: [0, 0, 0], axis: y}}
loads:
  spring: {{type: spring_damper, bodies: [ground, cart], at_body: [[-1, 0, 0], [0, 0, 0]], stiffness: 10, free_length: 0.8}}
analysis: {{duration: 3 s}}
)",
                mass, mass / 12.0);
}

// The mechanism is 2 m long, and the tolerance relative to that.
TEST(AutomaticSteps, OfContinuedRunsEndWithinTheToleranceOfARunInOneGo) {
  const Vec3 right = swung_on(8, 1e-11, {1.0});
  for (const int order : {2, 6, 8})
    for (const double tolerance : {1e-4, 1e-6, 1e-8}) {
      if (order == 2 && tolerance < 1e-6) continue;  // 80,000 steps
      const Vec3 whole = swung_on(order, tolerance, {1.0});
      EXPECT_LT((whole - right).norm(), 2.0 * tolerance) << order << ' ' << tolerance;
      for (const double stop : {0.01, 0.3, 0.7777}) {
        const Vec3 continued = swung_on(order, tolerance, {stop, 1.0});
        RecordProperty(format("order_{}_tolerance_{:g}_stop_{:g}", order, tolerance, stop),
                       format("{:.1e}", (continued - whole).norm()));
        EXPECT_LT((continued - whole).norm(), 2.0 * tolerance)
            << order << ' ' << tolerance << ' ' << stop;
      }
    }
}

/// @tests{step-halves}
TEST(AutomaticSteps, FollowALightPoleOnACart) {
  const auto angle = [](double mass, int order, double tolerance) {
    Simulation s(with(cart_pole(mass), order, tolerance));
    const RunSummary r = s.run();
    EXPECT_EQ(r.end, RunEnd::finished) << r.message;
    EXPECT_TRUE(r.warnings.empty()) << r.warnings.front();
    return s.joint(1).coordinates.at(0);
  };
  for (const double mass : {1e-2, 1e-6, 1e-9}) {
    const double right = angle(mass, 8, 1e-10);
    for (const double tolerance : {1e-4, 1e-6}) {
      EXPECT_NEAR(angle(mass, 2, tolerance), right, 200.0 * tolerance) << mass;
      EXPECT_NEAR(angle(mass, 6, tolerance), right, 200.0 * tolerance) << mass;
    }
  }
}

/// Two independent pendulums of very different mass: both are accurate.
TEST(AutomaticSteps, FollowAPendulumOfAMilligramBesideOneOfAThousandTons) {
  const std::string text = R"(
format: 1
gravity: [0, 0, -9.81]
bodies:
  light: {mass: 1e-6, inertia: [1e-8, 1e-8, 1e-8], position: [0.3, 0, 0]}
  heavy: {mass: 1e6, inertia: [1e5, 1e5, 1e5], position: [0, 3, -0.8]}
joints:
  a: {type: revolute, bodies: [ground, light], at: [0, 0, 0], axis: y}
  b: {type: revolute, bodies: [ground, heavy], at: [0, 2, 0], axis: x}
analysis: {duration: 3 s}
)";
  const auto angles = [&](int order, double tolerance) {
    Simulation s(with(text, order, tolerance));
    const RunSummary r = s.run();
    EXPECT_EQ(r.end, RunEnd::finished) << r.message;
    return std::pair(s.joint(0).coordinates.at(0), s.joint(1).coordinates.at(0));
  };
  const auto right = angles(8, 1e-11);
  for (const int order : {2, 6})
    for (const double tolerance : {1e-4, 1e-6}) {
      const auto found = angles(order, tolerance);
      EXPECT_NEAR(found.first, right.first, 200.0 * tolerance) << order << ", " << tolerance;
      EXPECT_NEAR(found.second, right.second, 200.0 * tolerance) << order << ", " << tolerance;
    }
}

/// A tolerance below rounding errors: the run finishes with a warning that it was not reached.
TEST(AutomaticSteps, ReportAToleranceThatCannotBeReached) {
  const std::string text = R"(
format: 1
gravity: [0, 0, -9.81]
bodies:
  rod: {shape: {box: [1, 50 mm, 50 mm]}, density: 1000, position: [1000.5, 0, 0]}
joints:
  hinge: {type: revolute, bodies: [ground, rod], at: [1000, 0, 0], axis: y}
analysis: {duration: 0.1 s}
)";
  for (const int order : {2, 6}) {
    Simulation s(with(text, order, 1e-14));
    const RunSummary r = s.run();
    EXPECT_EQ(r.end, RunEnd::finished) << r.message;
    ASSERT_EQ(r.warnings.size(), 1u) << order;
    EXPECT_NE(r.warnings[0].find("tolerance: 1e-14 was not reached"), std::string::npos);
    Simulation fine(with(text, order, 1e-7));
    EXPECT_TRUE(fine.run().warnings.empty()) << order;
  }
}

/// A solid without bodies: the error at the end follows the tolerance, at orders 6 and 8 as well.
TEST(AutomaticSteps, FollowSolidsWithoutBodies) {
  for (const auto& [element, cells] : {std::pair("hex8_eas9", 2), std::pair("hex20", 1)}) {
    const std::string text = format(R"(
format: 1
materials:
  rubber: {{type: neo_hookean, youngs_modulus: 1 MPa, poisson_ratio: 0.3, density: 1000}}
solids:
  bar:
    mesh: {{block: {{size: [1, 0.2, 0.2], cells: [{}, 1, 1]}}}}
    element: {}
    material: rubber
    angular_velocity: [0, 3, 0]
analysis: {{duration: 0.1 s}}
)",
                                    cells, element);
    const auto tip = [&](int order, double tolerance, double step) {
      Model m = with(text, order, tolerance);
      if (step > 0.0) m.analysis.step = step;
      Simulation s(m);
      const RunSummary r = s.run();
      EXPECT_EQ(r.end, RunEnd::finished) << r.message;
      return Vec3(s.state().node_x[0], s.state().node_x[1], s.state().node_x[2]);
    };
    const Vec3 right = tip(8, 1e-3, 1e-3);
    for (const int order : {6, 8})
      for (const double tolerance : {1e-3, 1e-6, 1e-9})
        EXPECT_LE((tip(order, tolerance, 0.0) - right).norm(), 200.0 * tolerance)
            << element << ", order " << order << ", " << tolerance;
  }
}

/// Gears on redundant bearings, whose drive's work in short steps is rounding: it grows as steps
/// shrink, and a step must not be made ever shorter for it.
TEST(AutomaticSteps, ImbalancesByRoundingDoNotShortenSteps) {
  for (const double tolerance : {1e-9, 1e-10, 1e-11, 1e-12}) {
    Model m = io::read_model(test::source_dir() + "/examples/planetary_gearbox/model.yaml");
    m.analysis.step.reset();
    m.analysis.tolerance = tolerance;
    m.analysis.duration = 0.5;
    Simulation simulation(m);
    int steps = 0;
    while (simulation.time() < 0.5 && steps < 1000) {
      ASSERT_TRUE(simulation.step(0.5).accepted);
      ++steps;
    }
    EXPECT_LT(steps, 200) << tolerance;
    EXPECT_TRUE(simulation.summary().trusted());
    // The sun reaches 100 rad/s with 200 rad/s², the carrier turns at a quarter of that.
    EXPECT_NEAR(simulation.joint("input").coordinates[0], 25.0, 1e-8);
    EXPECT_NEAR(simulation.joint("output").coordinates[0], 25.0 / 4.0, 1e-8);
  }
}

}  // namespace
}  // namespace polhode::automatic_steps_tests
