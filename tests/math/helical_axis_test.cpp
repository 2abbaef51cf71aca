// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <polhode/math/helical_axis.hpp>

namespace polhode::test::helical_axis_tests {

const Vec3 kDirection = Vec3(1, 2, -0.5).normalized();
const Vec3 kThrough(0.3, -0.2, 0.7);

// A screw motion about a known axis. @tests{helical-rate}
TEST(HelicalAxis, IsThatOfAScrewsVelocity) {
  const Vec3 omega = 3.0 * kDirection, r(1.0, 0.4, 2.0);
  const Vec3 v = 0.6 * kDirection + omega.cross(r - kThrough);
  const HelicalAxis axis = helical_axis(r, v, omega);
  EXPECT_LT((axis.direction - kDirection).norm(), 1e-15);
  EXPECT_NEAR(axis.turn, 3.0, 1e-15);
  EXPECT_NEAR(axis.slide, 0.6, 1e-14);
  EXPECT_LT((axis.point - kThrough).cross(kDirection).norm(), 1e-14);
  EXPECT_NEAR(axis.point.dot(kDirection), 0.0, 1e-15);
}

// @tests{helical-finite}
TEST(HelicalAxis, IsThatOfAScrewsDisplacement) {
  for (const double turn : {1e-6, 0.4, 2.0, 3.1}) {
    const Mat3 R = Eigen::AngleAxisd(turn, kDirection).toRotationMatrix();
    const Vec3 d = kThrough - R * kThrough + 0.25 * kDirection;
    const HelicalAxis axis = finite_helical_axis(R, d);
    EXPECT_LT((axis.direction - kDirection).norm(), 1e-15 / turn + 1e-14) << turn;
    EXPECT_NEAR(axis.turn, turn, 1e-14) << turn;
    EXPECT_NEAR(axis.slide, 0.25, 1e-15 / turn + 1e-14) << turn;
    EXPECT_LT((axis.point - kThrough).cross(kDirection).norm(), 1e-15 / (turn * turn) + 1e-13)
        << turn;
  }
}

TEST(HelicalAxis, IsTheDirectionOfMotionInATranslation) {
  const HelicalAxis rate = helical_axis(Vec3::Zero(), Vec3(0, 0, -2), Vec3::Zero());
  EXPECT_EQ(rate.direction, Vec3(0, 0, -1));
  EXPECT_EQ(rate.slide, 2.0);
  EXPECT_EQ(rate.turn, 0.0);
  const HelicalAxis finite = finite_helical_axis(Mat3::Identity(), Vec3(3, 0, 0));
  EXPECT_EQ(finite.direction, Vec3(1, 0, 0));
  EXPECT_EQ(finite.slide, 3.0);
  EXPECT_EQ(helical_axis(Vec3::Zero(), Vec3::Zero(), Vec3::Zero()).direction, Vec3::Zero());
}

}  // namespace polhode::test::helical_axis_tests
