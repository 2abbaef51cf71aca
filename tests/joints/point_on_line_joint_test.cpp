// SPDX-License-Identifier: Apache-2.0
#include <joints/joint_cases.hpp>

#include <gtest/gtest.h>

namespace polhode::test::point_on_line_joint_tests {

TEST(PointOnLineJoint, LeavesItsMotionsFree) {
  EXPECT_EQ(free_motions("point_on_line"), "Tz Rx Ry Rz");
}

}  // namespace polhode::test::point_on_line_joint_tests
