// SPDX-License-Identifier: Apache-2.0
// Order of convergence of quadratic elements.
#include <cmath>

#include <gtest/gtest.h>

#include <solids/solid_step.hpp>

#include <polhode/core/format.hpp>
#include <polhode/solids/mesh/generators.hpp>

namespace polhode::test::element_order_tests {
namespace {

/// Gradient of a harmonic polynomial of degree 4: a displacement without divergence and rotation
/// is in equilibrium in every linear material.
Vec3 exact(const Vec3& X) {
  const double x = X[0], y = X[1], z = X[2];
  // x⁴ − 6 x² y² + y⁴ + x y (x² + y² − 6 z²)
  return {4 * x * x * x - 12 * x * y * y + y * (3 * x * x + y * y - 6 * z * z),
          4 * y * y * y - 12 * x * x * y + x * (x * x + 3 * y * y - 6 * z * z), -12 * x * y * z};
}

/// Error in the mean square of a linear problem with the exact displacement on its boundary.
double error_of(const std::string& element, int n) {
  const solids::ElementKind& kind = solids::element_kind(element);
  const double cells = n;
  const solids::Mesh mesh = solids::make_mesh(
      "m", "block", {{"size", {1, 1, 1}}, {"cells", {cells, cells, cells}}}, kind.shape);
  const auto group = solids::make_solid_elements(
      {.name = "solids.block",
       .element = kind.name,
       .material = solids::make_material(
           "m", {.kind = "elastic", .values = {{"youngs_modulus", 1.0}, {"poisson_ratio", 0.3}}}),
       .density = 1000.0,
       .connectivity = mesh.blocks[0].nodes,
       .X = mesh.nodes});
  SolidStep step(mesh.nodes, context_of(1.0));
  step.begin(*group);
  step.stand_still();
  const Mat K = -step.evaluate(*group).tangent;
  std::vector<int> held, free;
  Vec u = Vec::Zero(step.x_n.size());
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    const bool outside = mesh.nodes[i].cwiseAbs().maxCoeff() > 0.4999;
    for (int c = 0; c < 3; ++c) {
      const int k = 3 * static_cast<int>(i) + c;
      (outside ? held : free).push_back(k);
      if (outside) u[k] = exact(mesh.nodes[i])[c];
    }
  }
  const Vec load = -K(free, held) * u(held);
  const Vec inside = Mat(K(free, free)).ldlt().solve(load);
  u(free) = inside;
  double sum = 0.0;
  const auto size = kind.cell().nodes.size();
  for (std::size_t e = 0; e < mesh.blocks[0].nodes.size(); e += size) {
    const int* own = mesh.blocks[0].nodes.data() + e;
    std::vector<Vec3> X(size);
    for (std::size_t a = 0; a < size; ++a) X[a] = mesh.nodes[static_cast<std::size_t>(own[a])];
    for (const solids::QuadraturePoint& p : kind.mass) {
      const Vec N = solids::shape_functions(kind.cell(), p.xi);
      Vec3 at = Vec3::Zero(), moved = Vec3::Zero();
      for (std::size_t a = 0; a < size; ++a) {
        at += N[static_cast<Eigen::Index>(a)] * X[a];
        moved += N[static_cast<Eigen::Index>(a)] * u.segment<3>(3 * own[a]);
      }
      sum += p.weight * solids::jacobian(kind.cell(), X.data(), p.xi) *
             (moved - exact(at)).squaredNorm();
    }
  }
  return std::sqrt(sum);
}

// Displacements of quadratic elements are of third order. Cells of one and two steps along a side
// are not yet so.
TEST(QuadraticElements, AreOfThirdOrder) {
  for (const char* element : {"hex20", "hex27", "tet10", "tet15", "wedge15"}) {
    const double two = error_of(element, 2), three = error_of(element, 3);
    RecordProperty(element, format("{:.3g}", three));
    EXPECT_NEAR(std::log(two / three) / std::log(1.5), 3.0, 0.3) << element;
    EXPECT_LT(three, 0.02) << element;
  }
}

}  // namespace
}  // namespace polhode::test::element_order_tests
