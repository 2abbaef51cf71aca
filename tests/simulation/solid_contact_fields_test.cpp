// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include <polhode/core/format.hpp>
#include <polhode/io/read/read_model.hpp>
#include <polhode/simulation/simulation_details.hpp>
#include <polhode/simulation/solid_contact_fields.hpp>

namespace polhode::solid_contact_fields_tests {
namespace {

/// A block of 1 m² pressed down by 30 Pa on what is below it, free to spread.
Simulation pressed(const std::string& below, const std::string& element, double height) {
  Simulation simulation(io::read_model_text(format(R"(
format: 1
bodies: {{floor: {{fixed: true, shape: {{plane: z}}}}}}
materials: {{m: {{type: st_venant_kirchhoff, youngs_modulus: 2000, poisson_ratio: 0, density: 1}}}}
solids:
  block:
    mesh: {{block: {{size: [1, 1, 0.6], cells: [2, 2, 2]}}, position: [0, 0, {1}]}}
    element: {0}
    material: m
    contact: {{surface: zmin}}
    prescribed: {{x: {{nodes: {{plane: {{axis: x, at: min}}}}, x: 0}}, y: {{nodes: {{plane: {{axis: y, at: min}}}}, y: 0}}}}
{2}
loads: {{p: {{type: pressure, solid: block, surface: zmax, pressure: 30, follower: false}}}}
contacts: {{default: {{gap_tolerance: 1 mm}}}}
analysis: {{type: statics}}
)",
                                                   element, height, below),
                                            "pressed.yaml"));
  const RunSummary summary = simulation.run();
  EXPECT_EQ(summary.end, RunEnd::finished) << summary.message;
  return simulation;
}

/// Every point bears the pressure from above, at nodes and at points between them.
TEST(SolidContactFields, AreTheUniformPressureOfAPressedBlock) {
  for (const char* element : {"hex8_standard", "hex20"}) {
    SCOPED_TRACE(element);
    const Simulation simulation = pressed("", element, 0.3);
    ASSERT_TRUE(has_contact_fields(simulation, 0));
    const SolidContactFields fields = solid_contact_fields(simulation, 0);
    const std::vector<Vec3>& start = simulation.solids()[0].plan.start;
    ASSERT_EQ(fields.pressure.size(), start.size());
    int below = 0;
    for (std::size_t i = 0; i < start.size(); ++i) {
      if (start[i].z() > 1e-9) {
        EXPECT_TRUE(std::isnan(fields.pressure[i]) && std::isnan(fields.gap[i])) << start[i];
        continue;
      }
      ++below;
      EXPECT_NEAR(fields.pressure[i], 30.0, 1e-6);
      EXPECT_GT(fields.gap[i], -1e-3);
      EXPECT_LT(fields.gap[i], 1e-3);
    }
    EXPECT_EQ(below, std::string(element) == "hex20" ? 21 : 9);
  }
}

/// Their integral is the load on both sides of two solids.
TEST(SolidContactFields, OfTwoSolidsAreThoseOfBothSides) {
  const Simulation simulation = pressed(R"(  base:
    mesh: {block: {size: [3, 3, 0.6], cells: [6, 6, 1]}, position: [0, 0, 0.3]}
    element: hex8_standard
    material: m
    bonded: {ground: zmin}
    contact: {surface: zmax})",
                                        "hex8_standard", 0.902);
  for (int solid = 0; solid < 2; ++solid) {
    const double half = solid == 0 ? 0.5 : 1.5;  // of the surface, with cells of 0.5 m
    const SolidContactFields fields = solid_contact_fields(simulation, solid);
    const std::vector<Vec3>& start =
        simulation.solids()[static_cast<std::size_t>(solid)].plan.start;
    double force = 0.0, area = 0.0;
    for (std::size_t i = 0; i < start.size(); ++i) {
      if (std::abs(start[i].z() - 0.6) > 3e-3) continue;
      const double x = std::abs(start[i].x()), y = std::abs(start[i].y());
      const double share = 0.25 * (x > half - 0.1 ? 0.5 : 1.0) * (y > half - 0.1 ? 0.5 : 1.0);
      force += share * fields.pressure[i];
      area += share;
      EXPECT_GE(fields.pressure[i], 0.0);
      if (std::max(x, y) > 1.1) {  // beside the block
        EXPECT_EQ(fields.pressure[i], 0.0);
      }
      if (std::max(x, y) < 0.6) {
        EXPECT_LT(std::abs(fields.gap[i]), 1e-3);
      }
    }
    EXPECT_NEAR(area, 4.0 * half * half, 1e-12);
    EXPECT_NEAR(force, 30.0, 0.03) << "of solid " << solid;
  }
}

TEST(SolidContactFields, AreAbsentWithoutContact) {
  const Simulation simulation(io::read_model_text(R"(
format: 1
materials: {m: {type: elastic, youngs_modulus: 2000, poisson_ratio: 0, density: 1}}
solids:
  block: {mesh: {block: {size: [1, 1, 1], cells: [1, 1, 1]}}, material: m, bonded: {ground: zmin}}
analysis: {type: statics}
)",
                                                  "free.yaml"));
  EXPECT_FALSE(has_contact_fields(simulation, 0));
}

}  // namespace
}  // namespace polhode::solid_contact_fields_tests
