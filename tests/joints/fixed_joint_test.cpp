// SPDX-License-Identifier: Apache-2.0
#include <joints/joint_cases.hpp>

#include <gtest/gtest.h>

namespace polhode::test::fixed_joint_tests {

TEST(FixedJoint, LeavesItsMotionsFree) { EXPECT_EQ(free_motions("fixed"), ""); }

}  // namespace polhode::test::fixed_joint_tests
