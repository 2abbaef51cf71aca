// SPDX-License-Identifier: Apache-2.0
// Limit loads of equilibria: the load steps must end at the limit, neither before nor after, at the
// last equilibrium, with a message, or find a distant equilibrium.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include <polhode/solids/loads/traction.hpp>
#include <polhode/solids/materials/registry.hpp>
#include <polhode/solids/mesh/generators.hpp>
#include <polhode/solids/solid_elements.hpp>
#include <polhode/statics/statics.hpp>
#include <statics/static_models.hpp>

namespace polhode::limit_load_tests {
namespace {

using testing::HasSubstr;

/// Tolerance for the limit: load steps end when 1e-4 of the whole load cannot be added.
constexpr double kResolution = 4e-4;

/// A weight on a vertical guide between two inclined springs, a shallow roof: the force is 2k (L₀ −
/// L) z/L, largest where L³ = L₀ b².
constexpr double kHalfSpan = 1.0, kRise = 0.4, kStiffness = 1000.0;

double push(double z) {
  const double L = std::hypot(kHalfSpan, z), L_0 = std::hypot(kHalfSpan, kRise);
  return 2.0 * kStiffness * (L_0 - L) * z / L;
}

/// Height and report under a load.
std::pair<double, StaticReport> roof(double load) {
  System system;
  const int top = test::add_body(system, "ridge", 1.0, {0, 0, kRise});
  test::add_joint(system, "prismatic", "guide", kGround, top, {0, 0, kRise}, Vec3::Zero());
  for (const double side : {-1.0, 1.0})
    test::add_load(
        system, "spring_damper",
        {.name = side < 0.0 ? "left" : "right",
         .bodies = {kGround, top},
         .Z_a = Vec3(side * kHalfSpan, 0, 0),
         .values = {{"stiffness", kStiffness}, {"free_length", std::hypot(kHalfSpan, kRise)}}});
  test::add_load(
      system, "force",
      {.name = "snow", .bodies = {kGround, top}, .vector = test::constant({0, 0, -load})});
  system.finish();
  State state = system.initial_state();
  const StaticReport report = solve_statics(system, state);
  return {system.motion(state, top).r.z(), report};
}

TEST(LimitLoad, OfAShallowRoofIsReachedAndPassedBySnapThrough) {
  const double L = std::cbrt(std::hypot(kHalfSpan, kRise) * kHalfSpan * kHalfSpan);
  const double height = std::sqrt(L * L - kHalfSpan * kHalfSpan), limit = push(height);
  const auto [below, carried] = roof(0.99 * limit);
  ASSERT_TRUE(carried.converged) << carried.message;
  EXPECT_EQ(carried.unstable, 0);
  EXPECT_GT(below, height);
  EXPECT_NEAR(push(below), 0.99 * limit, 1e-9 * limit);
  const auto [beyond, snapped] = roof(1.25 * limit);
  ASSERT_TRUE(snapped.converged) << snapped.message;
  EXPECT_EQ(snapped.unstable, 0);
  EXPECT_LT(beyond, -kRise);
  EXPECT_NEAR(push(beyond), 1.25 * limit, 1e-9 * limit);
}

/// A bar of St. Venant-Kirchhoff's material under axial compression, ν = 0: P = E λ(1 − λ²)/2 is
/// largest at λ = 1/√3.
TEST(LimitLoad, OfASolidOfSaintVenantsMaterialIsThatOfItsClosedForm) {
  const double limit = 1.0 / (3.0 * std::sqrt(3.0));
  const solids::Mesh mesh =
      solids::make_mesh("bar", "block", {{"size", {0.5, 0.5, 1}}, {"cells", {1, 1, 2}}}, "hex20");
  System system;
  for (const Vec3& X : mesh.nodes)
    system.add_node({.position = X, .body = X.z() < -0.5 + 1e-9 ? kGround : kFreeNode});
  solids::SolidElementsDescription d;
  d.name = "solids.bar";
  d.element = "hex20";
  d.material = solids::make_material(
      "materials.m",
      {.kind = "elastic", .values = {{"youngs_modulus", 1.0}, {"poisson_ratio", 0.0}}});
  d.density = 1.0;
  d.connectivity = mesh.blocks.at(0).nodes;
  d.X = mesh.nodes;
  system.add_elements(solids::make_solid_elements(std::move(d)));
  // Guided, so that it does not buckle sideways.
  const auto still = std::make_shared<test::Constant>(0.0);
  for (int i = 0; i < static_cast<int>(mesh.nodes.size()); ++i)
    if (mesh.nodes[static_cast<std::size_t>(i)].z() >= -0.5 + 1e-9)
      for (const int c : {0, 1}) system.prescribe(i, c, still);
  std::vector<solids::LoadedFaces> top;
  for (const solids::FaceBlock& block : mesh.surfaces.at("zmax").blocks)
    top.push_back({block.type, block.nodes});
  system.add_elements(
      solids::make_traction("loads.press", top, mesh.nodes, test::constant({0, 0, -2.0 * limit})));
  system.finish();
  State state = system.initial_state();
  const StaticReport report = solve_statics(system, state);
  EXPECT_FALSE(report.converged);
  EXPECT_LE(report.load_factor, 0.5 + 1e-9);
  EXPECT_GE(report.load_factor, 0.5 - kResolution);
  EXPECT_EQ(report.unstable, 0);
  EXPECT_THAT(report.message, HasSubstr("of 'solids.bar'"));
  double height = 0.0;
  for (std::size_t k = 2; k < state.node_x.size(); k += 3)
    height = std::max(height, state.node_x[k] + 0.5);
  EXPECT_NEAR(height, 1.0 / std::sqrt(3.0), 0.03);
}

}  // namespace
}  // namespace polhode::limit_load_tests
