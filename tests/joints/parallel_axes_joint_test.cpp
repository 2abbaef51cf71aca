// SPDX-License-Identifier: Apache-2.0
#include <joints/joint_cases.hpp>

#include <gtest/gtest.h>

namespace polhode::test::parallel_axes_joint_tests {

TEST(ParallelAxesJoint, LeavesItsMotionsFree) {
  EXPECT_EQ(free_motions("parallel_axes"), "Tx Ty Tz Rz");
}

}  // namespace polhode::test::parallel_axes_joint_tests
