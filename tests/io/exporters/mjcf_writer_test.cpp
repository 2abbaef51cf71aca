// SPDX-License-Identifier: Apache-2.0
// Models as MJCFs, read again by the importer, which has its own tests against MuJoCo.
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include "export_fixture.hpp"

namespace polhode::mjcf_writer_tests {
namespace {

using test::Exports;
using testing::AllOf;
using testing::HasSubstr;

/// Rounding of a chain of a few bodies, of mass 1 and length 1.
constexpr double kRounding = 1e-13;
/// Part of it that grows over a second of motion, and that the iterations leave.
constexpr double kGrown = 1e-10;
/// Error of the motion where the importer gives the frames between the axes of a joint 1e-10 of the
/// mass of the next body.
constexpr double kLight = 1e-7;

constexpr const char* kBodies = R"(
bodies:
  post: {fixed: true, position: [0.1, 0.2, 0.3], orientation: {axis: [1, 2, 3], angle: 0.7}, shape: {plane: [0, 1, 1]}}
  arm:
    mass: 2
    inertia: {xx: 0.3, yy: 0.4, zz: 0.5, xy: 0.05, xz: -0.07, yz: 0.02}
    com: [0.2, -0.1, 0.05]
    position: [0.5, 0.1, 0.2]
    orientation: {axis: [0, 1, 1], angle: 1.1}
    shape: {ellipsoid: [0.3, 0.1, 0.2], position: [0.1, 0, 0.1], orientation: {axis: x, angle: 0.4}}
  second: {mass: 1.5, inertia: {xx: 0.02, yy: 0.03, zz: 0.04, xy: 0.003, xz: 0.001, yz: -0.004}, position: [0.9, 0.3, 0.1], orientation: {axis: [3, -1, 2], angle: 2.2}}
  third: {mass: 0.7, inertia: [0.01, 0.02, 0.015], com: [0, 0.1, 0], position: [1.1, 0.4, 0], orientation: {axis: y, angle: 90 deg}}
)";

TEST_F(Exports, AsAnMjcfMoveAsTheModel) {
  const Model model = model_of(std::string(kBodies) + R"(
  free: {mass: 1, inertia: [0.1, 0.2, 0.25], com: [0.1, 0.2, 0.3], position: [3, 0, 0], orientation: {axis: x, angle: 1}}
joints:
  shoulder: {type: revolute, bodies: [post, arm], at: [0.2, 0.1, 0.3], axis: [1, -1, 2], start: 0.4}
  rail: {type: prismatic, bodies: [second, arm], at: [0.7, 0.2, 0.1], axis: [1, 1, 0.3], start: -0.05}
  ball: {type: spherical, bodies: [third, second], at: [1, 0.4, 0]}
loads:
  spring: {type: torsional_spring, joint: shoulder, stiffness: 5, damping: 0.3, free_angle: 0.2}
  flywheel: {type: rotary_inerter, joint: shoulder, inertance: 0.4}
  buffer: {type: translational_spring, joint: rail, stiffness: 300, free_displacement: 0.02}
  drag: {type: vector_damper, bodies: [second, third], at: [[1, 0.4, 0], [1, 0.4, 0]], turning_damping: 0.02}
  servo: {type: rotary_servo, joint: shoulder, angle: 0, stiffness: 2, damping: 0.1, max_moment: 8}
)");
  const Model read = again(model, "robot.xml");
  for (const double step : {0.02, 0.005, 0.001})
    expect_same(model, read, step, 10 * kRounding, kGrown);
}

TEST_F(Exports, OfLinesBetweenPointsAsAnMjcfMoveAsTheModel) {
  const Model model = model_of(std::string(kBodies) + R"(
joints:
  shoulder: {type: revolute, bodies: [post, arm], at: [0.2, 0.1, 0.3], axis: [1, -1, 2], start: 0.4}
  rail: {type: prismatic, bodies: [second, arm], at: [0.7, 0.2, 0.1], axis: [1, 1, 0.3], start: -0.05}
  ball: {type: spherical, bodies: [third, second], at: [1, 0.4, 0]}
loads:
  strut: {type: spring_damper, bodies: [ground, second], at: [[0, 1, 0], [0.9, 0.3, 0.2]], stiffness: 40, damping: 2}
  rope: {type: spring_damper, bodies: [post, third], at: [[0, 0, 0], [1.1, 0.3, 0]], stiffness: 60, free_length: 1, acts: tension}
  stop: {type: spring_damper, bodies: [arm, third], at: [[0.4, 0, 0], [1.1, 0.3, 0]], stiffness: 60, free_length: 0.9, acts: compression}
  oil: {type: spring_damper, bodies: [ground, third], at: [[0, 0, 1], [1.1, 0.3, 0]], damping: 3}
  winch: {type: axial_force, bodies: [ground, third], at: [[0, 0, 1], [1.1, 0.3, 0]], pull: 5, damping: 0.5}
)");
  const Model read = again(model, "robot.xml");
  // The damper and the pull of the winch are two, and a stop is a spring without force over a
  // range.
  EXPECT_EQ(read.loads.size(), 7U);
  for (const double step : {0.02, 0.005, 0.001})
    expect_same(model, read, step, 10 * kRounding, kGrown);
}

// The keyframe of the file is the start where it is read again.
TEST_F(Exports, KeepVelocitiesAndControls) {
  const Model model = model_of(std::string(kBodies) + R"(
  free: {mass: 1, inertia: [0.1, 0.2, 0.25], com: [0.1, 0.2, 0.3], position: [3, 0, 0], orientation: {axis: x, angle: 1}, velocity: [1, -2, 3], angular_velocity: [0.5, 1, -2]}
joints:
  shoulder: {type: revolute, bodies: [post, arm], at: [0.2, 0.1, 0.3], axis: [1, -1, 2], start: 0.4, start_rate: 1.5}
  rail: {type: prismatic, bodies: [second, arm], at: [0.7, 0.2, 0.1], axis: [1, 1, 0.3], start: -0.05, start_rate: 0.2}
  hinge: {type: revolute, bodies: [second, third], at: [1, 0.4, 0], axis: y, start: 2.5, start_rate: -0.7}
loads:
  servo: {type: rotary_servo, joint: shoulder, angle: 0.6, stiffness: 20, damping: 0.1, max_moment: 80}
  motor: {type: linear_motor, joint: rail, force: 4}
  fan: {type: rotary_servo, joint: hinge, speed: 3, damping: 0.5}
)");
  const Model read = again(model, "robot.xml");
  for (const double step : {0.02, 0.005, 0.001})
    expect_same(model, read, step, 10 * kRounding, kGrown);
  const Model rest = again(model, "robot.xml", {"import.keyframe=none"});
  EXPECT_EQ(rest.bodies.at(1).velocity, Vec3(0, 0, 0));
}

TEST_F(Exports, OfJointsWithSeveralCoordinatesAsAnMjcfMoveAsTheModel) {
  const Model model = model_of(std::string(kBodies) + R"(
joints:
  cross: {type: universal, bodies: [post, arm], at: [0.2, 0.1, 0.3], axes: [[1, 1, 0], [1, -1, 1]], start: {rx: 0.3, ry: -0.5}}
  sleeve: {type: cylindrical, bodies: [arm, second], at: [0.7, 0.2, 0.1], axis: [1, 1, 0.3], start: {z: 0.1, rz: 0.6}}
  plate: {type: planar, bodies: [second, third], at: [1, 0.4, 0], axis: [0.2, 1, 0], start: {x: 0.1, y: -0.05, rz: 0.4}}
)");
  for (const double step : {0.02, 0.005})
    expect_same(model, again(model, "robot.xml"), step, kLight, kLight);
}

// From the child to its parent the displacements of a plane are after its rotation, which is
// another sequence of joints: motions differ by the error of the step, which is of second order.
TEST_F(Exports, OfReversedJointsWithSeveralCoordinatesMoveAsTheModelToTheOrderOfTheStep) {
  const Model model = model_of(std::string(kBodies) + R"(
joints:
  cross: {type: universal, bodies: [arm, post], at: [0.2, 0.1, 0.3], axes: [[1, 1, 0], [1, -1, 1]], start: {rx: 0.3, ry: -0.5}}
  sleeve: {type: cylindrical, bodies: [second, arm], at: [0.7, 0.2, 0.1], axis: [1, 1, 0.3], start: {z: 0.1, rz: 0.6}}
  plate: {type: planar, bodies: [third, second], at: [1, 0.4, 0], axis: [0.2, 1, 0], start: {x: 0.1, y: -0.05, rz: 0.4}}
)");
  for (const double step : {0.02, 0.005, 0.00125})
    expect_same(model, again(model, "robot.xml"), step, kLight, 60.0 * step * step);
}

TEST_F(Exports, OfLoopsAsAnMjcfMoveAsTheModel) {
  const Model model = model_of(R"(
bodies:
  crank: {mass: 1, inertia: [0.01, 0.01, 0.01], position: [0.1, 0, 0]}
  rod: {mass: 2, inertia: [0.01, 0.3, 0.3], position: [0.7, 0, 0]}
  rocker: {mass: 1, inertia: [0.1, 0.1, 0.01], position: [1.2, 0, -0.4]}
joints:
  A: {type: revolute, bodies: [ground, crank], at: [0, 0, 0], axis: y}
  B: {type: revolute, bodies: [crank, rod], at: [0.2, 0, 0], axis: y}
  C: {type: spherical, bodies: [rod, rocker], at: [1.2, 0, 0]}
  D: {type: revolute, bodies: [ground, rocker], at: [1.2, 0, -0.8], axis: y}
)");
  const io::Exported written = exported(model, "robot.xml");
  EXPECT_THAT(written.text, HasSubstr("<connect name=\"C\" site1=\"C_1\" site2=\"C_2\"/>"));
  for (const double step : {0.02, 0.005, 0.001})
    expect_same(model, again(model, "robot.xml"), step, 10 * kRounding, kGrown);
}

// From SDFormat to MJCF: three arms, and a platform on six rods with ball joints, in five loops.
TEST_F(Exports, OfADeltaRobotAsAnMjcfMoveAsTheModel) {
  Model model = io::read_model(test::source_dir() + "/examples/delta_robot/delta.sdf", {});
  for (const double step : {0.02, 0.005})
    expect_same(model, again(model, "robot.xml"), step, 1e-9, kLight);
}

TEST_F(Exports, HaveCouplingsAndStopsOfTheModel) {
  const Model model = model_of(R"(
bodies:
  a: {mass: 1, inertia: [0.1, 0.1, 0.02], position: [0.5, 0, 0]}
  b: {mass: 1, inertia: [0.1, 0.1, 0.02], position: [1.5, 0, 0]}
joints:
  A: {type: revolute, bodies: [ground, a], at: [0, 0, 0], axis: y, start: 0.2, limits: {lower: -1, upper: 1}}
  B: {type: revolute, bodies: [a, b], at: [1, 0, 0], axis: y, friction: {moment: 0.2}}
loads:
  gear: {type: coupling, joints: [B, A], factors: [-2], offset: 0.1}
)");
  const Model read = again(model, "robot.xml");
  EXPECT_EQ(read.joints.at(0).limits->upper, 1.0);
  EXPECT_EQ(read.joints.at(1).friction->constant, 0.2);
  expect_same(model, read, 0.005, 10 * kRounding, kGrown);
}

// A row of three coordinates is a fixed tendon that <equality> holds.
TEST_F(Exports, OfRowsForcesAndDampersAsAnMjcfMoveAsTheModel) {
  const Model model = model_of(std::string(kBodies) + R"(
  free: {mass: 1, inertia: [0.1, 0.2, 0.25], com: [0.1, 0.2, 0.3], position: [3, 0, 0], orientation: {axis: x, angle: 1}, velocity: [1, -2, 3], angular_velocity: [0.5, 1, -2]}
joints:
  shoulder: {type: revolute, bodies: [post, arm], at: [0.2, 0.1, 0.3], axis: [1, -1, 2]}
  rail: {type: prismatic, bodies: [second, arm], at: [0.7, 0.2, 0.1], axis: [1, 1, 0.3], start: -0.05}
  hinge: {type: revolute, bodies: [second, third], at: [1, 0.4, 0], axis: y, start: 0.3}
loads:
  row: {type: coupling, joints: [shoulder, rail, hinge], factors: [2, 0.5], offset: 0.35}
  carried: {type: force, body: second, force: [0, 0, 8.829]}
  wind: {type: force, body: third, at: [1.1, 0.3, 0.1], force: [0.4, -0.3, 0.2]}
  jet: {type: force, body: free, at_body: [0.3, 0.1, 0], force: [0.1, 0.7, -0.4], body_fixed: true}
  twist: {type: moment, body: arm, moment: [0.3, 0.1, -0.5]}
  wheel: {type: moment, body: free, moment: [0.02, -0.1, 0.03], body_fixed: true}
  air: {type: vector_damper, bodies: [ground, free], at_body: [[0, 0, 0], [0, 0, 0]], damping: 0.2, turning_damping: 0.2}
)");
  const std::string text = exported(model, "robot.xml").text;
  EXPECT_THAT(text, AllOf(HasSubstr("gravcomp=\"0.6"), HasSubstr("<tendon name=\"row\""),
                          HasSubstr("type=\"free\" damping=\"0.2")));
  const Model read = again(model, "robot.xml");
  EXPECT_EQ(read.loads.size(), 7U);
  for (const double step : {0.02, 0.005, 0.001})
    expect_same(model, read, step, 10 * kRounding, kGrown);
}

TEST_F(Exports, HaveTheStartAsKeyframe) {
  const std::string text = exported(model_of(R"(
bodies:
  a: {mass: 1, inertia: [0.1, 0.1, 0.02], position: [0, 0, -0.5]}
  f: {mass: 1, inertia: [0.1, 0.1, 0.02], com: [0, 0, 1], position: [2, 3, 5], velocity: [1, 2, 3], angular_velocity: [2, 0, 0]}
joints:
  A: {type: revolute, bodies: [ground, a], at: [0, 0, 0], axis: y, start: 0.25, start_rate: 3}
loads:
  m: {type: rotary_motor, joint: A, moment: 0.5}
)"),
                                    "robot.xml")
                               .text;
  const auto numbers = [&](const std::string& attribute) {
    const std::size_t begin = text.find(" " + attribute + "=\"") + attribute.size() + 3;
    std::istringstream list(text.substr(begin, text.find('"', begin) - begin));
    return std::vector<double>{std::istream_iterator<double>(list), {}};
  };
  const auto near = [](std::vector<double> values) {
    return testing::Pointwise(testing::DoubleNear(1e-12), std::move(values));
  };
  // The origin of f is 1 below its centre of mass: its velocity has w x r in addition, (2, 0, 0) x
  // (0, 0, -1) = (0, 2, 0).
  EXPECT_THAT(numbers("qpos"), near({0.25, 2, 3, 4, 1, 0, 0, 0}));
  EXPECT_THAT(numbers("qvel"), near({3, 1, 4, 3, 2, 0, 0}));
  EXPECT_THAT(numbers("ctrl"), near({0.5}));
}

TEST_F(Exports, RefuseByNameWhatAnMjcfHasNot) {
  const std::string bars = R"(
bodies:
  a: {mass: 1, inertia: [0.1, 0.1, 0.02], position: [0.5, 0, 0]}
  b: {mass: 1, inertia: [0.1, 0.1, 0.02], position: [1.5, 0, 0]}
joints:
  A: {type: revolute, bodies: [ground, a], at: [0, 0, 0], axis: y}
  B: {type: revolute, bodies: [a, b], at: [1, 0, 0], axis: y}
)";
  EXPECT_THAT(
      fault(bars + "  C: {type: revolute, bodies: [b, ground], at: [1.5, 0, 1], axis: y}\n",
            "a.xml"),
      AllOf(HasSubstr("joints.C: it closes a loop, and is revolute"), HasSubstr("spherical")));
  EXPECT_THAT(
      fault(bars + "  C: {type: distance, bodies: [b, ground], at: [[1.5, 0, 1], [0, 0, 2]]}\n",
            "a.xml"),
      HasSubstr("joints.C: an MJCF has no joint of the type distance"));
  EXPECT_THAT(fault(bars + "loads:\n  m: {type: rotary_motor, joint: A, angle: 0.2*t}\n", "a.xml"),
              HasSubstr("loads.m: an MJCF has no motors that prescribe a motion"));
  EXPECT_THAT(fault(bars + "loads:\n  m: {type: rotary_motor, joint: A, moment: 2*t}\n", "a.xml"),
              HasSubstr("loads.m: its target or effort is a function"));
  const std::string line = "bodies: [a, b], at: [[0.5, 0, 0], [1.5, 0, 0]]";
  EXPECT_THAT(fault(bars + "loads:\n  m: {type: potential, " + line + ", energy: l^2}\n", "a.xml"),
              HasSubstr("loads.m: an MJCF has no load of the type potential"));
  EXPECT_THAT(
      fault(bars + "loads:\n  m: {type: spring_damper, " + line + ", quadratic: 3}\n", "a.xml"),
      HasSubstr("loads.m: an MJCF has no springs and dampers with a law"));
  EXPECT_THAT(
      fault(bars + "loads:\n  m: {type: axial_force, " + line + ", pull: sin(t)}\n", "a.xml"),
      HasSubstr("loads.m: its target or effort is a function"));
  EXPECT_THAT(
      fault(bars + "loads:\n  m: {type: rotary_servo, joint: A, angle: 1, integral: 2}\n", "a.xml"),
      HasSubstr("loads.m: an MJCF has no servos with an integral"));
  EXPECT_THAT(fault(bars + "loads:\n  m: {type: force, body: a, force: [0, 0, sin(t)]}\n", "a.xml"),
              HasSubstr("loads.m: it is a function"));
  EXPECT_THAT(
      fault(bars + "loads:\n  m: {type: vector_damper, bodies: [ground, a], at: [[0, 0, 0], "
                   "[0, 0, 0]], damping: 1}\n",
            "a.xml"),
      HasSubstr("loads.m: an MJCF has no dampers between two bodies but those of joints, "
                "with one number for a free body, at its origin"));
}

}  // namespace
}  // namespace polhode::mjcf_writer_tests
