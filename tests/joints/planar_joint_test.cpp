// SPDX-License-Identifier: Apache-2.0
#include <joints/joint_cases.hpp>

#include <gtest/gtest.h>

namespace polhode::test::planar_joint_tests {

TEST(PlanarJoint, LeavesItsMotionsFree) { EXPECT_EQ(free_motions("planar"), "Tx Ty Rz"); }

}  // namespace polhode::test::planar_joint_tests
