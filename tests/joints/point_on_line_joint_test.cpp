// SPDX-License-Identifier: Apache-2.0
#include <joints/joint_cases.hpp>

#include <gtest/gtest.h>

namespace polhode::test {

TEST(PointOnLineJoint, LeavesItsMotionsFree) {
  EXPECT_EQ(free_motions("point_on_line"), "Tz Rx Ry Rz");
}

}  // namespace polhode::test
