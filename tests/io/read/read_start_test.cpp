// SPDX-License-Identifier: Apache-2.0
#include <numbers>
#include <string>

#include <gmock/gmock.h>

#include <polhode/io/read/read_model.hpp>
#include <polhode/simulation/simulation.hpp>

namespace polhode::read_start_tests {
namespace {

using testing::HasSubstr;

Model model_of(const std::string& text) { return io::read_model_text(text, "m.yaml", {}); }

std::string message_of(const std::string& text) {
  try {
    (void)model_of(text);
  } catch (const io::ModelErrors& e) {
    return e.what();
  }
  return "";
}

/// An arm of three bars with a sliding, turning tool, drawn stretched along x.
std::string arm(const std::string& shoulder, const std::string& elbow, const std::string& tool,
                const std::string& bodies = "") {
  return "format: 1\n"
         "bodies:\n"
         "  upper: {mass: 2, inertia: [0.02, 0.2, 0.2], position: [0.5, 0, 0]}\n"
         "  lower: {mass: 1, inertia: [0.01, 0.1, 0.1], position: [1.5, 0, 0]}\n"
         "  tool: {mass: 1, inertia: [0.01, 0.1, 0.1], position: [2.2, 0, 0]}\n" +
         bodies +
         "joints:\n"
         "  shoulder: {type: revolute, bodies: [ground, upper], at: [0, 0, 0], axis: z" +
         shoulder +
         "}\n"
         "  elbow: {type: revolute, bodies: [lower, upper], at: [1, 0, 0], axis: z" +
         elbow +
         "}\n"
         "  slide: {type: cylindrical, bodies: [lower, tool], at: [2, 0, 0], axis: x" +
         tool +
         "}\n"
         "analysis: {duration: 0.01, step: 1 ms}\n";
}

TEST(ReadStart, PlacesBodiesAlongChainsOfJoints) {
  const Model model = model_of(arm(", start: 90 deg, start_rate: 2", ", start: 90 deg",
                                   ", start: {z: 0.3, rz: 0.5}, start_rate: {z: 0.1}"));
  // The elbow turns the upper bar relative to the lower one.
  EXPECT_LT((model.bodies[0].position - Vec3(0, 0.5, 0)).norm(), 1e-15);
  EXPECT_LT((model.bodies[1].position - Vec3(0.5, 1, 0)).norm(), 1e-15);
  EXPECT_LT((model.bodies[2].position - Vec3(1.5, 1, 0)).norm(), 1e-15);
  EXPECT_LT((model.bodies[0].velocity - Vec3(-1, 0, 0)).norm(), 1e-15);
  EXPECT_LT((model.bodies[2].velocity - Vec3(-2 + 0.1, 3, 0)).norm(), 1e-14);
  const Simulation simulation(model);
  EXPECT_NEAR(simulation.joint("shoulder").coordinates[0], std::numbers::pi / 2, 1e-15);
  EXPECT_NEAR(simulation.joint("elbow").coordinates[0], std::numbers::pi / 2, 1e-15);
  EXPECT_NEAR(simulation.joint("slide").coordinates[0], 0.3, 1e-15);
  EXPECT_NEAR(simulation.joint("slide").coordinates[1], 0.5, 1e-15);
  EXPECT_NEAR(simulation.joint("slide").rates[0], 0.1, 1e-14);
  EXPECT_NEAR(simulation.joint("elbow").rates[0], 0.0, 1e-14);
  EXPECT_EQ(simulation.start_report().largest_move, 0.0);
}

TEST(ReadStart, KeepsVelocitiesAndOtherCoordinatesAsGiven) {
  const Model model = model_of(arm("", ", start: -90 deg", "",
                                   "  ball: {mass: 1, inertia: [1, 1, 1], position: [9, 8, 7], "
                                   "velocity: [1, 2, 3], angular_velocity: [3, 2, 1]}\n"));
  EXPECT_LT((model.bodies[2].position - Vec3(1, 1.2, 0)).norm(), 1e-15);
  EXPECT_LT((model.bodies[3].position - Vec3(9, 8, 7)).norm(), 1e-15);
  EXPECT_LT((model.bodies[3].velocity - Vec3(1, 2, 3)).norm(), 1e-15);
  EXPECT_LT((model.bodies[3].angular_velocity - Vec3(3, 2, 1)).norm(), 1e-15);
}

TEST(ReadStart, PlacesBodiesThatAreGivenByTheirJointsAlone) {
  const Model model = model_of(
      "format: 1\nbodies:\n"
      "  a: {mass: 1, inertia: [0.1, 0.1, 0.1]}\n"
      "  b: {mass: 1, inertia: [0.1, 0.1, 0.1]}\n"
      "joints:\n"
      "  one: {type: revolute, bodies: [ground, a], at_body: [[0, 0, 1], [-0.5, 0, 0]],\n"
      "        axis_body: [z, y], x_axis_body: [x, x], start: 180 deg}\n"
      "  two: {type: revolute, bodies: [a, b], at_body: [[0.5, 0, 0], [-0.5, 0, 0]],\n"
      "        axis_body: [z, z], x_axis_body: [x, x], start: 0}\n"
      "analysis: {duration: 0.01, step: 1 ms}\n");
  EXPECT_LT((model.bodies[0].position - Vec3(-0.5, 0, 1)).norm(), 1e-15);
  EXPECT_LT((model.bodies[1].position - Vec3(-1.5, 0, 1)).norm(), 1e-15);
  EXPECT_EQ(Simulation(model).start_report().largest_move, 0.0);
}

TEST(ReadStart, OfAPartIsPlacedWithIt) {
  const Model model = model_of(
      "format: 1\nparts:\n"
      "  left:\n"
      "    position: [0, 5, 0]\n"
      "    model:\n"
      "      format: 1\n"
      "      bodies:\n"
      "        post: {mass: 1, inertia: [0.1, 0.1, 0.1]}\n"
      "        bar: {mass: 1, inertia: [0.1, 0.1, 0.1], position: [1, 0, 0]}\n"
      "      joints:\n"
      "        hinge: {type: revolute, bodies: [post, bar], at: [0, 0, 0], axis: z, start: 90 "
      "deg}\n"
      "analysis: {duration: 0.01, step: 1 ms}\n");
  EXPECT_LT((model.bodies[1].position - Vec3(0, 6, 0)).norm(), 1e-15);
}

TEST(ReadStart, RefusesWhatCannotBe) {
  EXPECT_THAT(message_of(arm(", start: 1 m", "", "")), HasSubstr("joints.shoulder.start"));
  EXPECT_THAT(message_of(arm("", "", ", start: 1")),
              HasSubstr("joints.slide.start: the joint has 2 coordinates: z, rz."));
  EXPECT_THAT(message_of(arm("", "", ", start: {x: 1}")), HasSubstr("'x' is not free"));
  EXPECT_THAT(message_of(arm(", start: 60 deg, limits: {lower: -1, upper: 1}", "", "")),
              HasSubstr("outside of the limits"));
  EXPECT_EQ(message_of(arm(", start: 60 deg, limits: {lower: 1, upper: 2}", "", "")), "");
  EXPECT_THAT(
      message_of("format: 1\nbodies:\n"
                 "  a: {mass: 1, inertia: [0.1, 0.1, 0.1]}\n"
                 "joints:\n"
                 "  p: {type: revolute, bodies: [ground, a], at: [0, 0, 0], axis: z, start: 1}\n"
                 "  q: {type: revolute, bodies: [ground, a], at: [0, 0, 1], axis: z, start: 2}\n"
                 "analysis: {duration: 0.01, step: 1 ms}\n"),
      HasSubstr("joints.q.start: follows from the other coordinates of its loop"));
}

}  // namespace
}  // namespace polhode::read_start_tests
