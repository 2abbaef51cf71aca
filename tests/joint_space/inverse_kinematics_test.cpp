// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <polhode/io/read/read_model.hpp>
#include <polhode/joint_space/inverse_kinematics.hpp>
#include <polhode/math/quaternion.hpp>

namespace polhode {
namespace inverse_kinematics_test {

using Numbers = std::vector<double>;

/// Two links of 1 m in the plane x, y, with stops at the second joint.
Model two_links(const std::string& limits) {
  return io::read_model_text(
      "format: 1\nbodies:\n"
      "  one: {mass: 1, inertia: [0.1, 0.1, 0.1], position: [0.5, 0, 0]}\n"
      "  two: {mass: 1, inertia: [0.1, 0.1, 0.1], position: [1.5, 0, 0]}\n"
      "joints:\n"
      "  shoulder: {type: revolute, bodies: [ground, one], at: [0, 0, 0], axis: z}\n"
      "  elbow: {type: revolute, bodies: [one, two], at: [1, 0, 0], axis: z" +
          limits + "}\nanalysis: {duration: 1, step: 1 ms}\n",
      "arm.yaml", {});
}

PoseReached reached(const Model& model, const PoseTarget& target, const Numbers& near) {
  const JointSpace space(model);
  return reach(space, coordinate_limits(model, space), space.place(space.model_motions(), near),
               near, target);
}

/// @tests{inverse-kinematics}
TEST(InverseKinematics, OfTwoLinksIsTheLawOfCosines) {
  const Model free = two_links("");
  // From the stretched arm, which is singular, and from both sides of the target.
  for (const double elbow : {0.0, 0.4, -0.4}) {
    const PoseReached at = reached(
        free, {.body = 1, .point = {0.5, 0, 0}, .position = Vec3(0.6, 0.8, 0)}, {0.1, elbow});
    ASSERT_TRUE(at.reached);
    EXPECT_LT(at.distance, 1e-11);
    EXPECT_NEAR(std::abs(at.positions[1]), 2.0 * std::numbers::pi / 3.0, 1e-9);
    EXPECT_GE(at.positions[1] * elbow, 0.0);  // the nearer of both solutions
  }
  // Stops leave one of the solutions, and none of another target.
  const Model bent = two_links(", start: 0.5, limits: {lower: 0.1, upper: 2.5}");
  EXPECT_NEAR(
      reached(bent, {.body = 1, .point = {0.5, 0, 0}, .position = Vec3(0.6, 0.8, 0)}, {2.0, 0.2})
          .positions[1],
      2.0 * std::numbers::pi / 3.0, 1e-9);
  const PoseReached out =
      reached(bent, {.body = 1, .point = {0.5, 0, 0}, .position = Vec3(0, 3, 0)}, {0.0, 1.0});
  EXPECT_FALSE(out.reached);
  EXPECT_NEAR(out.positions[1], 0.1, 1e-6);
  EXPECT_NEAR(out.distance, 3.0 - std::sqrt(2.0 + 2.0 * std::cos(0.1)), 1e-9);
}

/// @tests{inverse-kinematics}
TEST(InverseKinematics, TurnsAFreeBodyAndABallJoint) {
  const Model model = io::read_model_text(
      "format: 1\nbodies:\n"
      "  free: {mass: 1, inertia: [0.1, 0.1, 0.1], position: [3, 0, 0]}\n"
      "  ball: {mass: 1, inertia: [0.1, 0.1, 0.1], position: [0.5, 0, 0]}\n"
      "joints:\n  centre: {type: spherical, bodies: [ground, ball], at: [0, 0, 0]}\n"
      "analysis: {duration: 1, step: 1 ms}\n",
      "free.yaml", {});
  const Quat turned = quaternion_from_rotation_vector(Vec3(1.1, -2.0, 0.4));
  Numbers near(9, 0.2);
  PoseReached at =
      reached(model, {.body = 0, .position = Vec3(-1, 2, 5), .orientation = turned}, near);
  EXPECT_TRUE(at.reached);
  EXPECT_LT((at.motions[0].r - Vec3(-1, 2, 5)).norm(), 1e-11);
  EXPECT_LT(rotation_vector(at.motions[0].q * turned.conjugate()).norm(), 1e-12);
  at = reached(model, {.body = 1, .orientation = turned}, near);
  EXPECT_TRUE(at.reached);
  EXPECT_LT(rotation_vector(at.motions[1].q * turned.conjugate()).norm(), 1e-12);
}

}  // namespace inverse_kinematics_test
}  // namespace polhode
