// SPDX-License-Identifier: Apache-2.0
#include <joints/joint_cases.hpp>

#include <gtest/gtest.h>

namespace polhode::test::cylindrical_joint_tests {

TEST(CylindricalJoint, LeavesItsMotionsFree) { EXPECT_EQ(free_motions("cylindrical"), "Tz Rz"); }

}  // namespace polhode::test::cylindrical_joint_tests
