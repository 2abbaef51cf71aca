// SPDX-License-Identifier: Apache-2.0
#include <joints/joint_cases.hpp>

#include <gtest/gtest.h>

namespace polhode::test {

TEST(PointInPlaneJoint, LeavesItsMotionsFree) {
  EXPECT_EQ(free_motions("point_in_plane"), "Tx Ty Rx Ry Rz");
}

}  // namespace polhode::test
