// SPDX-License-Identifier: Apache-2.0
// A block between two smooth plates in plane strain: the homogeneous state satisfies the equations
// of every element at any compression. Elements with enhanced strains find it unstable where the
// solid is not (false wrinkles, "hourglassing").
#include <gtest/gtest.h>

#include <cmath>

#include <polhode/solids/materials/registry.hpp>
#include <polhode/solids/mesh/generators.hpp>
#include <polhode/solids/solid_elements.hpp>
#include <polhode/statics/statics.hpp>
#include <support/model_builder.hpp>

namespace polhode::compressed_block_tests {
namespace {

struct Compression {
  std::string element, shape;
  int cells;
  double stretch;
  int unstable;  ///< Directions in which an independent implementation finds the state unstable.
};

/// Ratio of bulk and shear modulus.
constexpr double kBulkOverShear = 1000.0;

class CompressedBlock : public testing::TestWithParam<Compression> {};

TEST_P(CompressedBlock, StaysHomogeneousAndHasTheStabilityOfItsElements) {
  const Compression& c = GetParam();
  const double n = c.cells;
  const solids::Mesh mesh = solids::make_mesh(
      "block", "block", {{"size", {1.0, 1.0 / n, 1.0}}, {"cells", {n, 1.0, n}}}, c.shape);
  System system;
  const auto still = std::make_shared<test::Constant>(0.0);
  const auto plate = std::make_shared<test::Constant>(c.stretch - 1.0);
  for (const Vec3& X : mesh.nodes) system.add_node({.position = X});
  for (int i = 0; i < static_cast<int>(mesh.nodes.size()); ++i) {
    const Vec3& X = mesh.nodes[static_cast<std::size_t>(i)];
    system.prescribe(i, 1, still);
    if (X.x() < -0.5 + 1e-9) system.prescribe(i, 0, still);
    if (X.z() < -0.5 + 1e-9) system.prescribe(i, 2, still);
    if (X.z() > 0.5 - 1e-9) system.prescribe(i, 2, plate);
  }
  solids::SolidElementsDescription d;
  d.name = "solids.block";
  d.element = c.element;
  d.material = solids::make_material("materials.m",
                                     {.kind = "mooney_rivlin_uncoupled",
                                      .values = {{"c1", 0.5}, {"bulk_modulus", kBulkOverShear}}});
  d.density = 1.0;
  d.connectivity = mesh.blocks.at(0).nodes;
  d.X = mesh.nodes;
  system.add_elements(solids::make_solid_elements(std::move(d)));
  system.finish();
  State state = system.initial_state();
  const StaticReport report = solve_statics(system, state, {.load_steps = 8});
  ASSERT_TRUE(report.converged) << report.message;
  // σ_xx = 0: the volume changes by less than the pressure, some μ/λ², over the bulk modulus.
  double side = 0.0;
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i)
    if (mesh.nodes[i].x() > 0.5 - 1e-9) side = std::max(side, state.node_x[3 * i] + 0.5);
  EXPECT_NEAR(side * c.stretch, 1.0, 2.0 / (kBulkOverShear * c.stretch * c.stretch));
  double uneven = 0.0;
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    const Vec3& X = mesh.nodes[i];
    const Vec3 x(-0.5 + side * (X.x() + 0.5), X.y(), -0.5 + c.stretch * (X.z() + 0.5));
    uneven = std::max(uneven, (x - Eigen::Map<const Vec3>(state.node_x.data() + 3 * i)).norm());
  }
  EXPECT_LT(uneven, 1e-9);
  EXPECT_LT(report.residual, 1e-9 * report.force + 1e-10);
  EXPECT_EQ(report.unstable, c.unstable);
}

INSTANTIATE_TEST_SUITE_P(Elements, CompressedBlock,
                         testing::Values(Compression{"hex8_q1p0", "hex8", 4, 0.6, 0},
                                         Compression{"hex20", "hex20", 4, 0.6, 0},
                                         Compression{"hex27", "hex27", 4, 0.6, 0},
                                         Compression{"tet10", "tet10", 4, 0.6, 0},
                                         Compression{"hex8_eas9", "hex8", 4, 0.7, 0},
                                         Compression{"hex8_eas9", "hex8", 2, 0.6, 1},
                                         Compression{"hex8_eas9", "hex8", 4, 0.6, 5}),
                         [](const auto& test) {
                           const Compression& c = test.param;
                           return c.element + "_" + std::to_string(c.cells) + "_at_" +
                                  std::to_string(static_cast<int>(std::lround(100 * c.stretch)));
                         });

}  // namespace
}  // namespace polhode::compressed_block_tests
