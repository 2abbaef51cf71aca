// SPDX-License-Identifier: Apache-2.0
// Impacts of points of surfaces on rigid shapes, in whole models.
#include <gtest/gtest.h>

#include <polhode/core/format.hpp>
#include <polhode/io/read/read_model.hpp>
#include <polhode/simulation/simulation_details.hpp>

namespace polhode::test::surface_impacts_tests {
namespace {

/// A straight rope that meets the floor flat at 1 m/s, without weight, so light at its ends that it
/// is one with them.
Model rope(double e, double mu, double along, double step) {
  return read_model_text(format(R"(
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
        EXPECT_NEAR(simulation.body(end).v.z(), e, 2e-3) << "the rope swings by itself";
      EXPECT_LT(summary.energy_drift, 1e-10);
    }
}

// @tests{impact-friction}
TEST(SurfaceImpacts, RubByTheImpulseThatBelongsToTheirRestitution) {
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
TEST(SurfaceImpacts, OfASolidOnAFreeBodyKeepMomentaAndNeverGiveEnergy) {
  for (const double e : {0.0, 0.5, 1.0})
    for (const double step : {5e-3, 1e-3}) {
      SCOPED_TRACE(format("e = {}, step {} s", e, step));
      Simulation simulation(read_model_text(format(R"(
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
      EXPECT_LT(summary.energy_drift, 1e-10) << "what is lost is told";
      EXPECT_LT(summary.linear_momentum_drift, 1e-12);
      EXPECT_LT(summary.angular_momentum_drift, 1e-12);
      ASSERT_TRUE(summary.contacts);
      EXPECT_GT(summary.contacts->lost_by_friction, 0.0);
      EXPECT_EQ(summary.contacts->lost_in_impacts > 0.0, e < 1.0);
    }
}

}  // namespace
}  // namespace polhode::test::surface_impacts_tests
