// SPDX-License-Identifier: Apache-2.0
// Moments and forces along coordinates of joints, over time and over the rate.
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <polhode/io/read/read_model.hpp>
#include <polhode/simulation/simulation.hpp>

namespace polhode::read_joint_loads_tests {
namespace {

using testing::HasSubstr;

constexpr const char* kBodies = R"(format: 1
bodies:
  wheel: {mass: 1, inertia: [1, 1, 2]}
  sledge: {mass: 2, inertia: [1, 1, 1], position: [3, 0, 0], velocity: [SPEED, 0, 0]}
joints:
  axle: {type: revolute, bodies: [ground, wheel], at: [0, 0, 0], axis: z}
  rail: {type: prismatic, bodies: [ground, sledge], at: [3, 0, 0], axis: x}
analysis: {duration: 2 s, step: STEP}
)";

Model model(const std::string& loads, const std::string& step = "10 ms",
            const std::string& speed = "3") {
  std::string text = kBodies;
  text.replace(text.find("STEP"), 4, step);
  text.replace(text.find("SPEED"), 5, speed);
  return io::read_model_text(text + "loads:\n" + loads, "loads.yaml");
}

std::string fault(const std::string& load) {
  try {
    (void)model("  a: {" + load + "}\n");
  } catch (const io::ModelErrors& errors) {
    return errors.what();
  }
  return "none";
}

TEST(JointLoads, AreMotorsOfGivenMomentAndDampers) {
  const Model m = model(
      "  turn: {type: joint_moment, joint: axle, moment: {table: [[0, 0], [1, 4 kN*m]]}}\n"
      "  pull: {type: joint_force, joint: rail, coordinate: z, force: 3*t, stays: true}\n"
      "  rub: {type: joint_moment, joint: axle, resistance: 2*v}\n"
      "  water: {type: joint_force, joint: rail, resistance: {table: [[-1, -4], [0, 0], [1, "
      "10]]}}\n");
  ASSERT_EQ(m.loads.size(), 4U);
  EXPECT_EQ(m.loads[0].type, "rotary_motor");
  EXPECT_EQ(m.loads[0].drive, "moment");
  EXPECT_EQ((*m.loads[0].value)(0.5), 2000.0);
  EXPECT_EQ(m.loads[1].type, "linear_motor");
  EXPECT_EQ(m.loads[1].coordinate, "z");
  EXPECT_EQ(m.loads[1].words.at("stays"), "true");
  EXPECT_EQ(m.loads[2].type, "torsional_spring");
  EXPECT_EQ((*m.loads[2].laws.at("damper_moment"))(3.0), 6.0);
  EXPECT_EQ(m.loads[3].type, "translational_spring");
}

// A moment 4 t on 2 kg m²: the rate is t², the angle t³/3.
TEST(JointLoads, ATableOverTimeTurnsAWheelAsItsIntegral) {
  for (const auto& [step, h] :
       {std::pair("100 ms", 0.1), std::pair("10 ms", 1e-2), std::pair("0.1 ms", 1e-4)}) {
    Simulation s(
        model("  m: {type: joint_moment, joint: axle, moment: {table: [[0, 0], [2, 8]]}}\n", step));
    ASSERT_EQ(s.run().end, RunEnd::finished);
    const JointReport axle = s.joint("axle");  // of second order in the step
    EXPECT_NEAR(axle.rates[0], 4.0, 2.0 * h * h) << step;
    EXPECT_NEAR(axle.coordinates[0], 8.0 / 3.0, 2.0 * h * h) << step;
  }
}

// 10 N against 3 m/s forwards stop 2 kg within 0.9 m, 4 N backwards within 2.25 m.
TEST(JointLoads, AResistanceDependsOnTheDirection) {
  for (const char* step : {"50 ms", "10 ms", "0.1 ms"})
    for (const double side : {1.0, -1.0}) {
      Simulation s(
          model("  water: {type: joint_force, joint: rail, resistance: \"(v > 0 ? 10 : -4) N\"}\n",
                step, side > 0 ? "3" : "-3"));
      ASSERT_EQ(s.run().end, RunEnd::finished);
      EXPECT_NEAR(s.joint("rail").coordinates[0], side > 0 ? 0.9 : -2.25, 1e-8) << step;
      EXPECT_NEAR(s.joint("rail").rates[0], 0.0, 1e-8);
    }
}

TEST(JointLoads, SayWhatIsMissing) {
  EXPECT_THAT(fault("type: moment, joint: axle, moment: 3"),
              HasSubstr("loads.a.type: a moment acts on a body. In a joint it is the type "
                        "joint_moment."));
  EXPECT_THAT(fault("type: joint_moment, joint: axle"),
              HasSubstr("has neither moment nor resistance. Give one of them."));
  EXPECT_THAT(fault("type: joint_force, joint: rail, force: 1, resistance: v"),
              HasSubstr("cannot be combined with 'force'. Make two loads of them."));
  EXPECT_THAT(fault("type: joint_force, joint: rail, resistance: -v"),
              HasSubstr("loads.a.resistance: is"));
  EXPECT_THAT(fault("type: joint_force, joint: rial, force: 1"), HasSubstr("Did you mean 'rail'?"));
}

}  // namespace
}  // namespace polhode::read_joint_loads_tests
