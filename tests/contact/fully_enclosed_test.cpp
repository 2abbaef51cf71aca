// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <polhode/contact/fully_enclosed.hpp>
#include <polhode/geometry/shapes.hpp>
#include <polhode/simulation/separate_overlaps.hpp>

#include "contact/scene.hpp"
#include "contact/shapes_for_tests.hpp"

namespace polhode::contact::fully_enclosed_tests {
namespace {

using polhode::test::Scene;

geometry::TriangleSurface cube(double size) {
  const double sizes[] = {size, size, size};
  return geometry::shape_surface(*geometry::find_shape_kind("box"), sizes);
}

/// A cube with a hollow of half its size.
geometry::TriangleSurface shell() {
  geometry::TriangleSurface s = cube(1.0);
  const geometry::TriangleSurface hole = cube(0.5);
  const int first = static_cast<int>(s.points.size());
  s.points.insert(s.points.end(), hole.points.begin(), hole.points.end());
  for (const auto& t : hole.triangles)
    s.triangles.push_back({first + t[0], first + t[2], first + t[1]});
  return s;
}

std::optional<FullyEnclosed> ball_in(const geometry::Shape& surface, const Vec3& at,
                                     double diameter = 0.05) {
  const Mat3 turn = quaternion_from_rotation_vector({0.3, -0.2, 0.5}).toRotationMatrix();
  const Vec3 shift(3.0, -2.0, 1.0);
  const Mat3 upright = Mat3::Identity();
  return fully_enclosed(geometry::sphere("ball", diameter), surface,
                        Placement<double>(shift + turn * at, upright, 0),
                        Placement<double>(shift, turn, 6));
}

TEST(FullyEnclosed, FindsBodiesWithinAClosedSurface) {
  const geometry::Shape solid = geometry::mesh("cube", cube(1.0)),
                        hollow = geometry::mesh("shell", shell());
  const std::optional<FullyEnclosed> found = ball_in(solid, {0.1, 0.3, 0.0});
  ASSERT_TRUE(found);
  EXPECT_GT(found->depth, 0.2 + 0.025);  // to the face, and the diameter of the ball
  const Mat3 turn = quaternion_from_rotation_vector({0.3, -0.2, 0.5}).toRotationMatrix();
  EXPECT_LT((found->normal - turn.col(1)).norm(), 1e-12);
  EXPECT_FALSE(ball_in(solid, {0.1, 0.6, 0.0}));
  EXPECT_FALSE(ball_in(hollow, {0.1, 0.0, 0.0})) << "in its hollow";
  EXPECT_TRUE(ball_in(hollow, {0.38, 0.1, 0.0})) << "in its wall";
  const geometry::Shape ring = geometry::mesh("ring", test::torus(1.0, 0.3));
  EXPECT_TRUE(ball_in(ring, {0.0, 1.0, 0.0}));
  EXPECT_FALSE(ball_in(ring, {0.0, 0.0, 0.0})) << "in its hole";
}

TEST(FullyEnclosed, FindsBodiesBelowAHeightField) {
  const double heights[] = {0.0, 0.2, 0.0, 0.2, 0.4, 0.2, 0.0, 0.2, 0.0};
  const geometry::Shape field = geometry::height_field("field", 3, 1.0, heights);
  EXPECT_TRUE(ball_in(field, {0.1, 0.2, 0.1}));
  EXPECT_FALSE(ball_in(field, {0.1, 0.2, 0.7}));
  EXPECT_FALSE(ball_in(field, {1.3, 0.2, -0.3})) << "beside it";
}

TEST(FullyEnclosed, IsAnOverlapAtTheStartWhereNoFeatureIsNear) {
  Scene s;
  s.add("rock", geometry::mesh("rock", cube(1.0)), 100.0, Vec3::Constant(10.0), {});
  BodyMotion inside;
  inside.r = {0.3, 0.0, 0.0};
  s.add_ball("ball", 0.02, 1.0, inside);
  s.system.set_contacts(s.contacts);
  s.system.finish();
  const State state = s.system.initial_state();
  s.contacts->prepare(s.system);
  const std::vector<std::string> list = overlaps_at(s.system, *s.contacts, state);
  ASSERT_EQ(list.size(), 1U);
  EXPECT_TRUE(list[0].starts_with("'rock' in 'ball' by 0.24")) << list[0];
}

}  // namespace
}  // namespace polhode::contact::fully_enclosed_tests
