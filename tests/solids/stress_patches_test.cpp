// SPDX-License-Identifier: Apache-2.0
// Polynomials fitted to values at scattered points.
#include <polhode/solids/stress_patches.hpp>

#include <cmath>

#include <gtest/gtest.h>

#include <polhode/solids/mesh/generators.hpp>

namespace polhode::stress_patches_tests {
namespace {

/// Values of a field at points, in the first column.
template <class Field>
double fitted(const solids::CloudFit& fit, const std::vector<Vec3>& points, const Field& field,
              const Vec3& at) {
  solids::CloudFit::Coefficients moments =
      solids::CloudFit::Coefficients::Zero(fit.size(), solids::kRecovered);
  for (const Vec3& X : points) moments.col(0) += fit.monomials(X) * field(X);
  return fit.monomials(at).dot(fit.coefficients(moments).col(0));
}

/// Two points in each of the cells along an axis, where the stress of quadratic elements is best.
std::vector<double> best(int cells) {
  std::vector<double> x;
  for (int i = 0; i < cells; ++i)
    for (const double side : {-1.0, 1.0}) x.push_back(i + 0.5 * (1.0 + side / std::sqrt(3.0)));
  return x;
}

std::vector<Vec3> cloud(int nx, int ny, int nz, const Mat3& shape) {
  std::vector<Vec3> points;
  for (const double x : best(nx))
    for (const double y : best(ny))
      for (const double z : best(nz)) points.emplace_back(shape * Vec3(x, y, z));
  return points;
}

// Stretched by up to a thousand, turned and sheared.
const Mat3 kShapes[] = {Mat3::Identity(),
                        (Mat3() << 0.3, 0.1, 0, -0.2, 0.5, 0.2, 0.1, 0, 0.4).finished(),
                        (Mat3() << 10, 0, 0.001, 0, 5, 0.002, 0.01, 0.02, 0.01).finished()};

// @tests{stress-patch}
TEST(CloudFit, IsExactForQuadraticsWhereTwoCellsMeetInEveryDirection) {
  for (const Mat3& shape : kShapes) {
    const std::vector<Vec3> points = cloud(2, 2, 2, shape);
    const solids::CloudFit fit(points, 2);
    EXPECT_EQ(fit.terms(), 10);
    const Mat3 back = shape.inverse();
    const auto field = [&](const Vec3& X) {
      const Vec3 x = back * X;
      return 1.0 + x[0] - 2.0 * x[1] + x[0] * x[2] + 3.0 * x[1] * x[1] - x[2] * x[2];
    };
    for (const Vec3& x : {Vec3(0, 0, 0), Vec3(2, 2, 2), Vec3(0.3, 1.7, 2)})
      EXPECT_NEAR(fitted(fit, points, field, shape * x), field(shape * x), 1e-8);
  }
}

// A lattice of points is rotated as a whole: complete polynomials do not depend on axes.
TEST(CloudFit, IsExactForQuadraticsOfManyPointsInAnyOrientation) {
  const Mat3 turn = (Mat3() << 0.36, 0.48, -0.8, -0.8, 0.6, 0.0, 0.48, 0.64, 0.6).finished();
  const auto field = [](const Vec3& X) {
    return 1.0 + X[0] * X[1] - 2.0 * X[1] * X[1] + X[0] * X[2] + X[2];
  };
  for (const Mat3& shape : {Mat3(Mat3::Identity()), turn}) {
    const std::vector<Vec3> points = cloud(3, 3, 3, shape);
    const solids::CloudFit fit(points, 2);
    EXPECT_EQ(fit.terms(), 10);
    for (const Vec3& x : {Vec3(0, 0, 0), Vec3(3, 3, 3), Vec3(0.3, 1.7, 3)})
      EXPECT_NEAR(fitted(fit, points, field, shape * x), field(shape * x), 1e-10);
  }
}

// @tests{stress-patch}
TEST(CloudFit, IsExactForProductsOfSquaresAlongDirections) {
  for (const Mat3& shape : kShapes) {
    const std::vector<Vec3> points = cloud(2, 2, 2, shape), layer = cloud(2, 2, 1, shape);
    EXPECT_EQ(solids::CloudFit(points, 2, &shape).terms(), 27);
    EXPECT_EQ(solids::CloudFit(layer, 2, &shape).terms(), 18);
    const Mat3 back = shape.inverse();
    const auto field = [&](const Vec3& X) {
      const Vec3 x = back * X;
      return (1.0 + x[0] - x[0] * x[0]) * (2.0 - x[1] * x[1]) * (1.0 - 3.0 * x[2]);
    };
    for (const Vec3& x : {Vec3(0, 0, 0), Vec3(2, 2, 1), Vec3(0.3, 1.7, 1)}) {
      EXPECT_NEAR(fitted(solids::CloudFit(points, 2, &shape), points, field, shape * x),
                  field(shape * x), 1e-7);
      EXPECT_NEAR(fitted(solids::CloudFit(layer, 2, &shape), layer, field, shape * x),
                  field(shape * x), 1e-7);
    }
  }
}

// The points of one cell cannot distinguish a square from a constant: such terms are omitted.
TEST(CloudFit, LeavesOutTermsThatThePointsDoNotDetermine) {
  for (const Mat3& shape : kShapes) {
    const Mat3 back = shape.inverse();
    const auto product = [&](const Vec3& X) {  // bending
      const Vec3 x = back * X;
      return (2.0 - x[0]) * (x[2] - 0.5);
    };
    const std::vector<Vec3> layer = cloud(2, 2, 1, shape), one = cloud(1, 1, 1, shape);
    EXPECT_EQ(solids::CloudFit(layer, 2).terms(), 9);
    EXPECT_EQ(solids::CloudFit(one, 2).terms(), 7);
    for (const auto* points : {&layer, &one}) {
      const solids::CloudFit fit(*points, 2);
      const Vec3 corner = shape * Vec3(0, 0, 1);
      EXPECT_NEAR(fitted(fit, *points, product, corner), 1.0, 1e-8);
      EXPECT_NEAR(fitted(
                      fit, *points, [](const Vec3&) { return 4.0; }, corner),
                  4.0, 1e-9);
    }
  }
  const std::vector<Vec3> point{Vec3(1, 2, 3)};
  EXPECT_EQ(solids::CloudFit(point, 1).terms(), 1);
  EXPECT_NEAR(fitted(
                  solids::CloudFit(point, 1), point, [](const Vec3&) { return 7.0; }, Vec3::Zero()),
              7.0, 1e-14);
}

/// A field at the nodes of a tube, from corner values that interpolate it linearly in each element
/// where its error vanishes: third order, at the boundary too.
double largest_error(const char* cell, double n) {
  const solids::Mesh mesh = solids::make_mesh(
      "tube", "tube", {{"outer", {2}}, {"inner", {1}}, {"length", {0.2}}, {"cells", {n, 8 * n, 1}}},
      cell);
  const auto field = [](const Vec3& X) { return 1.0 / X.head<2>().squaredNorm(); };
  const int corners = mesh.element_shape(0).corners;
  solids::RecoveredValues at_corners = solids::RecoveredValues::Zero(
      static_cast<Eigen::Index>(corners) * mesh.element_count(), solids::kRecovered);
  for (int e = 0; e < mesh.element_count(); ++e)
    for (int c = 0; c < corners; ++c) {
      // Linear between points at 1/√3 of the distance from the middle.
      const solids::CellShape& shape = mesh.element_shape(e);
      double sum = 0.0;
      const double out = corners == 8 ? std::sqrt(3.0) : 1.0;
      for (int k = 0; k < corners; ++k) {
        const Vec3 at = shape.nodes[static_cast<std::size_t>(k)] / out;
        Vec3 X = Vec3::Zero();
        const Vec N = solids::shape_functions(shape, at);
        for (int a = 0; a < shape.size(); ++a)
          X += N[a] * mesh.nodes[static_cast<std::size_t>(
                          mesh.element_nodes(e)[static_cast<std::size_t>(a)])];
        const Vec share = solids::shape_functions(
            solids::cell_shape("hex8"), shape.nodes[static_cast<std::size_t>(c)] * std::sqrt(3.0));
        sum += share[k] * field(X);
      }
      at_corners(e * corners + c, 0) = sum;
    }
  const solids::RecoveredValues values = solids::StressPatches(mesh).at_nodes(at_corners);
  double worst = 0.0;
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i)
    worst =
        std::max(worst, std::abs(values(static_cast<Eigen::Index>(i), 0) - field(mesh.nodes[i])));
  return worst;
}

TEST(StressPatches, AreOfAboutThirdOrderUpToTheBoundary) {
  for (const char* cell : {"hex20", "hex27"}) {
    const double two = largest_error(cell, 2), four = largest_error(cell, 4),
                 eight = largest_error(cell, 8);
    EXPECT_LT(two, 0.06 * 4.0) << cell;  // of 4 at the inner radius
    EXPECT_GT(std::log2(two / four), 1.8) << cell;
    EXPECT_GT(std::log2(four / eight), 2.2) << cell;
  }
}

TEST(StressPatches, SuitQuadraticCellsAndTet4) {
  for (const char* cell : {"hex20", "hex27", "tet4", "tet10", "hex8", "wedge6", "wedge15"}) {
    const solids::Mesh mesh =
        solids::make_mesh("m", "block", {{"size", {1, 1, 1}}, {"cells", {1, 1, 1}}}, cell);
    EXPECT_EQ(solids::StressPatches::suit(mesh),
              cell != std::string("hex8") && !std::string_view(cell).starts_with("wedge"));
  }
}

}  // namespace
}  // namespace polhode::stress_patches_tests
