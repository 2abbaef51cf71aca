// SPDX-License-Identifier: Apache-2.0
// Distances of shapes, near and far, against closed forms.
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <polhode/contact/contact_set.hpp>
#include <polhode/geometry/shapes.hpp>
#include <polhode/math/quaternion.hpp>

#include "contact/shapes_for_tests.hpp"

namespace polhode::contact::owner_distance_tests {
namespace {

/// Distance of a shape at the origin, body 0, and another one at a given position, body 1.
double distance(const geometry::Shape& a, const geometry::Shape& b, const Vec3& r,
                const Quat& turn = Quat::Identity()) {
  ContactSet set;
  PlacedShape one, two;
  one.body = 0;
  one.shape = a;
  two.body = 1;
  two.shape = b;
  set.add_shape(one);
  set.add_shape(two);
  std::vector<BodyStep> instants(3);
  instants[0] = BodyStep::ground(1.0);
  instants[1] = BodyStep::ground(1.0);
  instants[1].r_n = r;
  instants[1].Lambda_n = turn.toRotationMatrix();
  instants[2] = BodyStep::ground(1.0);
  EXPECT_EQ(set.distance(0, 1, instants), set.distance(1, 0, instants));
  return set.distance(0, 1, instants);
}

TEST(OwnerDistance, AgreesWithClosedFormsFarAndNear) {
  const Quat eighth(Eigen::AngleAxisd(std::atan(1.0), Vec3::UnitZ()));
  for (const double far : {1e-6, 0.01, 1.0, 300.0, 1e5}) {
    const double digits = 1e-12 * (1.0 + far);
    const geometry::Shape ball = geometry::sphere("ball", 0.2),
                          cube = geometry::box("cube", Vec3(1.0, 1.0, 1.0));
    EXPECT_NEAR(distance(ball, ball, {0.0, 0.2 + far, 0.0}), far, digits);
    EXPECT_NEAR(distance(geometry::plane(), ball, {3.0, 5.0, 0.1 + far}), far, digits);
    EXPECT_NEAR(distance(geometry::plane(), cube, {3.0, 5.0, 0.5 + far}), far, digits);
    EXPECT_NEAR(distance(cube, ball, {0.5 + 0.1 + far, 0.3, 0.2}), far, digits);
    // Edge to face: half a diagonal, less 0.2 mm by the rounding of the edge.
    const double half = std::sqrt(0.5);
    EXPECT_NEAR(distance(cube, cube, {0.5 + half + far, 0.0, 0.0}, eighth), far, 3e-4) << far;
    const geometry::Shape bar = geometry::capsule("bar", 0.1, 1.0);  // along z
    EXPECT_NEAR(distance(bar, ball, {0.3 + far, 0.0, 0.2}), 0.3 + far - 0.05 - 0.1, digits);
    EXPECT_NEAR(distance(bar, ball, {0.0, 0.0, 0.5 + 0.05 + 0.1 + far}), far, digits);
  }
}

TEST(OwnerDistance, IsNegativeWhereShapesOverlap) {
  EXPECT_NEAR(distance(geometry::sphere("a", 1.0), geometry::sphere("b", 1.0), {0.7, 0.0, 0.0}),
              -0.3, 1e-12);
  EXPECT_NEAR(distance(geometry::plane(), geometry::sphere("b", 1.0), {0.0, 0.0, 0.2}), -0.3,
              1e-12);
}

TEST(OwnerDistance, OfTriangleSurfacesIsThatOfTheNearestTriangle) {
  const geometry::Shape hills =
      geometry::height_field("hills", 5, 1.0, std::vector<double>(25, 0.5));
  EXPECT_NEAR(distance(hills, geometry::sphere("ball", 0.2), {0.3, -0.4, 7.6}), 7.0, 2e-3);
}

}  // namespace
}  // namespace polhode::contact::owner_distance_tests
