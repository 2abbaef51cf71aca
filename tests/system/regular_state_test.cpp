// SPDX-License-Identifier: Apache-2.0
#include <limits>

#include <gtest/gtest.h>

#include <polhode/system/regular_state.hpp>
#include <polhode/system/system.hpp>

namespace polhode::regular_state_tests {
namespace {

constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();

State two_bodies() {
  System system;
  for (const char* name : {"a", "b"})
    system.add_body({.name = name, .mass = 1.0, .inertia = Mat3::Identity()}, {});
  system.finish();
  return system.initial_state();
}

TEST(RegularState, HasFiniteMotionsAndMultipliers) {
  EXPECT_TRUE(is_regular(two_bodies()));
  for (const int body : {0, 1}) {
    State state = two_bodies();
    BodyMotion motion = state.motion(body);
    motion.v.y() = kNotANumber;
    state.set_motion(body, motion);
    EXPECT_FALSE(is_regular(state)) << body;
  }
  State state = two_bodies();
  state.lambda = {std::numeric_limits<double>::infinity()};
  EXPECT_FALSE(is_regular(state));
  state = two_bodies();
  state.node_x = {0.0, kNotANumber, 0.0};
  EXPECT_FALSE(is_regular(state));
}

TEST(RegularState, HasQuaternionsOfUnitLength) {
  State state = two_bodies();
  BodyMotion motion = state.motion(1);
  motion.q = Quat(1.0, 0.0, 1e-5, 0.0);
  state.set_motion(1, motion);
  EXPECT_FALSE(is_regular(state));
}

}  // namespace
}  // namespace polhode::regular_state_tests
