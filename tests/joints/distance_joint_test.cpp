// SPDX-License-Identifier: Apache-2.0
#include <joints/joint_cases.hpp>

#include <gtest/gtest.h>

namespace polhode::test::distance_joint_tests {
namespace {

BodyStep point_at(const Vec3& r) {
  return BodyStep::at_instant(r, Mat3::Identity(), Vec3::Zero(), Vec3::Zero());
}

double residual(const Joint& joint, const Vec3& r_b) {
  const BodyStep a = point_at(Vec3::Zero()), b = point_at(r_b);
  return joint.residual({a, b, StepContext{}, nullptr, nullptr})[0];
}

}  // namespace

// @tests{joint-distance}
TEST(DistanceJoint, IsTheElongationToFirstOrder) {
  JointParameters p;
  p.values["distance"] = 2.0;
  const Joint joint("rod", "distance", {0, 1}, joint_kind("distance").recipe({}, p));
  EXPECT_EQ(residual(joint, Vec3(0.0, 2.0, 0.0)), 0.0);
  // The square adds e²/(2L) to the elongation e.
  EXPECT_NEAR(residual(joint, Vec3(0.0, 0.0, 2.01)), 0.01 + 0.01 * 0.01 / 4.0, 1e-15);
}

TEST(DistanceJoint, LeavesAllRotationsFree) {
  JointParameters p;
  p.values["distance"] = 1.0;
  EXPECT_EQ(free_motions("distance", p, Vec3::UnitX()), "Rx Ry Rz");  // About the point itself.
}

}  // namespace polhode::test::distance_joint_tests
