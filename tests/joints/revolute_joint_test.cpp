// SPDX-License-Identifier: Apache-2.0
#include <joints/joint_cases.hpp>

#include <gtest/gtest.h>

namespace polhode::test::revolute_joint_tests {

TEST(RevoluteJoint, LeavesItsMotionsFree) { EXPECT_EQ(free_motions("revolute"), "Rz"); }

}  // namespace polhode::test::revolute_joint_tests
