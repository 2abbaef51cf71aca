// SPDX-License-Identifier: Apache-2.0
// Extrapolation of values from points of integration to nodes.
#include <gtest/gtest.h>

#include <cmath>

#include <polhode/solids/elements/extrapolation.hpp>

namespace polhode::extrapolation_tests {
namespace {

/// Fields in the space of an element's polynomials are extrapolated to its nodes exactly.
// @tests{nodal-stress}
TEST(Extrapolation, IsExactForThePolynomialsOfEveryKindOfElement) {
  for (const solids::ElementKind& kind : solids::element_kinds()) {
    const solids::Extrapolation E = solids::extrapolation(kind);
    const solids::CellShape& cell = kind.cell();
    ASSERT_EQ(E.rows(), cell.size()) << kind.name;
    ASSERT_EQ(E.cols(), static_cast<Eigen::Index>(kind.stiffness.size())) << kind.name;
    const bool one = kind.stiffness.size() == 1, hexahedron = cell.corners == 8;
    const auto field = [&](const Vec3& x) {
      double f = 2.0;
      if (one) return f;
      f += 0.7 * x[0] - 1.1 * x[1] + 0.4 * x[2];
      if (hexahedron) f += 0.3 * x[0] * x[1] - 0.2 * x[1] * x[2] + 0.9 * x[0] * x[1] * x[2];
      if (cell.corners == 6) f += 0.5 * x[0] * x[2];
      return f;
    };
    Vec at_points(E.cols());
    for (Eigen::Index q = 0; q < E.cols(); ++q)
      at_points[q] = field(kind.stiffness[static_cast<std::size_t>(q)].xi);
    const Vec at_nodes = E * at_points;
    for (Eigen::Index a = 0; a < E.rows(); ++a)
      EXPECT_NEAR(at_nodes[a], field(cell.nodes[static_cast<std::size_t>(a)]), 1e-13)
          << kind.name << ", node " << a;
  }
}

}  // namespace
}  // namespace polhode::extrapolation_tests
