// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <polhode/geometry/triangle_tree.hpp>

#include "contact/shapes_for_tests.hpp"

namespace polhode::test::triangle_tree_tests {
namespace {

using geometry::TriangleTree;

TEST(TriangleTree, AgreesWithTestingAllTriangles) {
  const geometry::TriangleSurface ring = torus(0.35, 0.15);
  const geometry::TriangleTree tree(ring.points, ring.triangles);
  Random random(5);
  for (int k = 0; k < 300; ++k) {
    const Vec3 x = random.vector(0.8);
    double least = 1e9;
    std::vector<int> near;
    for (int t = 0; t < static_cast<int>(ring.triangles.size()); ++t) {
      const auto& c = ring.triangles[static_cast<std::size_t>(t)];
      const auto at = [&](std::size_t i) { return ring.points[static_cast<std::size_t>(c[i])]; };
      const double d = (x - geometry::nearest_on_triangle(x, at(0), at(1), at(2)).nearest).norm();
      least = std::min(least, d);
      if (d <= 0.1) near.push_back(t);
    }
    EXPECT_EQ(tree.nearest(x, 10.0).distance, least);
    EXPECT_EQ(tree.nearest(x, 1.001 * least).distance, least);
    EXPECT_EQ(tree.nearest(x, 0.999 * least).triangle, -1) << "there is no nearer triangle";
    std::vector<int> found = tree.near(x, 0.1);
    std::sort(found.begin(), found.end());
    EXPECT_TRUE(std::includes(found.begin(), found.end(), near.begin(), near.end()));
    EXPECT_LT(found.size(), ring.triangles.size() / 2);
    EXPECT_EQ(std::adjacent_find(found.begin(), found.end()), found.end());
  }
}

TEST(TriangleTree, ComputesTheWindingNumberOfASurface) {
  const double R = 0.35, r = 0.15;
  const geometry::TriangleSurface ring = torus(R, r, 48);
  const geometry::TriangleTree tree(ring.points, ring.triangles);
  // A second ring through the first.
  const int count = static_cast<int>(ring.points.size());
  geometry::TriangleSurface more = ring;
  const double shift = 0.2;
  for (const Vec3& x : ring.points) more.points.emplace_back(x + shift * Vec3::UnitX());
  for (const auto& t : ring.triangles)
    more.triangles.push_back({t[0] + count, t[1] + count, t[2] + count});
  const geometry::TriangleTree both(more.points, more.triangles);
  Random random(6);
  const auto depth = [&](const Vec3& x) {  // below zero outside the round ring
    return r - std::hypot(std::hypot(x[0], x[1]) - R, x[2]);
  };
  const double chord = 0.02;  // distance of the triangles from the exact torus
  int within = 0;
  for (int k = 0; k < 2000; ++k) {
    const Vec3 x = random.vector(0.6);
    const double d = depth(x), e = depth(x - shift * Vec3::UnitX());
    if (std::abs(d) < chord || std::abs(e) < chord) continue;
    EXPECT_EQ(tree.winding(x), d > 0.0 ? 1 : 0);
    EXPECT_EQ(both.winding(x), (d > 0.0 ? 1 : 0) + (e > 0.0 ? 1 : 0));
    within += d > 0.0 && e > 0.0 ? 1 : 0;
  }
  EXPECT_GT(within, 20) << "points in both";
}

}  // namespace
}  // namespace polhode::test::triangle_tree_tests
