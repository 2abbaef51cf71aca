// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <polhode/core/types.hpp>
#include <polhode/model/side.hpp>

namespace polhode::test::side_tests {

TEST(Side, IsABodyASolidOrACable) {
  const Side body = 3, solid = Side::of_solid(3), cable = Side::of_cable(3);
  EXPECT_TRUE(body.is_body() && !body.is_solid() && !body.is_cable());
  EXPECT_TRUE(solid.is_solid() && !solid.is_body() && !solid.is_cable());
  EXPECT_TRUE(cable.is_cable() && !cable.is_body() && !cable.is_solid());
  EXPECT_EQ(solid.index, 3);
  EXPECT_NE(body, solid);
  EXPECT_NE(solid, cable);
  EXPECT_NE(body, cable);
  EXPECT_EQ(body, 3);
}

TEST(Side, OrdersTheGroundBeforeAllBodies) {
  EXPECT_TRUE(Side(kGround).is_body());
  EXPECT_LT(Side(kGround), Side(0));
  EXPECT_LT(Side(0), Side(1));
}

}  // namespace polhode::test::side_tests
