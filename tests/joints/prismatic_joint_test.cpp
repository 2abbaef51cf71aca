// SPDX-License-Identifier: Apache-2.0
#include <joints/joint_cases.hpp>

#include <gtest/gtest.h>

namespace polhode::test::prismatic_joint_tests {

TEST(PrismaticJoint, LeavesItsMotionsFree) { EXPECT_EQ(free_motions("prismatic"), "Tz"); }

}  // namespace polhode::test::prismatic_joint_tests
