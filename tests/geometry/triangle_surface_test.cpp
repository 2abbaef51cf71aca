// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include <polhode/core/error.hpp>
#include <polhode/geometry/shapes.hpp>
#include <polhode/geometry/triangle_surface.hpp>
#include <polhode/math/exp_map.hpp>

namespace polhode::triangle_surface_tests {
namespace {

geometry::TriangleSurface tetrahedron() {
  return {.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
          .triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
}

geometry::TriangleSurface box() {
  const double sizes[] = {2.0, 1.0, 0.5};
  return geometry::shape_surface(*geometry::find_shape_kind("box"), sizes);
}

std::string refusal(const geometry::TriangleSurface& surface) {
  try {
    geometry::check_closed("part.stl", surface);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

TEST(SurfaceMassProperties, OfTheCornerTetrahedronAreItsClosedForms) {
  // ∫ x² = 1/60 and ∫ xy = 1/120 over the tetrahedron of the unit axes, V = 1/6, centroid 1/4.
  const geometry::MassProperties found = geometry::mass_properties(tetrahedron(), 6.0);
  EXPECT_NEAR(found.mass, 1.0, 1e-15);
  EXPECT_LT((found.com - Vec3::Constant(0.25)).norm(), 1e-15);
  const double central_square = 6.0 / 60.0 - 1.0 / 16.0;
  const double central_product = 6.0 / 120.0 - 1.0 / 16.0;
  Mat3 J = Mat3::Constant(-central_product);
  J.diagonal().setConstant(2.0 * central_square);
  EXPECT_LT((found.inertia - J).norm(), 1e-15);
}

TEST(SurfaceMassProperties, TransformWithTheMotionOfTheSurface) {
  const Mat3 R = exp_map(Vec3(0.7, -0.4, 1.3));
  const Vec3 p(1e3, -2e3, 5e2);  // far away, to test cancellation in the parallel-axes terms
  geometry::TriangleSurface moved = tetrahedron();
  for (Vec3& x : moved.points) x = p + R * x;
  const geometry::MassProperties expected =
      geometry::placed(geometry::mass_properties(tetrahedron(), 6.0), p, R);
  const geometry::MassProperties found = geometry::mass_properties(moved, 6.0);
  // Coordinates of 2e3 m are rounded to 2e-13 m.
  EXPECT_NEAR(found.mass, expected.mass, 3e-12);
  EXPECT_LT((found.com - expected.com).norm(), 3e-12);
  EXPECT_LT((found.inertia - expected.inertia).norm(), 3e-12);
}

TEST(SurfaceMassProperties, TreatAnInnerShellThatFacesInwardAsACavity) {
  geometry::TriangleSurface hollow = box();
  geometry::TriangleSurface inner = geometry::scaled(box(), 0.5);
  const int shift = static_cast<int>(hollow.points.size());
  hollow.points.insert(hollow.points.end(), inner.points.begin(), inner.points.end());
  for (const auto& [a, b, c] : inner.triangles)
    hollow.triangles.push_back({a + shift, c + shift, b + shift});
  EXPECT_EQ(refusal(hollow), "");
  // A share 1/8 of the mass and 1/32 of the inertia is missing.
  const geometry::MassProperties solid = geometry::mass_properties(box(), 1.0);
  const geometry::MassProperties found = geometry::mass_properties(hollow, 1.0);
  EXPECT_NEAR(found.mass, 7.0 / 8.0 * solid.mass, 1e-15);
  EXPECT_LT((found.inertia - 31.0 / 32.0 * solid.inertia).norm(), 1e-15);
}

TEST(CheckClosed, AcceptsAClosedSurface) { EXPECT_EQ(refusal(tetrahedron()), ""); }

TEST(CheckClosed, CountsOpenEdgesAndLocatesTheFirst) {
  geometry::TriangleSurface open = tetrahedron();
  open.triangles.pop_back();
  EXPECT_EQ(refusal(open),
            "part.stl: the surface is not closed: 3 of its edges belong to one triangle only and 0 "
            "to more than two, the first from (1, 0, 0) to (0, 1, 0). A density needs a closed "
            "surface: repair it in the program that made it, or give mass and inertia.");
}

TEST(CheckClosed, CountsEdgesOfMoreThanTwoTriangles) {
  geometry::TriangleSurface shared = tetrahedron();
  shared.triangles.push_back({0, 1, 3});
  EXPECT_EQ(geometry::edge_report(shared).shared, 3);
  EXPECT_NE(refusal(shared).find("3 to more than two"), std::string::npos);
}

TEST(CheckClosed, DetectsATriangleOfOppositeOrientation) {
  geometry::TriangleSurface surface = tetrahedron();
  std::swap(surface.triangles[3][0], surface.triangles[3][1]);
  EXPECT_EQ(refusal(surface),
            "part.stl: the triangles are not oriented consistently: at 3 edges neighbours have "
            "opposite orientations, the first from (1, 0, 0) to (0, 1, 0). A density needs a "
            "closed surface: repair it in the program that made it, or give mass and inertia.");
}

TEST(CheckClosed, RefusesASheetFoldedOntoItself) {
  const geometry::TriangleSurface sheet{.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
                                        .triangles = {{0, 1, 2}, {0, 2, 1}}};
  EXPECT_NE(refusal(sheet).find("encloses no volume (its area is 1 m²)"), std::string::npos);
}

TEST(CheckClosed, RefusesASurfaceWithoutTriangles) {
  EXPECT_EQ(refusal({}),
            "part.stl: the surface has no triangles. Export it again as a triangle mesh.");
}

TEST(OrientOutward, FlipsOnlySurfacesThatFaceInward) {
  geometry::TriangleSurface inward = tetrahedron();
  for (auto& corners : inward.triangles) std::swap(corners[0], corners[1]);
  EXPECT_LT(geometry::signed_volume(inward), 0.0);
  EXPECT_TRUE(geometry::orient_outward(inward));
  EXPECT_NEAR(geometry::signed_volume(inward), 1.0 / 6.0, 1e-16);
  EXPECT_FALSE(geometry::orient_outward(inward));
  EXPECT_EQ(refusal(inward), "");
}

TEST(JoinEqualPoints, MergesEqualPointsAndDropsCollapsedTriangles) {
  geometry::TriangleSurface soup;
  const geometry::TriangleSurface solid = tetrahedron();
  for (const auto& corners : solid.triangles) {
    const int first = static_cast<int>(soup.points.size());
    for (const int corner : corners)
      soup.points.push_back(solid.points[static_cast<std::size_t>(corner)]);
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  soup.points.emplace_back(-0.0, 0.0, -0.0);  // equal to the first point
  soup.triangles.push_back({0, 1, 12});
  geometry::join_equal_points(soup);
  EXPECT_EQ(soup.points.size(), 4U);
  EXPECT_EQ(soup.triangles.size(), 4U);
  EXPECT_EQ(refusal(soup), "");
  EXPECT_NEAR(geometry::signed_volume(soup), 1.0 / 6.0, 1e-16);
}

}  // namespace
}  // namespace polhode::triangle_surface_tests
