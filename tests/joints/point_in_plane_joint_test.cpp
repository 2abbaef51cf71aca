// SPDX-License-Identifier: Apache-2.0
#include <joints/joint_cases.hpp>

#include <gtest/gtest.h>

namespace polhode::test::point_in_plane_joint_tests {

TEST(PointInPlaneJoint, LeavesItsMotionsFree) {
  EXPECT_EQ(free_motions("point_in_plane"), "Tx Ty Rx Ry Rz");
}

}  // namespace polhode::test::point_in_plane_joint_tests
