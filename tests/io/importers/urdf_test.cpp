// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>

#include <gmock/gmock.h>

#include <polhode/core/format.hpp>
#include <polhode/io/read/read_import.hpp>
#include <polhode/model/whole_mass.hpp>
#include <polhode/simulation/simulation.hpp>

#include <support/scratch.hpp>

namespace polhode::urdf_tests {
namespace {

using testing::HasSubstr;

/// Rounding of a few operations on numbers of size 1.
constexpr double kRounding = 1e-14;

const std::string kInertial =
    "<inertial><mass value='2'/><inertia ixx='0.3' iyy='0.3' izz='0.2'/></inertial>";

std::string link(const std::string& name, const std::string& inside = kInertial) {
  return "<link name='" + name + "'>" + inside + "</link>\n";
}
std::string joint(const std::string& name, const std::string& type, const std::string& parent,
                  const std::string& child, const std::string& inside = "") {
  return "<joint name='" + name + "' type='" + type + "'><parent link='" + parent +
         "'/><child link='" + child + "'/>" + inside + "</joint>\n";
}

class Urdf : public testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name) << text;
    return folder_ / name;
  }
  Model read(const std::string& inside, const io::Overrides& overrides = {}) {
    return io::read_model(write("robot.urdf", "<robot name='r'>\n" + inside + "</robot>\n"),
                          overrides);
  }
  /// Message of a file that is refused.
  std::string fault(const std::string& text, const io::Overrides& overrides = {}) {
    try {
      static_cast<void>(io::read_model(write("robot.urdf", text), overrides));
    } catch (const io::ModelErrors& errors) {
      return errors.text();
    }
    return "none";
  }
  std::string robot_fault(const std::string& inside, const io::Overrides& overrides = {}) {
    return fault("<robot name='r'>\n" + inside + "</robot>\n", overrides);
  }
  /// What a report says, one note a line.
  std::string notes(const std::string& inside, const io::Overrides& overrides = {}) {
    write("robot.urdf", "<robot name='r'>\n" + inside + "</robot>\n");
    std::string text;
    for (const io::ImportNote& n :
         io::expanded_model(folder_ / "robot.urdf", overrides).report.notes)
      text += format("{}: {}: {}\n", n.place.line, io::word_of(n.kind), n.what);
    return text;
  }

  test::Scratch folder_;
};

// Origins are chained, roll-pitch-yaw is about fixed axes, and the inertial has a rotation of its
// own.
TEST_F(Urdf, LinksHaveTheirMassWhereOriginsSay) {
  const Model model =
      read(link("base", "") +
           link("arm",
                "<inertial><origin xyz='0 0 1' rpy='0 0 1.5707963267948966'/><mass value='2'/>"
                "<inertia ixx='0.3' iyy='0.2' izz='0.4' ixy='0.01'/></inertial>") +
           joint("hinge", "continuous", "base", "arm",
                 "<origin xyz='1 0 0' rpy='1.5707963267948966 0 0'/><axis xyz='0 0 2'/>"));
  ASSERT_EQ(model.bodies.size(), 2U);
  EXPECT_TRUE(model.bodies[0].fixed);
  const BodySpec& arm = model.bodies[1];
  EXPECT_EQ(arm.mass, 2.0);
  // z of the link is -y of the world.
  EXPECT_NEAR((arm.position - Vec3(1, -1, 0)).norm(), 0.0, kRounding);
  // A quarter turn about z exchanges x and y, and the product changes its sign.
  EXPECT_NEAR(arm.inertia(0, 0), 0.2, kRounding);
  EXPECT_NEAR(arm.inertia(1, 1), 0.3, kRounding);
  EXPECT_NEAR(arm.inertia(0, 1), -0.01, kRounding);
  EXPECT_EQ(model.gravity, Vec3(0, 0, -9.81));
}

// From rest at an angle of 1, energy gives the rate wherever the pendulum is:
// (J + m l^2) w^2 / 2 = m g (z_0 - z). Rates at the ends of steps are of second
// order.
TEST_F(Urdf, PendulumFallsAsItsEnergySays) {
  const std::string inside = link("base", "") +
                             link("bob",
                                  "<inertial><origin xyz='0 0 -0.5'/><mass value='2'/>"
                                  "<inertia ixx='0.1' iyy='0.1' izz='0.05'/></inertial>") +
                             joint("hinge", "continuous", "base", "bob", "<axis xyz='0 1 0'/>");
  const double z_0 = -0.5 * std::cos(1.0);
  for (const double step : {0.1, 0.01, 0.001}) {
    Model model = read(inside, {"import.start.hinge=1"});
    model.analysis.step = step;
    Simulation simulation(model);
    while (simulation.time() < 0.999) {
      simulation.step(1.0);
      const BodyMotion bob = simulation.body("bob");
      EXPECT_NEAR(0.5 * 0.6 * bob.omega().squaredNorm(), 2.0 * 9.81 * (z_0 - bob.r.z()),
                  step * step);
    }
  }
}

TEST_F(Urdf, EveryTypeOfJointHasItsFreedoms) {
  const auto freedoms = [&](const std::string& type) {
    Simulation simulation(read(link("base", "") + link("arm") + joint("j", type, "base", "arm")));
    return 6 * simulation.system().body_count() - simulation.system().rows();
  };
  EXPECT_EQ(freedoms("revolute"), 1);
  EXPECT_EQ(freedoms("continuous"), 1);
  EXPECT_EQ(freedoms("prismatic"), 1);
  EXPECT_EQ(freedoms("planar"), 3);
  EXPECT_EQ(freedoms("floating"), 6);
}

TEST_F(Urdf, FixedLinksKeepTheirMassWeldedOrMerged) {
  const std::string inside =
      link("base", "") + link("arm") + link("tool") + link("frame", "") +
      joint("j", "continuous", "base", "arm") +
      joint("weld", "fixed", "arm", "tool", "<origin xyz='0.3 0 0' rpy='0 0.4 0'/>") +
      joint("mark", "fixed", "tool", "frame", "<origin xyz='0 0 1'/>");
  const Model welded = read(inside), merged = read(inside, {"import.fixed_joints=merge"});
  EXPECT_EQ(welded.bodies.size(), 3U);  // The frame has no mass.
  EXPECT_EQ(merged.bodies.size(), 2U);
  const auto a = whole_mass(welded), b = whole_mass(merged);
  EXPECT_EQ(a.mass, 4.0);
  EXPECT_NEAR((a.com - b.com).norm(), 0.0, kRounding);
  EXPECT_NEAR((a.inertia - b.inertia).norm(), 0.0, kRounding);
}

TEST_F(Urdf, FloatingBaseIsFree) {
  const std::string inside = link("root", "") + link("trunk") + link("leg") +
                             joint("r", "fixed", "root", "trunk") +
                             joint("hip", "continuous", "trunk", "leg");
  const Simulation simulation(read(inside, {"import.base=floating"}));
  EXPECT_EQ(simulation.system().body_count(), 2);
  EXPECT_EQ(6 * simulation.system().body_count() - simulation.system().rows(), 7);
}

TEST_F(Urdf, StartsByNameAndLimitsAreAbsolute) {
  const std::string inside =
      link("base", "") + link("arm") + link("slide") +
      joint("turn", "revolute", "base", "arm",
            "<axis xyz='0 0 1'/><limit lower='0' upper='1.5'/>") +
      joint("move", "prismatic", "arm", "slide", "<limit lower='-0.5' upper='-0.1'/>");
  const Model model = read(inside, {"import.start.turn=0.7"});
  EXPECT_NEAR(
      model.bodies[1].orientation.angularDistance(Quat(Eigen::AngleAxisd(0.7, Vec3::UnitZ()))), 0.0,
      1e-7);
  // 0 is outside the limits of the slide, so that it starts at the nearer one.
  EXPECT_NEAR(
      (model.bodies[2].position - Vec3(-0.1 * std::cos(0.7), -0.1 * std::sin(0.7), 0)).norm(), 0.0,
      kRounding);
  EXPECT_EQ(model.joints[0].limits->upper, 1.5);
  const Simulation simulation(model);
  EXPECT_LT(simulation.start_report().largest_move, 1e-12);
  EXPECT_THAT(notes(inside),
              HasSubstr("the joint 'move' starts at its limit -0.1, as 0 is outside"));
  EXPECT_THAT(robot_fault(inside, {"import.start.turn=2"}),
              HasSubstr("would start at 2, outside its limits 0 to 1.5"));
  EXPECT_THAT(robot_fault(inside, {"import.start.tun=1"}), HasSubstr("Did you mean 'turn'?"));
}

TEST_F(Urdf, StartsHaveUnits) {
  const std::string inside = link("base", "") + link("arm") + link("slide") + link("plate") +
                             joint("turn", "continuous", "base", "arm", "<axis xyz='0 0 1'/>") +
                             joint("move", "prismatic", "arm", "slide") +
                             joint("float", "planar", "base", "plate", "<axis xyz='0 0 1'/>");
  const auto place = [&](const io::Overrides& start) {
    const Model model = read(inside, start);
    return std::pair(model.bodies.at(2).position, model.bodies.at(3).orientation);
  };
  const auto known = place({"import.start.turn=0.5235987755982988", "import.start.move=0.2",
                            "import.start.float=[0.1, 0.3, 0.6981317007977318]"});
  const auto given = place({"import.start.turn=30 deg", "import.start.move=20 cm",
                            "import.start.float=[100 mm, 0.3, 40 deg]"});
  EXPECT_NEAR((given.first - known.first).norm(), 0.0, kRounding);
  EXPECT_NEAR(given.second.angularDistance(known.second), 0.0, 1e-7);
  EXPECT_NEAR(known.first.x(), 0.2 * std::cos(0.5235987755982988), kRounding);
  EXPECT_THAT(robot_fault(inside, {"import.start.turn=1 mm"}),
              HasSubstr("its coordinate 1 is an angle, and a length is given"));
  EXPECT_THAT(robot_fault(inside, {"import.start.float=[0, 2 deg, 0]"}),
              HasSubstr("its coordinate 2 is a length, and an angle is given"));
  EXPECT_THAT(robot_fault(inside, {"import.start.turn=2 kg"}), HasSubstr("a mass"));
}

TEST_F(Urdf, LoopJointClosesALoop) {
  const std::string inside =
      link("base", "") + link("a") + link("b") +
      joint("ja", "continuous", "base", "a", "<axis xyz='0 1 0'/>") +
      joint("jb", "continuous", "base", "b", "<origin xyz='1 0 0'/><axis xyz='0 1 0'/>") +
      "<loop_joint name='rod' type='fixed'><link1 link='a' xyz='0 0 1'/>"
      "<link2 link='b' xyz='-1 0 1'/></loop_joint>\n";
  const Model model = read(inside);
  EXPECT_EQ(loop_count(model), 1);
  EXPECT_LT(Simulation(model).start_report().position_residual, 1e-12);
  EXPECT_THAT(
      robot_fault(
          link("a") +
          "<loop_joint name='l' type='fixed'><link1 link='a'/><link2 link='c'/></loop_joint>"),
      HasSubstr("there is no link 'c'"));
}

TEST_F(Urdf, OverlayAddsToItAndChangesIt) {
  write("robot.overlay.yaml",
        "format: 1\nimport: {start: {j: 0.2}}\ngravity: [0, 0, -1.62]\n"
        "bodies: {arm: {mass: 3}}\n"
        "loads: {push: {type: force, body: arm, at_body: [0, 0, 0], force: [1, 0, 0]}}\n");
  const Model model =
      read(link("base", "") + link("arm") + joint("j", "continuous", "base", "arm"));
  EXPECT_EQ(model.gravity.z(), -1.62);
  EXPECT_EQ(model.bodies[1].mass, 3.0);
  EXPECT_EQ(model.bodies[1].inertia(0, 0), 0.3);
  EXPECT_EQ(model.loads.size(), 1U);
}

TEST_F(Urdf, ConvertedTextIsTheSameModel) {
  const std::string inside =
      link("base", "") +
      link("arm", kInertial +
                      "<visual><origin xyz='0.1 0 0' rpy='0.3 0.2 0.1'/><geometry><capsule "
                      "radius='0.1' length='0.3'/></geometry></visual>") +
      link("hand") +
      joint("j", "revolute", "base", "arm",
            "<origin xyz='0.1 0.2 0.3' rpy='0.1 0.7 -0.3'/><axis xyz='1 2 3'/>"
            "<limit lower='-1' upper='1'/><dynamics damping='0.1' friction='0.05'/>") +
      joint("k", "prismatic", "arm", "hand", "<axis xyz='0.3 0.4 0'/>");
  Model direct = read(inside);
  Model converted =
      io::read_model(write("model.yaml", io::expanded_model(folder_ / "robot.urdf").text));
  ASSERT_EQ(direct.bodies.size(), converted.bodies.size());
  for (Model* m : {&direct, &converted}) m->analysis.duration = 0.2;
  Simulation a(direct), b(converted);
  while (a.time() < 0.2) a.step(0.2);
  while (b.time() < 0.2) b.step(0.2);
  EXPECT_EQ(a.state_hash(), b.state_hash());
}

TEST_F(Urdf, WhatIsNotReadIsListed) {
  const std::string said =
      notes(link("base",
                 "<visual><geometry><box size='1 1 1'/></geometry><material name='m'/></visual>") +
            link("arm", kInertial + "<colour/>") +
            joint("j", "continuous", "base", "arm",
                  "<limit effort='3' velocity='2'/><axis xyz='0 0 1' w='1'/>") +
            "<transmission name='t'><type/></transmission><gazebo/><gazebo/>");
  EXPECT_THAT(said, HasSubstr("<colour> in <link> is unknown"));
  EXPECT_THAT(said, HasSubstr("attribute 'w' of <axis> is unknown"));
  EXPECT_THAT(said, HasSubstr("<gazebo> in <robot> has no influence on the motion (2 times)"));
  EXPECT_THAT(said,
              HasSubstr("attribute 'effort' of <limit> limits an actuator, and there is none"));
}

TEST_F(Urdf, BrokenFilesAreRefusedWithTheirLine) {
  EXPECT_THAT(fault(""), HasSubstr("the file is empty"));
  EXPECT_THAT(fault("<robot name='r'>\n<link name='a'>"), HasSubstr("the text is not XML"));
  EXPECT_THAT(fault("<robot>\n<link name='a\xff'/></robot>"), HasSubstr("the text is not UTF-8"));
  EXPECT_THAT(fault("<sdf/>"), HasSubstr("the file's tag is <sdf>, not <robot>"));
  EXPECT_THAT(fault("<!DOCTYPE r [\n<!ENTITY a '&b;&b;'>]><robot/>"),
              HasSubstr("declarations of entities are not allowed"));
  std::string deep;
  for (int k = 0; k < 1000; ++k) deep += "<a>";
  EXPECT_THAT(fault("<robot>" + deep), HasSubstr("tags are nested more than"));
  EXPECT_THAT(robot_fault(link("a", "<inertial><mass value='1e999'/></inertial>")),
              HasSubstr("robot.urdf:2:"));
  EXPECT_THAT(robot_fault(link("a", "<inertial><mass value='two'/></inertial>")),
              HasSubstr("'value' of <mass> is 'two', not a number"));
  EXPECT_THAT(robot_fault(link("a") + link("a")), HasSubstr("the link 'a' stands twice"));
  EXPECT_THAT(robot_fault(link("a") + link("b")), HasSubstr("2 links have no parent: a, b"));
  EXPECT_THAT(robot_fault(link("a") + link("b") + joint("j", "hinge", "a", "b")),
              HasSubstr("the joint 'j' has the unknown type 'hinge'"));
  EXPECT_THAT(robot_fault(link("a") + joint("j", "fixed", "a", "b")),
              HasSubstr("there is no link 'b'"));
  EXPECT_THAT(
      robot_fault(link("a") + link("b") + joint("j", "planar", "a", "b", "<axis xyz='0 0 0'/>")),
      HasSubstr("the axis has no length"));
  EXPECT_THAT(robot_fault(link("a") + link("b") +
                          joint("j", "revolute", "a", "b", "<limit lower='1' upper='-1'/>")),
              HasSubstr("the joint 'j' has the limits 1 to -1"));
}

TEST_F(Urdf, CyclesAreRefused) {
  EXPECT_THAT(robot_fault(link("a") + link("b") + joint("j", "fixed", "a", "b") +
                          joint("k", "fixed", "b", "a")),
              HasSubstr("is its own ancestor"));
  EXPECT_THAT(robot_fault(link("a") + link("b") + link("c") + joint("j", "fixed", "a", "c") +
                          joint("k", "fixed", "b", "c")),
              HasSubstr("the link 'c' is the child of two joints, 'j' and 'k'"));
}

TEST_F(Urdf, MimicOfItselfIsRefused) {
  const std::string links = link("a", "") + link("b") + link("c");
  EXPECT_THAT(robot_fault(links + joint("j", "continuous", "a", "b", "<mimic joint='k'/>") +
                          joint("k", "continuous", "b", "c", "<mimic joint='j'/>")),
              HasSubstr("follows itself by <mimic>"));
  EXPECT_THAT(robot_fault(links + joint("j", "continuous", "a", "b", "<mimic joint='x'/>") +
                          joint("k", "continuous", "b", "c")),
              HasSubstr("there is no joint 'x'"));
}

// Two bars on a frame that swings, the second one at -2 times the angle of the first.
TEST_F(Urdf, MimicOfAParallelAxisIsACoupling) {
  const std::string inside =
      link("base", "") + link("frame") + link("one") + link("two") +
      joint("swing", "continuous", "base", "frame", "<origin rpy='0 0.7 0'/><axis xyz='0 1 0'/>") +
      joint("a", "continuous", "frame", "one", "<origin xyz='0 0 1'/><axis xyz='1 0 0'/>") +
      joint("b", "continuous", "frame", "two",
            "<origin xyz='0 0.5 1'/><axis xyz='1 0 0'/><mimic joint='a' multiplier='-2' "
            "offset='0.1'/>");
  for (const double step : {0.02, 0.01, 0.0002}) {
    Model model = read(inside, {"import.start.a=0.3", "bodies.one.com=[0, 0, 0.1]"});
    model.analysis.step = step;
    Simulation simulation(model);
    while (simulation.time() < 0.3) simulation.step(0.3);
    const Mat3 frame = simulation.body("frame").Lambda();
    const auto angle = [&](const char* name) {
      const Mat3 R = frame.transpose() * simulation.body(name).Lambda();
      return std::atan2(R(2, 1), R(1, 1));
    };
    EXPECT_GT(std::abs(angle("one") - 0.3), 0.01);  // It falls.
    EXPECT_NEAR(angle("two"), -2.0 * angle("one") + 0.1, 1e-11);
  }
}

/// Coordinates of joints at the end of 0.3 s with this step.
std::vector<double> coordinates(const Model& given, double step,
                                const std::vector<std::string>& joints) {
  Model model = given;
  model.analysis.step = step;
  Simulation simulation(model);
  while (simulation.time() < 0.3) simulation.step(0.3);
  std::vector<double> list;
  for (const std::string& name : joints)
    list.push_back(simulation.joint(model.joint_index(name)).coordinates.at(0));
  return list;
}

// A slide on an arm follows the arm's angle; a hinge on the slide follows the slide by a chain.
TEST_F(Urdf, MimicOfAnyJointsIsExact) {
  const std::string inside =
      link("base", "") + link("one") + link("two") + link("three") +
      joint("a", "continuous", "base", "one", "<axis xyz='1 0 0'/>") +
      joint("b", "prismatic", "one", "two",
            "<origin xyz='0 0.5 0' rpy='0.4 0 0'/><axis xyz='0 1 0'/>"
            "<limit lower='-9' upper='9'/><mimic joint='a' multiplier='0.3' offset='0.1'/>") +
      joint("c", "continuous", "two", "three",
            "<origin xyz='0 0 1'/><axis xyz='0 0 1'/><mimic joint='b' multiplier='-4'/>");
  const Model model = read(inside, {"import.start.a=0.3"});
  EXPECT_EQ(model.loads.size(), 2U);
  for (const double step : {0.02, 0.002, 0.0002}) {
    const std::vector<double> q = coordinates(model, step, {"a", "b", "c"});
    EXPECT_GT(std::abs(q[0] - 0.3), 0.01);
    EXPECT_NEAR(q[1], 0.3 * q[0] + 0.1, 1e-12) << step;
    EXPECT_NEAR(q[2], -4.0 * q[1], 1e-12) << step;
  }
  // A start beyond half a turn: 4 rad is -2.28 rad for the model, the row is the same.
  const std::vector<double> q = coordinates(read(inside, {"import.start.a=4"}), 0.002, {"a", "b"});
  EXPECT_NEAR(q[1], 0.3 * (q[0] + 2.0 * std::numbers::pi) + 0.1, 1e-12);
}

// Two fingers follow a joint without mass, and so each other; one alone moves freely.
TEST_F(Urdf, MimicOfAJointThatMovesNothingCouplesItsFollowers) {
  const std::string finger =
      "<origin xyz='0 0 1'/><axis xyz='1 0 0'/><limit lower='-9' upper='9'/>";
  const std::string first = joint("x", "prismatic", "arm", "left",
                                  finger + "<mimic joint='m' multiplier='2' offset='0.1'/>");
  const std::string inside = link("base", "") + link("arm") + link("left") + link("screen", "") +
                             joint("a", "continuous", "base", "arm", "<axis xyz='0 1 0'/>") +
                             joint("m", "continuous", "arm", "screen") + first;
  EXPECT_TRUE(read(inside).loads.empty());
  EXPECT_THAT(notes(inside), HasSubstr("the joint 'x' moves freely, as 'm', which it follows"));
  const Model model = read(inside + link("right") +
                           joint("y", "prismatic", "arm", "right",
                                 finger + "<mimic joint='m' multiplier='-1' offset='0.2'/>"));
  const std::vector<double> q = coordinates(model, 0.002, {"x", "y"});
  EXPECT_NEAR(q[1], -0.5 * (q[0] - 0.1) + 0.2, 1e-12);
  // A multiplier of zero holds the joint.
  const std::vector<double> held = coordinates(
      read(
          link("base", "") + link("one") + link("two") + joint("a", "continuous", "base", "one") +
          joint("b", "continuous", "one", "two", "<mimic joint='a' multiplier='0' offset='0.4'/>")),
      0.002, {"b"});
  EXPECT_NEAR(held[0], 0.4, 1e-13);
}

// A cross without mass between two hinges that do not meet: the same motion as that of a link whose
// two rotations are written out, J ω and m of the outer link alone.
TEST_F(Urdf, ALinkWithoutMassBetweenJointsMovesAsTheyLetIt) {
  const auto text = [&](const std::string& cross) {
    return link("base", "") + link("cross", cross) +
           link("arm",
                "<inertial><origin xyz='0 0 -0.5'/><mass value='2'/>"
                "<inertia ixx='0.1' iyy='0.12' izz='0.05'/></inertial>") +
           joint("j", "continuous", "base", "cross", "<axis xyz='1 0 0'/>") +
           joint("k", "continuous", "cross", "arm",
                 "<origin xyz='0.02 0.05 0'/><axis xyz='0 1 0'/>");
  };
  EXPECT_THAT(notes(text("")),
              HasSubstr("the link 'cross' has no mass, and takes 1e-10 of that of 'arm'"));
  for (const double step : {0.02, 0.002, 0.0002}) {
    const auto moved = [&](const std::string& cross) {
      Model model = read(text(cross), {"import.start.j=0.7", "import.start.k=-0.4"});
      model.analysis.step = step;
      Simulation simulation(model);
      while (simulation.time() < 0.399) simulation.step(1.0);
      return simulation.body("arm").r;
    };
    const auto with = [&](const std::string& m, const std::string& J) {
      return moved("<inertial><mass value='" + m + "'/><inertia ixx='" + J + "' iyy='" + J +
                   "' izz='" + J + "'/></inertial>");
    };
    const Vec3 none = moved("");
    // Linear in a small mass: its effect vanishes towards none.
    const Vec3 some = with("2e-5", "2e-6") - none, less = with("1e-5", "1e-6") - none;
    EXPECT_GT(some.norm(), 1e-8) << step;
    EXPECT_NEAR(some.norm() / less.norm(), 2.0, 1e-3) << step;
  }
}

TEST_F(Urdf, MovingLinksNeedMassAndInertia) {
  const std::string base = link("base", "");
  EXPECT_THAT(robot_fault(base + link("arm", "<inertial><mass value='1'/><inertia/></inertial>") +
                          joint("j", "continuous", "base", "arm")),
              HasSubstr("the link 'arm' has no inertia"));
  EXPECT_THAT(robot_fault(base + link("cross", "") + link("arm") +
                          joint("j", "continuous", "base", "cross") +
                          joint("k", "continuous", "cross", "arm")),
              HasSubstr("the link 'cross' has no mass, but moves between two joints"));
  EXPECT_THAT(
      notes(base + link("arm") +
            joint("j", "fixed", "base", "arm", "<axis xyz='0 0 0'/><dynamics damping='1'/>")),
      HasSubstr("<dynamics> of a fixed joint has no influence on the motion"));
  // Without anything on it, it has no influence.
  const std::string wheel = base + link("arm") + link("wheel", "") +
                            joint("j", "continuous", "base", "arm") +
                            joint("k", "continuous", "arm", "wheel");
  EXPECT_EQ(read(wheel).bodies.size(), 2U);
  EXPECT_THAT(notes(wheel), HasSubstr("its joint 'k' is held, which changes no other motion"));
}

TEST_F(Urdf, MeshesAreFoundInPackagesAndMissingOnesNamed) {
  std::filesystem::create_directories(folder_ / "pack/meshes");
  write("pack/meshes/tetra.obj",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n");
  write("pack/meshes/open.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\n");
  write("pack/meshes/picture.ply", "ply");
  const auto with = [&](const std::string& file, const std::string& scale = "") {
    return link("base", "") +
           link("arm", kInertial + "<visual><geometry><mesh filename='" + file + "'" + scale +
                           "/></geometry></visual>") +
           joint("j", "continuous", "base", "arm");
  };
  const Model model = read(with("package://pack/meshes/tetra.obj", " scale='0.1 0.1 0.1'"));
  ASSERT_EQ(model.bodies[1].shapes.size(), 1U);
  EXPECT_EQ(model.bodies[1].shapes[0].type, "mesh");
  EXPECT_EQ(model.bodies[1].shapes[0].scale, 0.1);
  EXPECT_EQ(
      read(with("package://pack/meshes/tetra.obj", " scale='1 1 -1'")).bodies[1].shapes[0].type,
      "hull");
  EXPECT_THAT(notes(with("pack/meshes/open.obj")),
              HasSubstr("is replaced by its convex hull, as its surface is not closed"));
  EXPECT_THAT(notes(with("pack/meshes/picture.ply")),
              HasSubstr("there is no reader of .ply files"));
  EXPECT_THAT(robot_fault(with("package://other/a.stl")),
              HasSubstr("there is no mesh 'package://other/a.stl'"));
  EXPECT_THAT(notes(with("package://other/a.stl"), {"import.allow_partial=true"}),
              HasSubstr("left out: there is no mesh"));
}

TEST_F(Urdf, ImportIsSaidOncePerModel) {
  EXPECT_THAT(robot_fault(link("a"), {"import.base=flying"}), HasSubstr("import.base"));
  const std::string robot = write("r.urdf", "<robot>" + link("a") + "</robot>");
  try {
    static_cast<void>(io::read_model(
        write("m.yaml", "format: 1\nunits: {length: mm}\nimport: {file: r.urdf}\n")));
    FAIL();
  } catch (const io::ModelErrors& errors) {
    EXPECT_THAT(errors.text(), HasSubstr("cannot be combined with an import, which is in SI"));
  }
  EXPECT_EQ(io::read_model(write("m.yaml", "format: 1\nimport: {file: r.urdf, base: floating}\n"))
                .bodies.size(),
            1U);
}

}  // namespace
}  // namespace polhode::urdf_tests
