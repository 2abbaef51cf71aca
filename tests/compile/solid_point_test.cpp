// SPDX-License-Identifier: Apache-2.0
#include <polhode/compile/solid_point.hpp>

#include <gtest/gtest.h>
#include <polhode/core/error.hpp>
#include <polhode/solids/mesh/generators.hpp>

namespace polhode::solid_point_tests {
namespace {

/// Tolerance for the inverse map, which stops at 1e-12 of an element's size.
constexpr double kMapped = 1e-11;

/// Position of a point of the mesh, interpolated from its nodes.
Vec3 position(const solids::Mesh& mesh, const SolidPoint& point) { return point.value(mesh.nodes); }

TEST(SolidPoint, HasTheGivenPositionInEveryKindOfCell) {
  for (const char* cell :
       {"hex8", "hex20", "hex27", "tet4", "tet10", "tet15", "wedge6", "wedge15"}) {
    SCOPED_TRACE(cell);
    const solids::Mesh mesh = solids::make_mesh(
        "mesh", "cylinder", {{"diameter", {2.0}}, {"length", {3.0}}, {"cells", {2, 8, 3}}}, cell);
    for (const Vec3& X : {Vec3(0, 0, 0), Vec3(0.3, -0.2, 1.1), Vec3(-0.5, 0.4, -1.5)}) {
      const SolidPoint point = solid_point("probe", mesh, X);
      EXPECT_NEAR((position(mesh, point) - X).norm(), 0.0, kMapped);
      double sum = 0.0;
      for (const double w : point.weights) sum += w;
      EXPECT_NEAR(sum, 1.0, kMapped);
    }
  }
}

TEST(SolidPoint, IsTheNodeAtANode) {
  const solids::Mesh mesh =
      solids::make_mesh("mesh", "block", {{"size", {1, 1, 1}}, {"cells", {2, 2, 2}}}, "hex8");
  const SolidPoint point = solid_point("probe", mesh, mesh.nodes[13]);
  for (std::size_t k = 0; k < point.nodes.size(); ++k)
    EXPECT_NEAR(point.weights[k], point.nodes[k] == 13 ? 1.0 : 0.0, kMapped);
}

TEST(SolidPoint, OutsideIsRefusedWithTheNearestNode) {
  const solids::Mesh mesh =
      solids::make_mesh("mesh", "block", {{"size", {1, 1, 1}}, {"cells", {1, 1, 1}}}, "hex8");
  try {
    static_cast<void>(solid_point("output.probes.tip.point", mesh, Vec3(0.5, 0.5, 0.7)));
    FAIL() << "a point outside was found";
  } catch (const InputError& error) {
    EXPECT_EQ(error.where(), "output.probes.tip.point");
    EXPECT_NE(error.hint().find("(0.5, 0.5, 0.5), 0.2 m away"), std::string::npos) << error.hint();
  }
}

}  // namespace
}  // namespace polhode::solid_point_tests
