// SPDX-License-Identifier: Apache-2.0
#include <joints/joint_cases.hpp>

#include <gtest/gtest.h>

namespace polhode::test::universal_joint_tests {

TEST(UniversalJoint, LeavesItsMotionsFree) { EXPECT_EQ(free_motions("universal"), "Rx Ry"); }

}  // namespace polhode::test::universal_joint_tests
