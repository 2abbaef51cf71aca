// SPDX-License-Identifier: Apache-2.0
// Natural frequencies of bars of solid elements, free and on a free body, against Timoshenko's beam
// and against an independent implementation of the same elements on the same meshes.
#include <gtest/gtest.h>

#include <cmath>

#include <polhode/solids/materials/registry.hpp>
#include <polhode/solids/mesh/generators.hpp>
#include <polhode/solids/solid_elements.hpp>
#include <polhode/statics/modes.hpp>

namespace polhode::solid_frequencies_tests {
namespace {

struct Bar {
  std::string element, cell;
  double along, across;
};

/// Adds a bar along x whose first layer of nodes belongs to a body, or is free.
void add_bar(System& system, const Bar& bar, const Vec3& size, double first, double young,
             double density, int body) {
  const solids::Mesh mesh = solids::make_mesh(
      "bar", "block",
      {{"size", {size[0], size[1], size[2]}}, {"cells", {bar.along, bar.across, bar.across}}},
      bar.cell);
  std::vector<Vec3> X;
  for (const Vec3& own : mesh.nodes) {
    const Vec3 x = own + Vec3(first + 0.5 * size[0], 0, 0);
    X.push_back(x);
    NodeData node{.position = x};
    if (body != kFreeNode && x[0] < first + 1e-9) {
      node.body = body;
      node.Z = x;
    }
    system.add_node(node);
  }
  solids::SolidElementsDescription d;
  d.name = "solids.bar";
  d.element = bar.element;
  d.material = solids::make_material(
      "materials.m",
      {.kind = "elastic", .values = {{"youngs_modulus", young}, {"poisson_ratio", 0.3}}});
  d.density = density;
  d.connectivity = mesh.blocks.at(0).nodes;
  d.X = X;
  system.add_elements(solids::make_solid_elements(std::move(d)));
}

struct FreeBar {
  Bar bar;
  double first;  ///< Bending frequency by the independent implementation [Hz]; 0: not compared.
  double error;  ///< Bound on the distance from Timoshenko's, of it.
};

class FreeSolidBar : public testing::TestWithParam<FreeBar> {};

// Steel, 2 m by 0.1 m by 0.1 m, ν = 0.3: 128.957 Hz with a shear factor of 5/6.
TEST_P(FreeSolidBar, VibratesWithTimoshenkosFrequencies) {
  const FreeBar& c = GetParam();
  System system;
  add_bar(system, c.bar, {2.0, 0.1, 0.1}, 0.0, 2e11, 7800.0, kFreeNode);
  system.finish();
  const ModesReport report = find_modes(system, system.initial_state(), {.count = 8});
  ASSERT_GE(report.modes.size(), 8u);
  EXPECT_TRUE(report.complete);
  for (int k = 0; k < 6; ++k) EXPECT_TRUE(report.modes[static_cast<std::size_t>(k)].rigid) << k;
  const double f = report.modes[6].frequency;
  EXPECT_NEAR(report.modes[7].frequency, f, 1e-3 * f);  // the other plane
  EXPECT_NEAR(f, 128.957, c.error * 128.957);
  if (c.first > 0.0) {
    EXPECT_NEAR(f, c.first, 0.006);  // printed to 0.01
  }
  RecordProperty("frequency", std::to_string(f));
}

INSTANTIATE_TEST_SUITE_P(Elements, FreeSolidBar,
                         testing::Values(FreeBar{{"hex8_eas9", "hex8", 20, 2}, 129.57, 0.006},
                                         FreeBar{{"hex8_eas9", "hex8", 40, 2}, 129.18, 0.003},
                                         FreeBar{{"hex20", "hex20", 10, 1}, 129.22, 0.003},
                                         FreeBar{{"hex20", "hex20", 20, 2}, 0.0, 0.001}),
                         [](const auto& test) {
                           const Bar& bar = test.param.bar;
                           return bar.element + "_" + std::to_string(static_cast<int>(bar.along));
                         });

struct CarriedBar {
  Bar bar;
  double first;  ///< [Hz]
};

class SolidBarOnABody : public testing::TestWithParam<CarriedBar> {};

// Frequencies of a body with a solid bonded to it: 2 kg, a bar of 6 m, free in space.
TEST_P(SolidBarOnABody, VibratesWithTheKnownFrequenciesOfItsMesh) {
  const CarriedBar& c = GetParam();
  System system;
  const int hub = system.add_body(
      {.name = "hub", .mass = 2.0, .inertia = Vec3(0.25, 0.30, 0.35).asDiagonal()}, {});
  add_bar(system, c.bar, {6.0, 0.5, 0.5}, 0.5, 2e4, 1.0, hub);
  system.finish();
  const ModesReport report = find_modes(system, system.initial_state(), {.count = 8});
  ASSERT_GE(report.modes.size(), 7u);
  EXPECT_TRUE(report.complete);
  EXPECT_TRUE(report.modes[5].rigid);
  EXPECT_FALSE(report.modes[6].rigid);
  EXPECT_NEAR(report.modes[6].frequency, c.first, 6e-5);  // printed to 1e-4
}

INSTANTIATE_TEST_SUITE_P(Elements, SolidBarOnABody,
                         testing::Values(CarriedBar{{"hex8_eas9", "hex8", 3, 1}, 1.2593},
                                         CarriedBar{{"hex8_eas9", "hex8", 6, 1}, 1.1709},
                                         CarriedBar{{"hex8_eas9", "hex8", 12, 1}, 1.1474},
                                         CarriedBar{{"hex8_eas9", "hex8", 24, 1}, 1.1414},
                                         CarriedBar{{"hex20", "hex20", 3, 1}, 1.1684},
                                         CarriedBar{{"hex20", "hex20", 6, 1}, 1.1441},
                                         CarriedBar{{"hex20", "hex20", 12, 1}, 1.1406}),
                         [](const auto& test) {
                           const Bar& bar = test.param.bar;
                           return bar.element + "_" + std::to_string(static_cast<int>(bar.along));
                         });

}  // namespace
}  // namespace polhode::solid_frequencies_tests
