// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>

#include <polhode/dynamics/load_step.hpp>
#include <polhode/joints/driven_turn.hpp>
#include <support/model_builder.hpp>

namespace polhode::driven_turn_tests {
namespace {

using Rotation = FrameMotion::Rotation;
using test::Constant;

constexpr double kPi = std::numbers::pi;

FrameMotion driven(Rotation rotation, const Eigen::Vector4d& parameters) {
  FrameMotion motion;
  motion.rotation = rotation;
  motion.sequence = "zyx";
  for (int k = 0; k < 4; ++k)
    motion.parameters[static_cast<std::size_t>(k)] = std::make_shared<Constant>(parameters[k]);
  return motion;
}

/// Load step from one load factor to another.
StepContext load_step(double from, double to) {
  StepContext c;
  c.ga = load_step_weights();
  c.dt = to - from;
  c.t_n = from;
  c.load_factor = to;
  c.load_factor_n = from;
  return c;
}

}  // namespace

TEST(DrivenTurn, CountsWholeTurnsOfARotationVector) {
  const FrameMotion twice = driven(Rotation::vector, {0.0, 0.0, 4.0 * kPi, 0.0});
  EXPECT_NEAR(driven_turn(twice, load_step(0.0, 1.0)), 4.0 * kPi, 1e-14);
  EXPECT_NEAR(driven_turn(twice, load_step(0.5, 0.75)), kPi, 1e-14);
}

TEST(DrivenTurn, AddsTheAnglesOfAnEulerSequence) {
  const FrameMotion three = driven(Rotation::euler, {1.0, -2.0, 0.5, 0.0});
  EXPECT_NEAR(driven_turn(three, load_step(0.0, 1.0)), 3.5, 1e-14);
}

TEST(DrivenTurn, IsTheAngleBetweenQuaternions) {
  const double half = 0.5 * 2.5;
  const FrameMotion turn = driven(Rotation::quaternion, {std::cos(half), 0.0, std::sin(half), 0.0});
  EXPECT_NEAR(driven_turn(turn, load_step(0.0, 1.0)), 2.5, 1e-13);
  EXPECT_NEAR(driven_turn(turn, load_step(0.6, 0.8)), 0.5, 1e-13);
}

TEST(DrivenTurn, IsZeroWithoutARotation) {
  EXPECT_EQ(driven_turn(FrameMotion{}, load_step(0.0, 1.0)), 0.0);
}

}  // namespace polhode::driven_turn_tests
