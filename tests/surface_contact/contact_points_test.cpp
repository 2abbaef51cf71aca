// SPDX-License-Identifier: Apache-2.0
// Quadrature points of flat faces that lie on each other.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include <polhode/surface_contact/mesh_surface.hpp>

namespace polhode::test::contact_points_tests {
namespace {

using surface_contact::contact_points;
using surface_contact::MeshPoint;

/// n × m quadrilaterals of a square in the plane z, facing up or down.
solids::LoadedFaces square(std::vector<Vec3>& X, int n, int m, double size, double z, bool up,
                           double turn = 0.0) {
  solids::LoadedFaces faces{"quad4", {}};
  const int first = static_cast<int>(X.size());
  for (int j = 0; j <= m; ++j)
    for (int i = 0; i <= n; ++i) {
      const double x = size * (static_cast<double>(i) / n - 0.5),
                   y = size * (static_cast<double>(j) / m - 0.5);
      X.emplace_back(std::cos(turn) * x - std::sin(turn) * y,
                     std::sin(turn) * x + std::cos(turn) * y, z);
    }
  for (int j = 0; j < m; ++j)
    for (int i = 0; i < n; ++i) {
      const int a = first + j * (n + 1) + i;
      if (up)
        faces.nodes.insert(faces.nodes.end(), {a, a + 1, a + n + 2, a + n + 1});
      else
        faces.nodes.insert(faces.nodes.end(), {a, a + n + 1, a + n + 2, a + 1});
    }
  return faces;
}

Vec3 place(const MeshPoint& p, const std::vector<Vec3>& X) {
  Vec3 at = Vec3::Zero();
  for (int a = 0; a < p.count; ++a) at += p.N[a] * X[static_cast<std::size_t>(p.node[a])];
  return at;
}

/// Under the border of a smaller square, straight or turned, no point lies on the border itself,
/// from where it could go two ways. Area and second moments of the part below the smaller square
/// are exact. The strips of the larger one have their nodes beside it.
// @tests{mesh-contact}
TEST(ContactPoints, LieInsideOfTheBorderOfTheOtherSurface) {
  constexpr double kSmall = 1.0, kLarge = 2.0;
  for (const double turn : {0.0, 0.3})
    for (const int above : {1, 2, 5})
      for (const int strips : {1, 3, 4, 8}) {
        SCOPED_TRACE(testing::Message() << turn << ' ' << above << ' ' << strips);
        std::vector<Vec3> X;
        const solids::LoadedFaces low = square(X, strips, 1, kLarge, 0.0, true),
                                  high = square(X, above, above, kSmall, 0.01, false, turn);
        const surface_contact::MeshSurface other = surface_contact::triangulated({high});
        double area = 0.0, within = 0.0, moment = 0.0, mixed = 0.0;
        for (const MeshPoint& p : contact_points("c", {low}, X, &other)) {
          const Vec3 x = place(p, X);
          const double u = std::cos(turn) * x[0] + std::sin(turn) * x[1],
                       v = -std::sin(turn) * x[0] + std::cos(turn) * x[1];
          area += p.area;
          if (p.count == 1) continue;  // a node has what is left of its faces
          EXPECT_LT(std::max(std::abs(u), std::abs(v)), 0.5 * kSmall * (1.0 - 1e-3));
          within += p.area;
          moment += p.area * u * u;
          mixed += p.area * u * v;
        }
        EXPECT_NEAR(area, kLarge * kLarge, 1e-12);
        EXPECT_NEAR(within, kSmall * kSmall, 1e-12);
        EXPECT_NEAR(moment, std::pow(kSmall, 4) / 12.0, 1e-12);
        EXPECT_NEAR(mixed, 0.0, 1e-12);
      }
}

/// The points of two squares with the same border, which lie inside of it.
// @tests{mesh-contact}
TEST(ContactPoints, OfEqualSquaresLieInside) {
  for (const int n : {1, 2, 3}) {
    std::vector<Vec3> X;
    const solids::LoadedFaces low = square(X, n, n, 1.0, 0.0, true),
                              high = square(X, 2, 2, 1.0, 0.01, false);
    const surface_contact::MeshSurface other = surface_contact::triangulated({high});
    double area = 0.0, mixed = 0.0, square_moment = 0.0;
    for (const MeshPoint& p : contact_points("c", {low}, X, &other)) {
      const Vec3 x = place(p, X);
      EXPECT_LT(x.head<2>().lpNorm<Eigen::Infinity>(), 0.5 - 1e-3);
      area += p.area;
      mixed += p.area * x[0] * x[1];
      square_moment += p.area * x[1] * x[1];
    }
    EXPECT_NEAR(area, 1.0, 1e-13);
    EXPECT_NEAR(mixed, 0.0, 1e-13);
    EXPECT_NEAR(square_moment, 1.0 / 12.0, 1e-13);
  }
}

}  // namespace
}  // namespace polhode::test::contact_points_tests
