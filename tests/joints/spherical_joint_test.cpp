// SPDX-License-Identifier: Apache-2.0
#include <joints/joint_cases.hpp>

#include <gtest/gtest.h>

namespace polhode::test::spherical_joint_tests {

TEST(SphericalJoint, LeavesItsMotionsFree) { EXPECT_EQ(free_motions("spherical"), "Rx Ry Rz"); }

}  // namespace polhode::test::spherical_joint_tests
