// SPDX-License-Identifier: Apache-2.0
// Start values where rows, redundant rows, couplings or other branches of a loop take part.
#include <cmath>
#include <numbers>
#include <string>

#include <gmock/gmock.h>

#include <polhode/core/format.hpp>
#include <polhode/io/read/read_model.hpp>
#include <polhode/simulation/simulation.hpp>

namespace polhode::start_of_loops_tests {
namespace {

using testing::HasSubstr;

constexpr double kDegree = std::numbers::pi / 180.0;

Model model_of(const std::string& rest) {
  return io::read_model_text("format: 1\n" + rest + "analysis: {duration: 0.01, step: 1 ms}\n",
                             "m.yaml", {});
}

std::string message_of(const std::string& rest) {
  try {
    (void)model_of(rest);
  } catch (const io::ModelErrors& e) {
    return e.what();
  }
  return "";
}

double coordinate(const Simulation& simulation, const char* joint, std::size_t k = 0) {
  return simulation.joint(joint).coordinates[k];
}

/// A door in hinges on one axis, which are redundant, and a link on it.
std::string door(const std::string& axis, const std::string& low, const std::string& link) {
  return format(
      "bodies:\n"
      "  door: {{mass: 1, inertia: [0.02, 0.03, 0.02], position: [0.4, 0.3, 1]}}\n"
      "  link: {{mass: 1, inertia: [0.02, 0.03, 0.02], position: [1.4, 0.3, 1]}}\n"
      "joints:\n"
      "  low: {{type: revolute, bodies: [ground, door], at: [0, 0, 0.2], axis: {0}{1}}}\n"
      "  high: {{type: revolute, bodies: [ground, door], at: [0.18, 0.36, 2], axis: {0}}}\n"
      "  k: {{type: revolute, bodies: [door, link], at: [0.8, 0, 0], axis: {0}{2}}}\n",
      axis, low, link);
}

TEST(StartOfLoops, OfRedundantHingesTurnsThemAlone) {
  const std::string axis = "[0.1, 0.2, 1]";
  const Simulation still(model_of(door(axis, "", ", start: 30 deg")));
  EXPECT_NEAR(coordinate(still, "low"), 0.0, 1e-12);
  EXPECT_NEAR(coordinate(still, "k"), 30 * kDegree, 1e-12);
  const Simulation turned(model_of(door(axis, ", start: 40 deg, start_rate: 1", "")));
  EXPECT_NEAR(coordinate(turned, "low"), 40 * kDegree, 1e-12);
  EXPECT_NEAR(turned.joint("high").rates[0], 1.0, 1e-12);
}

/// All rows are zero to the last digit.
TEST(StartOfLoops, OfADoorOnAnAxisOfTheWorld) {
  const std::string text =
      "bodies:\n  door: {mass: 1, inertia: [0.02, 0.03, 0.02], position: [0.4, 0.3, 1]}\n"
      "joints:\n"
      "  low: {type: revolute, bodies: [ground, door], at: [0, 0, 0.2], axis: z, START}\n"
      "  high: {type: revolute, bodies: [ground, door], at: [0, 0, 2], axis: z}\n";
  std::string started = text;
  started.replace(started.find("START"), 5, "start: 40 deg, start_rate: 1");
  EXPECT_NEAR(coordinate(Simulation(model_of(started)), "high"), 40 * kDegree, 1e-15);
  std::string locked = text;
  locked.replace(locked.find("START"), 5, "start_rate: 0");
  locked.replace(locked.find("at: [0, 0, 2]"), 13, "at: [1, 0, 2]");
  EXPECT_THAT(message_of(locked), HasSubstr("joints.low.start_rate: follows from the other"));
}

/// A parallelogram passes the position in which its bars are in line, where another branch begins.
TEST(StartOfLoops, OfAParallelogramKeepsItsBranch) {
  for (const double crank : {30.0, 89.9, 90.1, 150.0, 179.0, -100.0, -170.0}) {
    const Simulation simulation(model_of(format(
        "bodies:\n"
        "  crank: {{mass: 1, inertia: [0.1, 0.1, 0.1], position: [0, 0.5, 0]}}\n"
        "  rod: {{mass: 1, inertia: [0.1, 0.1, 0.1], position: [1, 1, 0]}}\n"
        "  rocker: {{mass: 1, inertia: [0.1, 0.1, 0.1], position: [2, 0.5, 0]}}\n"
        "joints:\n"
        "  A: {{type: revolute, bodies: [ground, crank], at: [0, 0, 0], axis: z, start: {} deg}}\n"
        "  B: {{type: revolute, bodies: [crank, rod], at: [0, 1, 0], axis: z}}\n"
        "  C: {{type: revolute, bodies: [rod, rocker], at: [2, 1, 0], axis: z}}\n"
        "  D: {{type: revolute, bodies: [ground, rocker], at: [2, 0, 0], axis: z}}\n",
        crank)));
    EXPECT_NEAR(coordinate(simulation, "D"), crank * kDegree, 1e-10) << crank;
  }
}

/// The free coordinates of a point mass follow, that of which the rod has the most.
TEST(StartOfLoops, OfARodToAPointMassLeadIt) {
  for (const double z : {0.0, 1e-9, 1e-5, 0.01, 0.3}) {
    const Model model = model_of(format(
        "bodies:\n"
        "  crank: {{mass: 1, inertia: [0.1, 0.1, 0.1], position: [0, 0.15, 0]}}\n"
        "  p: {{mass: 1, point_mass: true, position: [1, 0.3, {0}]}}\n"
        "joints:\n"
        "  A: {{type: revolute, bodies: [ground, crank], at: [0, 0, 0], axis: z, start: 20 deg}}\n"
        "  L: {{type: distance, bodies: [crank, p], at: [[0, 0.3, 0], [1, 0.3, {0}]]}}\n",
        z));
    const Vec3 end = model.bodies[0].position + model.bodies[0].orientation * Vec3(0, 0.15, 0);
    EXPECT_NEAR((model.bodies[1].position - end).norm(), std::hypot(1.0, z), 1e-12) << z;
  }
}

/// Velocities that are given belong to the position described, and turn with the bodies.
TEST(StartOfLoops, CarriesVelocities) {
  const std::string text =
      "bodies:\n"
      "  upper: {mass: 2, inertia: [0.02, 0.2, 0.2], position: [0.5, 0, 0], velocity: [0, 0.5, "
      "0],\n"
      "    angular_velocity: [0, 0, 1]}\n"
      "  lower: {mass: 1, inertia: [0.01, 0.1, 0.1], position: [1.5, 0, 0], velocity: [0, 1.5, "
      "0],\n"
      "    angular_velocity: [0, 0, 1]}\n"
      "joints:\n"
      "  shoulder: {type: revolute, bodies: [ground, upper], at: [0, 0, 0], axis: z, start: 90 "
      "deg}\n"
      "  elbow: {type: revolute, bodies: [upper, lower], at: [1, 0, 0], axis: z RATE}\n";
  for (const auto& [rate, elbow] : {std::pair("", 0.0), std::pair(", start_rate: -3", -3.0)}) {
    std::string model = text;
    model.replace(model.find(" RATE"), 5, rate);
    const Simulation simulation(model_of(model));
    EXPECT_NEAR(simulation.joint("shoulder").rates[0], 1.0, 1e-13);
    EXPECT_NEAR(simulation.joint("elbow").rates[0], elbow, 1e-13);
    EXPECT_LT(simulation.start_report().velocity_change, 1e-12);
  }
}

TEST(StartOfLoops, OfAPartKeepsItsRates) {
  const Simulation simulation(model_of(
      "bodies:\n  base: {mass: 3, inertia: [0.1, 0.1, 0.1], position: [0, 0, 1]}\n"
      "parts:\n"
      "  left:\n"
      "    position: [0, 1, 1]\n"
      "    model:\n"
      "      format: 1\n"
      "      bodies:\n"
      "        hip: {mass: 1, inertia: [0.1, 0.2, 0.15], position: [0.5, 0, 0], com: [0.1, 0.2, "
      "0]}\n"
      "        leg: {mass: 1, inertia: [0.1, 0.2, 0.15], position: [1.5, 0.1, 0.2]}\n"
      "      joints:\n"
      "        h: {type: revolute, bodies: [hip, leg], at: [1, 0, 0], axis: [0.2, 0, 1],\n"
      "          start: 40 deg, start_rate: 2}\n"
      "joints:\n"
      "  l: {type: revolute, bodies: [base, left_hip], at: [0, 1, 1], axis: z, start: 30 deg}\n"));
  EXPECT_NEAR(simulation.joint("left_h").rates[0], 2.0, 1e-12);
  EXPECT_NEAR(simulation.joint("l").rates[0], 0.0, 1e-12);
  EXPECT_NEAR(coordinate(simulation, "left_h"), 40 * kDegree, 1e-14);
  EXPECT_NEAR(coordinate(simulation, "l"), 30 * kDegree, 1e-14);
}

std::string four_bar(const std::string& crank, const std::string& last) {
  return "bodies:\n"
         "  crank: {mass: 1, inertia: [0.02, 0.03, 0.02], position: [0, 0, 0.15]}\n"
         "  coupler: {mass: 2, inertia: [0.1, 0.2, 0.1], position: [0.5, 0.02, 0.45]}\n"
         "  rocker: {mass: 1.5, inertia: [0.04, 0.05, 0.03], position: [1, 0, 0.3]}\n"
         "joints:\n"
         "  A: {type: revolute, bodies: [ground, crank], at: [0, 0, 0], axis: y" +
         crank +
         "}\n"
         "  B: {type: revolute, bodies: [crank, coupler], at: [0, 0, 0.3], axis: y}\n"
         "  C: {type: revolute, bodies: [coupler, rocker], at: [1, 0, 0.6], axis: y}\n"
         "  D: {type: revolute, bodies: [rocker, ground], at: [1, 0, 0], axis: y" +
         last + "}\n";
}

TEST(StartOfLoops, ClosesJointsThatAStiffnessHolds) {
  const Simulation exact(model_of(four_bar(", start: 40 deg", "")));
  const Simulation held(
      model_of(four_bar(", start: 40 deg",
                        ", enforcement: {type: penalty, stiffness: 1e8, turning_stiffness: 1e5}")));
  EXPECT_NEAR(coordinate(held, "D"), coordinate(exact, "D"), 1e-12);
  EXPECT_LT(held.joint("D").residual, 1e-12);
}

/// Some coordinates of a ball joint lead, and the others follow.
TEST(StartOfLoops, TakesComponentsOfARotationVector) {
  const char* names[] = {"rx", "ry", "rz"};
  for (int k = 0; k < 3; ++k) {
    const Simulation simulation(model_of(format(
        "bodies:\n"
        "  crank: {{mass: 1, inertia: [0.02, 0.03, 0.02], position: [0, 0, 0.15]}}\n"
        "  rod: {{mass: 2, inertia: [0.1, 0.2, 0.1], position: [0.5, 0.2, 0.45]}}\n"
        "  rocker: {{mass: 1.5, inertia: [0.04, 0.05, 0.03], position: [1, 0.4, 0.3]}}\n"
        "joints:\n"
        "  A: {{type: revolute, bodies: [ground, crank], at: [0, 0, 0], axis: y, start: 40 deg}}\n"
        "  B: {{type: spherical, bodies: [crank, rod], at: [0, 0, 0.3], start: {{{}: 0.3}}}}\n"
        "  C: {{type: spherical, bodies: [rod, rocker], at: [1, 0.4, 0.6]}}\n"
        "  D: {{type: revolute, bodies: [rocker, ground], at: [1, 0.4, 0], axis: [1, 0.3, 0]}}\n",
        names[k])));
    EXPECT_NEAR(coordinate(simulation, "A"), 40 * kDegree, 1e-12);
    EXPECT_NEAR(coordinate(simulation, "B", static_cast<std::size_t>(k)), 0.3, 1e-12) << names[k];
    EXPECT_LT(simulation.start_report().position_residual, 1e-12);
  }
}

/// Gears of high ratio, a coupling whose offset the bodies do not have as described.
TEST(StartOfLoops, LeadsGearsAndCouplings) {
  const auto train = [](const std::string& p, const std::string& load) {
    return model_of(
        "bodies:\n"
        "  one: {mass: 1, inertia: [1, 1, 2], position: [0, 0, 0]}\n"
        "  two: {mass: 1, inertia: [3, 3, 5], position: [0.05, 0, 0]}\n"
        "joints:\n"
        "  p: {type: revolute, bodies: [ground, one], at: [0, 0, 0], axis: z, start: " +
        p +
        "}\n"
        "  q: {type: revolute, bodies: [ground, two], at: [0.05, 0, 0], axis: z}\n"
        "loads:\n  train: " +
        load + "\n");
  };
  for (const double ratio : {100.0, 5000.0}) {
    const Simulation geared(
        train("150 deg", format("{{type: gear, joints: [q, p], ratio: {}}}", ratio)));
    EXPECT_NEAR(std::remainder(coordinate(geared, "q") - ratio * 150 * kDegree, 360 * kDegree), 0.0,
                1e-9);
  }
  const Simulation coupled(
      train("0.3", "{type: coupling, joints: [q, p], factors: 2, offset: 1.5}"));
  EXPECT_NEAR(coordinate(coupled, "p"), 0.3, 1e-12);
  EXPECT_NEAR(coordinate(coupled, "q"), 2 * 0.3 + 1.5, 1e-12);
}

TEST(StartOfLoops, IsTheSameFarFromTheOrigin) {
  std::string text = four_bar(", start: 40 deg", "");
  const double near = coordinate(Simulation(model_of(text)), "D");
  const auto moved = [&](const std::string& from, const std::string& to) {
    for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
      text.replace(at, from.size(), to);
  };
  moved("position: [0", "position: [10000");
  moved("position: [1,", "position: [10001,");
  moved("at: [0", "at: [10000");
  moved("at: [1,", "at: [10001,");
  EXPECT_NEAR(coordinate(Simulation(model_of(text)), "D"), near, 1e-9);
}

TEST(StartOfLoops, LeavesHeldFreedomsToTheOthers) {
  const Model model = model_of(
      "bodies:\n"
      "  upper: {mass: 2, inertia: [0.02, 0.2, 0.2], position: [0.5, 0, 0], hold: [z, rx, ry]}\n"
      "  lower: {mass: 1, inertia: [0.01, 0.1, 0.1], position: [1.5, 0, 0], hold: [z, rx, ry]}\n"
      "joints:\n"
      "  shoulder: {type: revolute, bodies: [ground, upper], at: [0, 0, 0], axis: z, start: 90 "
      "deg}\n"
      "  elbow: {type: revolute, bodies: [upper, lower], at: [1, 0, 0], axis: z}\n");
  EXPECT_LT((model.bodies[1].position - Vec3(0, 1.5, 0)).norm(), 1e-12);
}

/// A crank of 0.3 m, drawn upwards, with a rod of √(0.8² + 0.3²) m to a slider.
std::string slider_crank(const std::string& crank, const std::string& slider) {
  return "bodies:\n"
         "  crank: {mass: 1, inertia: [0.1, 0.1, 0.1], position: [0, 0.15, 0]}\n"
         "  rod: {mass: 1, inertia: [0.1, 0.1, 0.1], position: [0.4, 0.15, 0]}\n"
         "  slider: {mass: 1, inertia: [0.1, 0.1, 0.1], position: [0.8, 0, 0]}\n"
         "joints:\n"
         "  A: {type: revolute, bodies: [ground, crank], at: [0, 0, 0], axis: z" +
         crank +
         "}\n"
         "  B: {type: revolute, bodies: [crank, rod], at: [0, 0.3, 0], axis: z}\n"
         "  C: {type: revolute, bodies: [rod, slider], at: [0.8, 0, 0], axis: z}\n"
         "  D: {type: prismatic, bodies: [ground, slider], at: [0.8, 0, 0], axis: x" +
         slider + "}\n";
}

TEST(StartOfLoops, ClosesThem) {
  const Model model = model_of(slider_crank(", start: -90 deg, start_rate: 1", ""));
  // The crank points along the guide: the slider is a rod and a crank away.
  EXPECT_LT((model.bodies[2].position - Vec3(0.3 + std::hypot(0.8, 0.3), 0, 0)).norm(), 1e-13);
  EXPECT_LT(model.bodies[2].velocity.norm(), 1e-13);
  EXPECT_LT((model.bodies[0].velocity - Vec3(0, 0.15, 0)).norm(), 1e-13);
  EXPECT_THAT(message_of(slider_crank("", ", start: 1 m")),
              HasSubstr("joint 'C' cannot be closed at these coordinates"));
}

TEST(StartOfLoops, TakesTheRateOfAnyJoint) {
  const Simulation simulation(model_of(slider_crank(", start: 30 deg", ", start_rate: 1")));
  EXPECT_NEAR(coordinate(simulation, "A"), 30 * kDegree, 1e-12);
  EXPECT_NEAR(simulation.joint("D").rates[0], 1.0, 1e-12);
}

/// Limits of joints that follow hold where they are led to.
TEST(StartOfLoops, ChecksLimitsWhereItLeads) {
  EXPECT_EQ(message_of(slider_crank(", start: -90 deg", ", limits: {lower: 0.2, upper: 0.6}")), "");
}

TEST(StartOfLoops, DoesNotMistakeBodiesForJoints) {
  EXPECT_THAT(
      message_of(
          "bodies:\n"
          "  s: {mass: 1, inertia: [0.02, 0.03, 0.02], position: [5, 5, 5]}\n"
          "  b: {mass: 1, inertia: [0.02, 0.03, 0.02], position: [0, 0, 0]}\n"
          "joints:\n"
          "  p: {type: cylindrical, bodies: [ground, b], at: [0, 0, 0], axis: z, start: {z: 0.1}}\n"
          "  s: {type: cylindrical, bodies: [ground, b], at: [1, 0, 0], axis: z, start: {z: "
          "0.2}}\n"),
      HasSubstr("joints.s.start.z: follows from the other coordinates"));
}

TEST(StartOfLoops, LeavesOtherBodiesAsTheyAre) {
  const Model model = model_of(
      "bodies:\n"
      "  a: {mass: 1, inertia: [0.02, 0.03, 0.02], position: [0.5, 0, 0]}\n"
      "  p: {mass: 1, point_mass: true, position: [2, 0, 0], orientation: {axis: z, angle: 90 "
      "deg}}\n"
      "joints:\n"
      "  A: {type: revolute, bodies: [ground, a], at: [0, 0, 0], axis: z, start: 90 deg}\n");
  EXPECT_LT((model.bodies[1].orientation * Vec3::UnitX() - Vec3::UnitY()).norm(), 1e-15);
}

TEST(StartOfLoops, RefusesMoreThanHalfATurn) {
  EXPECT_THAT(message_of("bodies:\n"
                         "  a: {mass: 1, inertia: [0.02, 0.03, 0.02], position: [0.5, 0, 0]}\n"
                         "joints:\n"
                         "  A: {type: revolute, bodies: [ground, a], at: [0, 0, 0], axis: z, "
                         "start: 200 deg}\n"),
              HasSubstr("joints.A.start: is 200 deg. Angles start between -180 and 180 deg"));
}

}  // namespace
}  // namespace polhode::start_of_loops_tests
