// SPDX-License-Identifier: Apache-2.0
// Impacts of points of surfaces on rigid shapes, in complete models.
#include <gtest/gtest.h>

#include <polhode/core/format.hpp>
#include <polhode/io/read/read_model.hpp>
#include <polhode/simulation/simulation_details.hpp>

namespace polhode::test::surface_impacts_tests {
namespace {

/// A straight rope that hits the floor flat at 1 m/s, without weight, with ends so light that they
/// move with it.
Model rope(double e, double mu, double along, double step) {
  return io::read_model_text(format(R"(
format: 1
gravity: [0, 0, 0]
bodies:
  floor: {{fixed: true, shape: {{plane: z}}}}
  left: {{mass: 1e-3, inertia: [1e-8, 1e-8, 1e-8], position: [-0.1, 0, 0.0055], velocity: [{1}, 0, -1]}}
  right: {{mass: 1e-3, inertia: [1e-8, 1e-8, 1e-8], position: [0.1, 0, 0.0055], velocity: [{1}, 0, -1]}}
cables:
  rope: {{through: [[left], [right]], stiffness: 1e4, mass_per_length: 0.1, elements: 2, contact: {{radius: 5 mm}}}}
contacts: {{default: {{restitution: {0}, friction: {2}}}}}
analysis: {{duration: 8 ms, step: {3}}}
)",
                                    e, along, mu, step),
                             "rope.yaml");
}

// @tests{surface-turn}
TEST(SurfaceImpacts, OfARopeReboundByTheirRestitutionAtAnyStep) {
  for (const double e : {0.0, 0.3, 0.7, 1.0})
    for (const double step : {2e-3, 4e-4, 4e-5}) {
      SCOPED_TRACE(format("e = {}, step {} s", e, step));
      Simulation simulation(rope(e, 0.0, 0.0, step));
      const RunSummary summary = simulation.run();
      ASSERT_EQ(summary.end, RunEnd::finished) << summary.message;
      for (const char* end : {"left", "right"})
        EXPECT_NEAR(simulation.body(end).v.z(), e, 2e-3) << "vibration of the rope itself";
      EXPECT_LT(summary.energy_drift, 1e-10);
    }
}

// @tests{impact-friction}
TEST(SurfaceImpacts, HaveFrictionImpulsesByTheirRestitution) {
  const double mu = 0.1, along = 3.0;
  for (const double e : {0.0, 0.5})
    for (const double step : {2e-3, 4e-4, 4e-5}) {
      SCOPED_TRACE(format("e = {}, step {} s", e, step));
      Simulation simulation(rope(e, mu, along, step));
      const RunSummary summary = simulation.run();
      ASSERT_EQ(summary.end, RunEnd::finished) << summary.message;
      EXPECT_NEAR(simulation.body("left").v.x(), along - mu * (1.0 + e), 1e-2 * mu);
    }
}

// @tests{surface-turn}
TEST(SurfaceImpacts, OfASolidOnAFreeBodyKeepMomentaAndNeverAddEnergy) {
  for (const double e : {0.0, 0.5, 1.0})
    for (const double step : {5e-3, 1e-3}) {
      SCOPED_TRACE(format("e = {}, step {} s", e, step));
      Simulation simulation(io::read_model_text(format(R"(
format: 1
gravity: [0, 0, 0]
materials: {{rubber: {{type: neo_hookean, youngs_modulus: 1e6, poisson_ratio: 0.3, density: 1000}}}}
bodies: {{table: {{mass: 3, inertia: [0.1, 0.1, 0.1], position: [0.2, 0.1, -0.5], shape: {{box: [2, 2, 1]}}}}}}
solids:
  block: {{mesh: {{block: {{size: [0.1, 0.1, 0.1], cells: [2, 2, 2]}}, position: [0, 0, 0.051]}}, material: rubber,
          velocity: [1, 0, -1], contact: {{}}}}
contacts: {{default: {{restitution: {}, friction: 0.2}}}}
analysis: {{duration: 20 ms, step: {}}}
)",
                                                       e, step),
                                                "block.yaml"));
      const RunSummary summary = simulation.run();
      ASSERT_EQ(summary.end, RunEnd::finished) << summary.message;
      EXPECT_LT(simulation.body("table").v.z(), -0.3);
      EXPECT_LT(summary.energy_drift, 1e-10) << "the loss is in the energy balance";
      EXPECT_LT(summary.linear_momentum_drift, 1e-12);
      EXPECT_LT(summary.angular_momentum_drift, 1e-12);
      ASSERT_TRUE(summary.contacts);
      EXPECT_GT(summary.contacts->lost_by_friction, 0.0);
      EXPECT_EQ(summary.contacts->lost_in_impacts > 0.0, e < 1.0);
    }
}

/// A straight cable that falls across another one at 1 m/s, without weight, both of one element.
Model crossing_cables(double e, double mu, double along, double step) {
  return io::read_model_text(format(R"(
format: 1
gravity: [0, 0, 0]
bodies:
  left: {{mass: 1e-3, inertia: [1e-8, 1e-8, 1e-8], position: [-0.1, 0, 0.011], velocity: [{1}, 0, -1]}}
  right: {{mass: 1e-3, inertia: [1e-8, 1e-8, 1e-8], position: [0.1, 0, 0.011], velocity: [{1}, 0, -1]}}
  front: {{mass: 1e-3, inertia: [1e-8, 1e-8, 1e-8], position: [0, -0.1, 0]}}
  back: {{mass: 1e-3, inertia: [1e-8, 1e-8, 1e-8], position: [0, 0.1, 0]}}
cables:
  rope: {{through: [[left], [right]], stiffness: 1e4, mass_per_length: 0.1, elements: 1, contact: {{radius: 5 mm}}}}
  stay: {{through: [[front], [back]], stiffness: 1e4, mass_per_length: 0.1, elements: 1, contact: {{radius: 5 mm}}}}
contacts: {{default: {{restitution: {0}, friction: {2}}}}}
analysis: {{duration: 6 ms, step: {3}}}
)",
                                    e, along, mu, step),
                             "cables.yaml");
}

/// Velocities of equal masses after impact: their mean, plus or minus half of e times the approach
/// velocity.
// @tests{cable-impact}
TEST(SurfaceImpacts, OfCrossedCablesReboundByTheirRestitutionAtAnyStep) {
  for (const double e : {0.0, 0.3, 0.7, 1.0})
    for (const double step : {2e-3, 4e-4, 2e-5}) {
      SCOPED_TRACE(format("e = {}, step {} s", e, step));
      Simulation simulation(crossing_cables(e, 0.0, 0.0, step));
      const RunSummary summary = simulation.run();
      ASSERT_EQ(summary.end, RunEnd::finished) << summary.message;
      for (const char* end : {"left", "right"})
        EXPECT_NEAR(simulation.body(end).v.z(), 0.5 * (e - 1.0), 1e-4);
      for (const char* end : {"front", "back"})
        EXPECT_NEAR(simulation.body(end).v.z(), -0.5 * (1.0 + e), 1e-4);
      EXPECT_LT(summary.energy_drift, 1e-10) << "the loss is in the energy balance";
      EXPECT_LT(summary.linear_momentum_drift, 1e-12);
      EXPECT_LT(summary.angular_momentum_drift, 1e-12);
    }
}

/// Friction impulse between two equal cables, which changes their momenta by opposite amounts.
// @tests{cable-impact}
TEST(SurfaceImpacts, OfCrossedCablesHaveFrictionImpulsesByTheirRestitution) {
  const double mu = 0.1, along = 1.0;
  for (const double e : {0.0, 0.5})
    for (const double step : {2e-3, 4e-4, 4e-5}) {
      SCOPED_TRACE(format("e = {}, step {} s", e, step));
      Simulation simulation(crossing_cables(e, mu, along, step));
      const RunSummary summary = simulation.run();
      ASSERT_EQ(summary.end, RunEnd::finished) << summary.message;
      const auto mean = [&](const char* one, const char* other) {
        return 0.5 * (simulation.body(one).v.x() + simulation.body(other).v.x());
      };
      const double given = 0.5 * mu * (1.0 + e);
      EXPECT_NEAR(mean("left", "right"), along - given, 1e-2 * given);
      EXPECT_NEAR(mean("front", "back"), given, 1e-2 * given);
      EXPECT_LT(summary.energy_drift, 1e-10);
      EXPECT_LT(summary.angular_momentum_drift, 1e-12);
    }
}

/// Two equal bodies, each with a solid bonded to it at all nodes: they rebound as rigid bodies.
// @tests{mesh-impact}
TEST(SurfaceImpacts, OfSolidsOnEachOtherReboundByTheirRestitution) {
  for (const double e : {0.0, 0.5, 1.0})
    for (const double step : {1e-3, 2e-4, 2e-5}) {
      SCOPED_TRACE(format("e = {}, step {} s", e, step));
      Simulation simulation(io::read_model_text(format(R"(
format: 1
gravity: [0, 0, 0]
materials: {{rubber: {{type: neo_hookean, youngs_modulus: 1e6, poisson_ratio: 0.3, density: 1000}}}}
bodies:
  below: {{mass: 1.784, inertia: [1e-2, 1e-2, 1e-2], position: [0, 0, 0], velocity: [0, 0, 1]}}
  above: {{mass: 2.568, inertia: [1e-2, 1e-2, 1e-2], position: [0, 0, 0.082], velocity: [0, 0, -1]}}
solids:
  low: {{mesh: {{block: {{size: [0.1, 0.1, 0.1], cells: [1, 1, 1]}}, position: [0, 0, 0]}}, material: rubber, velocity: [0, 0, 1],
        bonded: {{below: {{sphere: {{centre: [0, 0, 0], radius: 9}}}}}}}}
  high: {{mesh: {{block: {{size: [0.06, 0.06, 0.06], cells: [1, 1, 1]}}, position: [0, 0, 0.082]}}, material: rubber, velocity: [0, 0, -1],
         bonded: {{above: {{sphere: {{centre: [0, 0, 0], radius: 9}}}}}}}}
contacts: {{default: {{restitution: {}}}}}
analysis: {{duration: 6 ms, step: {}}}
)",
                                                       e, step),
                                                "blocks.yaml"));
      const RunSummary summary = simulation.run();
      ASSERT_EQ(summary.end, RunEnd::finished) << summary.message;
      EXPECT_NEAR(simulation.body("below").v.z(), -e, 1e-3);
      EXPECT_NEAR(simulation.body("above").v.z(), e, 1e-3);
      EXPECT_LT(summary.energy_drift, 1e-10);
      EXPECT_LT(summary.linear_momentum_drift, 1e-12);
      EXPECT_LT(summary.angular_momentum_drift, 1e-12);
    }
}

}  // namespace
}  // namespace polhode::test::surface_impacts_tests
