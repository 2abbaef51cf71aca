// SPDX-License-Identifier: Apache-2.0
// Models as URDFs, read again by the importer, which has its own tests against other programs.
#include <cmath>
#include <numbers>

#include "export_fixture.hpp"

#include <polhode/core/error.hpp>
#include <polhode/io/exporters/export_text.hpp>

namespace polhode::urdf_writer_tests {
namespace {

using test::Exports;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

/// A tree with products of inertia, bodies that are rotated, joints at offsets, one of them from
/// the second body to the first, and a branch.
constexpr const char* kTree = R"(
bodies:
  post: {fixed: true, mass: 4, inertia: [1, 2, 2.5], position: [0.1, 0.2, 0.3], orientation: {axis: [1, 2, 3], angle: 0.7}}
  arm:
    mass: 2
    inertia: {xx: 0.3, yy: 0.4, zz: 0.5, xy: 0.05, xz: -0.07, yz: 0.02}
    com: [0.2, -0.1, 0.05]
    position: [0.5, 0.1, 0.2]
    orientation: {axis: [0, 1, 1], angle: 1.1}
    shape: {box: [0.3, 0.1, 0.2], position: [0.1, 0, 0.1], orientation: {axis: x, angle: 0.4}}
  slide: {mass: 1.5, inertia: {xx: 0.02, yy: 0.03, zz: 0.04, xy: 0.003, xz: 0.001, yz: -0.004}, position: [0.9, 0.3, 0.1], orientation: {axis: [3, -1, 2], angle: 2.2}}
  tool: {mass: 0.7, inertia: [0.01, 0.02, 0.015], position: [1.1, 0.4, 0], orientation: {axis: y, angle: 90 deg}, shape: {capsule: [0.1, 0.4]}}
  side: {mass: 0.4, inertia: [0.01, 0.012, 0.015], position: [0.3, -0.2, 0.4], shape: {cylinder: [0.1, 0.3]}}
joints:
  shoulder: {type: revolute, bodies: [post, arm], at: [0.2, 0.1, 0.3], axis: [1, -1, 2], start: 0.4}
  rail: {type: prismatic, bodies: [slide, arm], at: [0.7, 0.2, 0.1], axis: [1, 1, 0.3], start: -0.05}
  grip: {type: fixed, bodies: [tool, slide], at: [1, 0.4, 0]}
  wrist: {type: revolute, bodies: [side, arm], at: [0.3, 0, 0.3], axis: y, start: 2.5}
loads:
  oil: {type: torsional_spring, joint: wrist, damping: 0.03}
  grease: {type: translational_spring, joint: rail, damping: 2}
)";
const io::Overrides kStart{"import.start.shoulder=0.4", "import.start.rail=-0.05",
                           "import.start.wrist=2.5"};
/// Rounding of a chain of a few bodies, of mass 1 and length 1.
constexpr double kRounding = 1e-13;
/// Part of it that grows over a second of motion, and that the iterations leave.
constexpr double kGrown = 1e-10;

TEST_F(Exports, AsAUrdfMoveAsTheModel) {
  const Model model = model_of(kTree);
  const Model read = again(model, "robot.urdf", kStart);
  for (const double step : {0.02, 0.005, 0.001})
    expect_same(model, read, step, 10 * kRounding, kGrown);
}

TEST_F(Exports, OfAnExampleAsAUrdfMoveAsTheModel) {
  const Model model =
      io::read_model(test::source_dir() + "/examples/double_pendulum/model.yaml", {});
  for (const double step : {0.02, 0.005, 0.001})
    expect_same(model, again(model, "robot.urdf"), step, 10 * kRounding, kGrown);
}

TEST_F(Exports, OfFreePlanarAndChainedBodiesAsAUrdfMoveAsTheModel) {
  const Model model = model_of(R"(
bodies:
  drone: {mass: 2, inertia: {xx: 0.3, yy: 0.4, zz: 0.5, xy: 0.05}, com: [0.1, 0, 0.2], position: [1, 2, 3], orientation: {axis: [1, 1, 0], angle: 0.5}}
  arm: {mass: 1, inertia: [0.1, 0.1, 0.02], position: [1.5, 2, 3]}
  puck: {mass: 1, inertia: [0.1, 0.1, 0.02], position: [0, 0, 0.5], orientation: {axis: z, angle: 0.3}}
joints:
  hinge: {type: revolute, bodies: [arm, drone], at: [1.2, 2, 3], axis: x}
  table: {type: planar, bodies: [ground, puck], at: [0.2, 0.1, 0.3], axis: [1, 0, 1]}
)");
  for (const double step : {0.02, 0.005, 0.001})
    expect_same(model, again(model, "robot.urdf"), step, kRounding * 100, kGrown);
}

TEST_F(Exports, HaveTheStopsAndFrictionOfTheModel) {
  const Model read = again(model_of(R"(
bodies:
  arm: {mass: 1, inertia: [0.1, 0.1, 0.02], position: [0.5, 0, 0]}
  cart: {mass: 1, inertia: [0.1, 0.1, 0.02], position: [1, 0, 0]}
joints:
  hinge: {type: revolute, bodies: [ground, arm], at: [0, 0, 0], axis: y, limits: {lower: -0.3, upper: 2}, friction: {moment: 0.7}}
  rail: {type: prismatic, bodies: [arm, cart], at: [1, 0, 0], axis: x, limits: {upper: 0.4}, friction: {force: 3}}
)"),
                           "robot.urdf");
  const JointSpec& hinge = read.joints.at(0);
  EXPECT_EQ(hinge.limits->lower, -0.3);
  EXPECT_EQ(hinge.limits->upper, 2.0);
  EXPECT_EQ(hinge.friction->constant, 0.7);
  const JointSpec& rail = read.joints.at(1);
  EXPECT_EQ(rail.limits->upper, 0.4);
  EXPECT_LT(*rail.limits->lower, -1e8);
  EXPECT_EQ(rail.friction->constant, 3.0);
}

TEST_F(Exports, HaveShapesWithTheirSizesAndPlaces) {
  const Model model = model_of(kTree);
  const Model read = again(model, "robot.urdf", kStart);
  for (const char* name : {"arm", "tool", "side"}) {
    const BodySpec& a = model.bodies.at(static_cast<std::size_t>(model.body_index(name)));
    const BodySpec& b = read.bodies.at(static_cast<std::size_t>(read.body_index(name)));
    ASSERT_EQ(b.shapes.size(), 1U);
    EXPECT_EQ(a.shapes[0].type, b.shapes[0].type);
    for (std::size_t k = 0; k < a.shapes[0].sizes.size(); ++k)
      EXPECT_NEAR(a.shapes[0].sizes[k], b.shapes[0].sizes[k], kRounding);
    // From the centre of mass, in the axes of the body, which are those of the link.
    EXPECT_NEAR((a.shapes[0].position - a.com - b.shapes[0].position + b.com).norm(), 0, kRounding);
    EXPECT_NEAR(a.shapes[0].orientation.angularDistance(b.shapes[0].orientation), 0, 1e-7);
  }
}

TEST_F(Exports, HaveACouplingAsMimic) {
  const Model model = model_of(R"(
bodies:
  a: {mass: 1, inertia: [0.1, 0.1, 0.02], position: [0.5, 0, 0]}
  b: {mass: 1, inertia: [0.1, 0.1, 0.02], position: [1.5, 0, 0]}
joints:
  A: {type: revolute, bodies: [ground, a], at: [0, 0, 0], axis: y, start: 0.2}
  B: {type: revolute, bodies: [a, b], at: [1, 0, 0], axis: y}
loads:
  gear: {type: coupling, joints: [B, A], factors: [-2], offset: 0.1}
)");
  expect_same(model, again(model, "robot.urdf", {"import.start.A=0.2"}), 0.005, kRounding * 100,
              kGrown);
}

// Differences of rotations that are composed again, also where roll and yaw have the same axis.
TEST(RollPitchYaw, GivesTheRotationAgain) {
  for (const double pitch : {0.3, std::numbers::pi / 2, -std::numbers::pi / 2, 1.5707963, 2.4})
    for (const double yaw : {0.0, 1.0, -3.0})
      for (const double roll : {0.0, 0.4, 3.1}) {
        const auto turn = [](double angle, int k) {
          return Eigen::AngleAxisd(angle, Vec3::Unit(k)).toRotationMatrix();
        };
        const Mat3 R = turn(yaw, 2) * turn(pitch, 1) * turn(roll, 0);
        const Vec3 rpy = io::rpy_of_rotation(R);
        const Mat3 S = turn(rpy.z(), 2) * turn(rpy.y(), 1) * turn(rpy.x(), 0);
        EXPECT_NEAR((R - S).norm(), 0.0, 1e-15 * 4) << pitch << " " << yaw << " " << roll;
      }
}

constexpr const char* kBar =
    "bodies:\n  bar: {mass: 1, inertia: [0.1, 0.1, 0.02], position: [0.5, 0, 0]}\n";

TEST_F(Exports, RefuseByNameWhatAUrdfHasNot) {
  const std::string hinge =
      std::string(kBar) +
      "joints:\n  A: {type: revolute, bodies: [ground, bar], at: [0, 0, 0], axis: y}\n";
  EXPECT_THAT(fault(std::string(kBar) +
                        "joints:\n  A: {type: spherical, bodies: [ground, bar], at: [0, 0, 0]}\n",
                    "a.urdf"),
              AllOf(HasSubstr("joints.A: a URDF has no joint of the type spherical"),
                    HasSubstr("Export an MJCF")));
  EXPECT_THAT(
      fault(hinge + "loads:\n  push: {type: force, body: bar, force: [1, 0, 0]}\n", "a.urdf"),
      HasSubstr("loads.push: a URDF has no load of the type force"));
  EXPECT_THAT(
      fault(hinge + "loads:\n  s: {type: torsional_spring, joint: A, stiffness: 3}\n", "a.urdf"),
      HasSubstr("loads.s: a URDF has no springs"));
  EXPECT_THAT(fault(hinge + "loads:\n  m: {type: rotary_motor, joint: A, moment: 3}\n", "a.urdf"),
              HasSubstr("loads.m: a URDF has no motors"));
  EXPECT_THAT(
      fault(hinge + "  B: {type: spherical, bodies: [ground, bar], at: [0, 1, 0]}\n", "a.urdf"),
      HasSubstr("joints.B"));
  EXPECT_THAT(fault(hinge + "events:\n  stop: {at: 0.1, off: [A]}\n", "a.urdf"),
              HasSubstr("events.stop: a URDF has no events"));
  EXPECT_THAT(
      fault("bodies:\n  a: {shape: {sphere: 1}, density: 1}\n  b: {shape: {sphere: 1}, density: "
            "1, position: [3, 0, 0]}\ncontacts: {default: {}}\n",
            "a.urdf"),
      HasSubstr("contacts: a URDF has other laws of contact"));
  EXPECT_THAT(fault("bodies:\n  p: {mass: 1, point_mass: true}\n", "a.urdf"),
              HasSubstr("bodies.p: a URDF has no point masses"));
  EXPECT_THAT(fault("bodies:\n  p: {shape: {cone: [1, 1]}, density: 1}\n", "a.urdf"),
              HasSubstr("a URDF has no shape of the type cone"));
}

TEST_F(Exports, ReportWhatIsLeftOutAndWhatBelongsElsewhere) {
  const std::string told = notes(std::string(kBar) + R"(
  top: {mass: 1, inertia: [0.1, 0.1, 0.02], position: [0.5, 0, 1], angular_velocity: [0, 0, 2], shape: {cone: [1, 1]}}
joints:
  A: {type: revolute, bodies: [ground, bar], at: [0, 0, 0], axis: y, start: 0.5}
loads:
  push: {type: force, body: bar, force: [1, 0, 0]}
)",
                                 "a.urdf", true);
  EXPECT_THAT(told, AllOf(HasSubstr("left out: loads.push: a URDF has no load"),
                          HasSubstr("left out: bodies.top.shape: a URDF has no shape of the type"),
                          HasSubstr("not in the file: joints.A.start: it starts at 0.5 rad"),
                          HasSubstr("not in the file: bodies: they have velocities"),
                          Not(HasSubstr("gravity"))));
}

TEST_F(Exports, RefuseNamesThatNoFileHas) {
  Model model = model_of(kBar);
  model.bodies[0].name = "my bar";
  EXPECT_THAT(fault(model, "a.urdf"),
              HasSubstr("the name 'my bar' contains a space or control character. Rename it"));
  model.bodies[0].name = "";
  EXPECT_THAT(fault(model, "a.xml"), HasSubstr("an entry has no name. Give each body and joint"));
  model.bodies[0].name = "world";
  EXPECT_THAT(exported(model, "a.urdf").text,
              AllOf(HasSubstr("<link name=\"world\"/>"), HasSubstr("<link name=\"world_body\">")));
  EXPECT_THAT(exported(model, "a.xml").text, HasSubstr("<body name=\"world_body\""));
  EXPECT_EQ(exported(model, "a.xml").notes.at(0).what, "is called 'world_body' in the file");
}

TEST_F(Exports, RefuseOtherEndings) {
  try {
    static_cast<void>(exported(model_of(kBar), "robot.dae"));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("Name a file that ends in .urdf or .xml"));
  }
}

}  // namespace
}  // namespace polhode::urdf_writer_tests
