// SPDX-License-Identifier: Apache-2.0
// Cook's membrane: corners (0,0), (48,44), (48,60), (0,44), plane strain, clamped at the left,
// sheared by a dead traction of 100/16 at the right. References of the same elements on the same
// meshes by an independent implementation in Python, and their extrapolation; docs/validation.md
// has the table.
#include <gtest/gtest.h>

#include <cmath>

#include <polhode/solids/loads/traction.hpp>
#include <polhode/solids/materials/registry.hpp>
#include <polhode/solids/mesh/generators.hpp>
#include <polhode/solids/mesh/selection.hpp>
#include <polhode/solids/solid_elements.hpp>
#include <polhode/statics/statics.hpp>
#include <statics/static_models.hpp>

namespace polhode::cook_membrane_tests {
namespace {

constexpr double kShear = 80.1938;

solids::MaterialDescription compressible() {
  return {.kind = "neo_hookean",
          .values = {{"youngs_modulus", 2.6 * kShear}, {"poisson_ratio", 0.3}}};
}
solids::MaterialDescription nearly_incompressible() {
  return {.kind = "mooney_rivlin_uncoupled",
          .values = {{"c1", 0.5 * kShear}, {"c2", 0.0}, {"bulk_modulus", 5000.0 * kShear}}};
}

struct Cook {
  StaticReport report;
  double corner = 0.0, middle = 0.0;  ///< u_y at (48,60) and (48,52).
};

Cook cook(const std::string& element, const std::string& shape, int n,
          const solids::MaterialDescription& material) {
  solids::Mesh mesh = solids::make_mesh(
      "cook", "block", {{"size", {1.0, 1.0, 1.0}}, {"cells", {double(n), double(n), 1.0}}}, shape);
  for (Vec3& X : mesh.nodes) {
    const double s = X.x() + 0.5, t = X.y() + 0.5;
    X = {48.0 * s, 44.0 * s + t * (44.0 * (1.0 - s) + 16.0 * s), X.z()};
  }
  System system;
  const auto still = std::make_shared<test::Constant>(0.0);
  for (const Vec3& X : mesh.nodes)
    system.add_node({.position = X, .body = X.x() < 1e-9 ? kGround : kFreeNode});
  for (int i = 0; i < static_cast<int>(mesh.nodes.size()); ++i)
    if (mesh.nodes[i].x() >= 1e-9) system.prescribe(i, 2, still);
  solids::SolidElementsDescription d;
  d.name = "solids.membrane";
  d.element = element;
  d.material = solids::make_material("materials.m", material);
  d.density = 1.0;
  d.connectivity = mesh.blocks.at(0).nodes;
  d.X = mesh.nodes;
  system.add_elements(solids::make_solid_elements(std::move(d)));
  std::vector<solids::LoadedFaces> faces;
  solids::Selection right;
  right.kind = solids::Selection::Kind::kPlane;
  right.normal = Vec3::UnitX();
  right.level = solids::Selection::Level::kMax;
  for (const solids::FaceBlock& block : solids::select_faces("right", mesh, {right}).blocks)
    faces.push_back({block.type, block.nodes});
  system.add_elements(solids::make_traction("loads.shear", faces, mesh.nodes,
                                            test::constant({0, 100.0 / 16.0, 0})));
  system.finish();
  State state = system.initial_state();
  Cook result;
  result.report = solve_statics(system, state);
  for (int i = 0; i < static_cast<int>(mesh.nodes.size()); ++i) {
    const Vec3 X = mesh.nodes[i];
    if (std::abs(X.x() - 48.0) > 1e-9 || std::abs(X.z() + 0.5) > 1e-9) continue;
    const double u = state.node_x[3 * i + 1] - X.y();
    if (std::abs(X.y() - 60.0) < 1e-9) result.corner = u;
    if (std::abs(X.y() - 52.0) < 1e-9) result.middle = u;
  }
  return result;
}

struct CookCase {
  std::string element, shape;
  int n;
  bool incompressible;
  double corner, middle;  ///< Of this mesh; 0: not known.
  double error;           ///< Bound on the distance from the extrapolated value.
};

class CooksMembrane : public testing::TestWithParam<CookCase> {};

TEST_P(CooksMembrane, HasThePublishedDisplacement) {
  const CookCase& c = GetParam();
  const Cook result =
      cook(c.element, c.shape, c.n, c.incompressible ? nearly_incompressible() : compressible());
  ASSERT_TRUE(result.report.converged) << result.report.message;
  EXPECT_EQ(result.report.steps.size(), 1u);
  EXPECT_EQ(result.report.unstable, 0);
  // The references are printed to 1e-4.
  if (c.corner > 0.0) {
    EXPECT_NEAR(result.corner, c.corner, 1e-4);
    EXPECT_NEAR(result.middle, c.middle, 1e-4);
  }
  EXPECT_NEAR(result.middle, c.incompressible ? 6.957 : 8.893, c.error);
  RecordProperty("iterations", result.report.iterations);
}

// Errors at the middle fall with order 1.2 to 1.7, for the singular corner at the clamp.
INSTANTIATE_TEST_SUITE_P(
    Elements, CooksMembrane,
    testing::Values(CookCase{"hex27", "hex27", 4, false, 8.5906, 8.8331, 0.07},
                    CookCase{"hex27", "hex27", 8, false, 8.6590, 8.8753, 0.025},
                    CookCase{"hex20", "hex20", 16, false, 8.6776, 8.8807, 0.02},
                    CookCase{"hex8_eas9", "hex8", 16, false, 0.0, 0.0, 0.02},
                    CookCase{"hex8_eas9", "hex8", 32, false, 8.6806, 8.8900, 0.01},
                    CookCase{"hex8_q1p0", "hex8", 8, true, 6.6186, 6.6696, 0.3},
                    CookCase{"hex8_q1p0", "hex8", 16, true, 6.8144, 6.8566, 0.11}),
    [](const auto& test) { return test.param.element + "_" + std::to_string(test.param.n); });

}  // namespace
}  // namespace polhode::cook_membrane_tests
