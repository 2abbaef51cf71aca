// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>

#include <io/importers/sdf_fixture.hpp>
#include <polhode/model/whole_mass.hpp>

namespace polhode::sdf_tests {
namespace {

using testing::HasSubstr;

/// A coarse step, the usual one and a hundredth of that [s].
constexpr double kSteps[] = {1e-2, 1e-3, 1e-5};

std::string bar(const std::string& name, const std::string& at, const std::string& com) {
  return link(name, pose(at),
              "<inertial><pose>" + com +
                  " 0 0 0</pose><mass>2</mass><inertia><ixx>0.1</ixx><iyy>0.2</iyy><izz>0.3</izz>"
                  "</inertia></inertial>");
}

class SdfJoints : public SdfFixture {};

TEST_F(SdfJoints, EveryTypeHasItsFreedoms) {
  const auto count = [&](const std::string& type, const std::string& inside) {
    return freedoms(read(link("b") + joint("j", type, "world", "b", inside)));
  };
  EXPECT_EQ(count("fixed", ""), 0);
  EXPECT_EQ(count("revolute", axis("0 1 0")), 1);
  EXPECT_EQ(count("continuous", axis("0 1 0")), 1);
  EXPECT_EQ(count("prismatic", axis("0 1 0")), 1);
  EXPECT_EQ(count("screw", axis("0 1 0") + "<screw_thread_pitch>0.1</screw_thread_pitch>"), 1);
  EXPECT_EQ(count("ball", ""), 3);
  EXPECT_EQ(count("universal", axis("1 0 0") + axis("0 1 0", "", "axis2")), 2);
  EXPECT_EQ(count("revolute2", axis("1 0 0") + axis("1 1 0", "", "axis2")), 2);
}

// Rates follow from the energy, (J + m l^2) w^2 / 2 = m g (z_0 - z), at second order.
TEST_F(SdfJoints, PendulumFallsAsItsEnergySays) {
  const Model m = read(bar("bob", "0 0 0 0 0.5 0", "0.5 0 0") +
                       joint("hinge", "revolute", "world", "bob", axis("0 1 0")));
  const double z_0 = -0.5 * std::sin(0.5);
  for (const double step : kSteps) {
    const Simulation s = run(m, step, 0.1);
    const BodyMotion bob = s.body("bob");
    const double J = 0.2 + 2.0 * 0.25;
    // Rates and heights are of size 1; 1e-9 is what the iterations leave.
    EXPECT_NEAR(0.5 * J * bob.omega().squaredNorm(), 2.0 * 9.81 * (z_0 - bob.r.z()),
                10 * step * step + 1e-9);
  }
}

// A parallelogram: cranks of length r at the angle q, and a coupler that does not turn. Its kinetic
// energy is (2 J + m r^2) q'^2 / 2, with J of a crank about its pivot.
TEST_F(SdfJoints, AParallelogramIsALoopAsTheModelFileHasIt) {
  const std::string crank =
      "<inertial><pose>0.1 0 0 0 0 0</pose><mass>1</mass><inertia><ixx>0.001</ixx><iyy>0.004</iyy>"
      "<izz>0.004</izz></inertia></inertial>";
  const double x = std::cos(0.5), z = std::sin(0.5);
  const Model m = read(
      link("left", pose("0 0 0 0 -0.5 0"), crank) + link("right", pose("0.5 0 0 0 -0.5 0"), crank) +
      link("coupler", pose(format("{} 0 {} 0 0 0", 0.2 * x, 0.2 * z))) +
      joint("a", "revolute", "world", "left", axis("0 1 0")) +
      joint("b", "revolute", "left", "coupler", axis("0 1 0")) +
      joint("c", "revolute", "coupler", "right", pose("0.2 0 0 0 0 0") + axis("0 1 0")) +
      joint("d", "revolute", "right", "world", pose("0.5 0 0 0 0 0") + axis("0 1 0")));
  EXPECT_EQ(loop_count(m), 1);
  const auto at = [&](double along, double beside) {
    return format("[{}, 0, {}]", beside + along * x, along * z);
  };
  const std::string inertia = format(
      "{{mass: 1, inertia: {{xx: 0.001, yy: 0.004, zz: 0.004}}, orientation: {{quaternion: [{}, 0, "
      "{}, 0]}}, position: ",
      std::cos(0.25), -std::sin(0.25));
  const Model same = io::read_model(write(
      "same.yaml",
      "format: 1\ngravity: [0, 0, -9.81]\nbodies:\n  left: " + inertia + at(0.1, 0) +
          "}\n  right: " + inertia + at(0.1, 0.5) + "}\n  coupler: {mass: 2, inertia: {xx: 0.3, " +
          "yy: 0.3, zz: 0.2}, position: " + at(0.2, 0) + "}\njoints:\n" +
          "  a: {type: revolute, bodies: [ground, left], at: [0, 0, 0], axis: y}\n" +
          "  b: {type: revolute, bodies: [left, coupler], at: " + at(0.2, 0) + ", axis: y}\n" +
          "  c: {type: revolute, bodies: [coupler, right], at: " + at(0.2, 0.5) + ", axis: y}\n" +
          "  d: {type: revolute, bodies: [ground, right], at: [0.5, 0, 0], axis: y}\n"));
  for (const double step : kSteps) {
    const Simulation s = run(m, step, 0.1), t = run(same, step, 0.1);
    for (const char* name : {"left", "right", "coupler"})
      EXPECT_NEAR((s.body(name).r - t.body(name).r).norm(), 0.0, 1e-10) << name;
    const double rate = s.body("left").omega().norm(), fall = 0.1 * z - s.body("left").r.z();
    const double J = 2 * (0.004 + 0.01) + 2 * 0.04;
    EXPECT_GT(fall, 0.01);
    EXPECT_NEAR(0.5 * J * rate * rate, 9.81 * fall * (1 + 1 + 2 * 2), 50 * step * step + 1e-9);
    EXPECT_LT(s.body("coupler").omega().norm(), 1e-9);
  }
}

// A nut on a vertical screw: (m + J (2 pi / p)^2) a = m g; 0.1 m per turn are -62.8 rad per m of a
// left-handed thread.
TEST_F(SdfJoints, AScrewFallsWithTheInertiaOfItsTurning) {
  for (const char* pitch : {"<screw_thread_pitch>0.1</screw_thread_pitch>",
                            "<thread_pitch>-62.83185307179586</thread_pitch>"}) {
    const Model m = read(link("nut") + joint("j", "screw", "world", "nut", axis("0 0 1") + pitch));
    const double ratio = 2 * std::numbers::pi / 0.1;
    const double a = 2.0 * 9.81 / (2.0 + 0.2 * ratio * ratio);
    for (const double step : kSteps) {
      const Simulation s = run(m, step, 0.1);
      EXPECT_NEAR(s.body("nut").r.z(), -0.5 * a * 0.01, 1e-9);
      // Right-handed: it turns about -z while it falls.
      EXPECT_NEAR(s.body("nut").omega().z(), -ratio * a * 0.1, 1e-6);
    }
  }
}

// Without gravity a nut that turns at 5 rad/s is slowed by 0.3 N m and by the friction of its
// thread, (J + m (p / 2 pi)^2) w' = -M, and stops after w / |w'|.
TEST_F(SdfJoints, FrictionOfAScrewIsAMomentAlongTheThread) {
  Model m =
      read(link("nut") + joint("j", "screw", "world", "nut",
                               axis("0 0 1", "<dynamics><friction>0.3</friction></dynamics>") +
                                   "<screw_thread_pitch>0.5</screw_thread_pitch>"));
  m.gravity.setZero();
  const double lead = 0.5 / (2 * std::numbers::pi), J = 0.2 + 2.0 * lead * lead;
  m.bodies.at(1).angular_velocity = Vec3(0, 0, 5);
  m.bodies.at(1).velocity = Vec3(0, 0, 5 * lead);
  for (const double step : kSteps) {
    const Simulation s = run(m, step, 1.0);
    EXPECT_NEAR(s.body("nut").omega().z(), 5.0 - 0.3 / J, 1e-3 + 10.0 * step) << step;
    EXPECT_NEAR(s.body("nut").v.z(), lead * s.body("nut").omega().z(), 1e-9) << step;
  }
}

// From rest, q = q_0 (1 - cos(w t)), w = sqrt(k / J); also where the joint counts from the child to
// the world.
TEST_F(SdfJoints, SpringsPullToTheirReference) {
  const std::string spring =
      "<dynamics><spring_stiffness>20</spring_stiffness><spring_reference>0.3</spring_reference>"
      "</dynamics>";
  const double w = std::sqrt(20.0 / 0.2);
  for (const bool turned : {false, true}) {
    const Model m = read(link("wheel") + joint("j", "revolute", turned ? "wheel" : "world",
                                               turned ? "world" : "wheel", axis("0 0 1", spring)));
    for (const double step : kSteps) {
      const Simulation s = run(m, step, 0.1);
      const double q = 0.3 * (1 - std::cos(w * 0.1)) * (turned ? -1 : 1);
      EXPECT_NEAR(s.body("wheel").Lambda()(1, 0), std::sin(q), 10 * step * step + 1e-9);
    }
  }
}

TEST_F(SdfJoints, AnUniversalJointMovesAsTwoHinges) {
  const std::string inside = bar("bob", "0 0 0 0.3 0.2 0", "0.1 0.2 -0.5");
  const auto with = [&](const std::string& more) {
    return read(inside + joint("j", "universal", "world", "bob",
                               axis("1 0 0", more) + axis("0 1 0", "", "axis2")));
  };
  // A damper far below rounding makes two hinges of it.
  const Model one = with(""), two = with("<dynamics><damping>1e-20</damping></dynamics>");
  EXPECT_EQ(one.joints.size(), 1U);
  EXPECT_EQ(two.joints.size(), 2U);
  for (const double step : {1e-2, 1e-3, 1e-4}) {
    const Simulation s = run(one, step, 0.2), t = run(two, step, 0.2);
    // The link between takes 1e-10 of the mass.
    EXPECT_NEAR((s.body("bob").r - t.body("bob").r).norm(), 0.0, 1e-8);
  }
  EXPECT_EQ(freedoms(two), 2);
}

TEST_F(SdfJoints, OneThatFollowsAnotherIsCoupled) {
  const Model m = read(bar("a", "0 0 0 0 0 0", "0.5 0 0") + bar("b", "0 1 0 0 0 0", "0.1 0 0") +
                       joint("j", "revolute", "world", "a", axis("0 1 0")) +
                       joint("k", "revolute", "world", "b",
                             axis("0 1 0",
                                  "<mimic joint='j'><multiplier>-0.5</multiplier><reference>0.2"
                                  "</reference><offset>-0.1</offset></mimic>")));
  for (const double step : kSteps) {
    const Simulation s = run(m, step, 0.1);
    const auto angle = [&](const char* name) {
      const Mat3 R = s.body(name).Lambda();
      return std::atan2(R(0, 2), R(0, 0));
    };
    EXPECT_GT(angle("a"), 0.01);
    EXPECT_NEAR(angle("b"), -0.5 * (angle("a") - 0.2) - 0.1, 1e-9);
  }
}

// The planet turns -3 times as far as the bob, both relative to the frame that swings.
TEST_F(SdfJoints, AGearboxIsARowBetweenTwoHinges) {
  const std::string inside = bar("frame", "0 0 0 0 0.4 0", "0.5 0 0") +
                             bar("bob", "1 0 0 0 0 0", "0.5 0 0") +
                             link("planet", pose("0 0.5 0 0 0 0")) +
                             joint("s", "revolute", "world", "frame", axis("0 1 0")) +
                             joint("j", "revolute", "frame", "bob",
                                   "<axis><xyz expressed_in='__model__'>0 1 0</xyz></axis>") +
                             joint("k", "revolute", "planet", "frame",
                                   "<axis><xyz expressed_in='__model__'>0 1 0</xyz></axis>");
  const auto gearbox = [](const std::string& body) {
    return joint("g", "gearbox", "bob", "planet",
                 "<gearbox_ratio>3</gearbox_ratio><gearbox_reference_body>" + body +
                     "</gearbox_reference_body>" + axis("0 1 0") + axis("0 1 0", "", "axis2"));
  };
  const Model m = read(inside + gearbox("frame"));
  for (const double step : kSteps) {
    const Simulation s = run(m, step, 0.1);
    const double frame = s.body("frame").omega().y();
    const double bob = s.body("bob").omega().y() - frame;
    EXPECT_GT(std::abs(bob), 0.01);
    EXPECT_NEAR(s.body("planet").omega().y() - frame, -3 * bob, 1e-8);
  }
  EXPECT_THAT(fault(inside + gearbox("world")),
              HasSubstr("the gearbox 'g' is not between two hinges of 'world'"));
}

TEST_F(SdfJoints, LinksWithoutGravityStayWhereTheyAre) {
  const Model m = read(bar("a", "0 0 1 0 0 0", "0.5 0 0") +
                       link("b", pose("0 0 2 0 0 0") + "<gravity>false</gravity>"));
  for (const double step : kSteps) {
    const Simulation s = run(m, step, 0.1);
    EXPECT_NEAR(s.body("b").r.z(), 2.0, kRounding);
    EXPECT_NEAR(s.body("a").r.z(), 1.0 - 0.5 * 9.81 * 0.01, 1e-9);
  }
}

// A universal joint between the world and the last of three bars, whose axes are perpendicular:
// with a damping, however small, it is two hinges and a link between them, and moves the same.
TEST_F(SdfJoints, PairsOfHingesCloseLoops) {
  const auto bar = [](const std::string& name, const std::string& at) {
    return link(name, pose(at + " 0 0 0"),
                "<inertial><pose>0.25 0 0 0 0 0</pose><mass>2</mass><inertia><ixx>0.1</ixx>"
                "<iyy>0.2</iyy><izz>0.2</izz></inertia></inertial>");
  };
  const auto chain = [&](const std::string& dynamics) {
    return read(bar("a", "0 0 1") + bar("b", "0.4 0 0.7") + bar("c", "0.9 0.1 0.7") +
                joint("p", "ball", "world", "a") + joint("q", "ball", "a", "b") +
                joint("r", "ball", "b", "c") +
                joint("u", "universal", "world", "c",
                      pose("0.4 0 0.3 0 0 0") + axis("0 1 0") + axis("0 0 1", dynamics, "axis2")));
  };
  const Model whole = chain(""), pair = chain("<dynamics><damping>1e-14</damping></dynamics>");
  EXPECT_EQ(pair.bodies.size(), whole.bodies.size() + 1);
  for (const double step : {0.02, 0.005}) {
    const auto place = [&](const Model& m) { return run(m, step, 0.5).body(m.body_index("b")).r; };
    EXPECT_LT((place(whole) - place(pair)).norm(), 1e-7) << step;
    EXPECT_GT((place(whole) - body(whole, "b").position).norm(), 0.05) << step;
  }
}

// Limits, damping and friction of a joint that closes a loop are those of the model's joint.
TEST_F(SdfJoints, AJointThatClosesALoopKeepsWhatItHas) {
  const std::string inside = link("a") + link("b", pose("1 0 0 0 0 0")) +
                             link("c", pose("1 0 1 0 0 0")) +
                             joint("j", "revolute", "world", "a", axis("0 1 0")) +
                             joint("k", "revolute", "world", "b", axis("0 1 0")) +
                             joint("l", "revolute", "a", "c", pose("-1 0 0 0 0 0") + axis("0 1 0"));
  const std::string closing =
      joint("m", "revolute", "b", "c",
            axis("0 1 0",
                 "<limit><lower>-1</lower><upper>inf</upper></limit>"
                 "<dynamics><damping>0.5</damping><friction>0.1</friction></dynamics>"));
  const Model m = read(inside + closing);
  EXPECT_EQ(loop_count(m), 1);
  ASSERT_EQ(m.joints.size(), 4U);
  EXPECT_EQ(m.joints[3].name, "m");
  EXPECT_EQ(m.joints[3].limits->lower, -1.0);
  EXPECT_TRUE(m.joints[3].friction.has_value());
  EXPECT_EQ(m.loads.size(), 1U);
  EXPECT_THAT(fault(inside + closing, {"import.start.m=0.1"}),
              HasSubstr("closes a loop, so that its start follows from other joints"));
}

// A start at the limit would open the loop; a joint beside the loop starts there.
TEST_F(SdfJoints, LimitsThatExcludeThePoseOfALoopAreNoStops) {
  const std::string limit = "<limit><lower>0.2</lower><upper>1</upper></limit>";
  const std::string inside =
      link("a") + link("b", pose("1 0 0 0 0 0")) + link("c", pose("1 0 1 0 0 0")) +
      link("d", pose("0 0 2 0 0 0")) + joint("j", "revolute", "world", "a", axis("0 1 0", limit)) +
      joint("k", "revolute", "world", "b", axis("0 1 0")) +
      joint("l", "revolute", "a", "c", pose("-1 0 0 0 0 0") + axis("0 1 0")) +
      joint("m", "revolute", "b", "c", axis("0 1 0")) +
      joint("n", "prismatic", "c", "d", axis("0 0 1", limit));
  const Model m = read(inside);
  EXPECT_LT(Simulation(m).start_report().largest_move, kRounding);
  EXPECT_NEAR(body(m, "d").position.z(), 2.2, kRounding);
  const std::string said = notes(inside);
  EXPECT_THAT(said,
              HasSubstr("the joint 'j' has no stops, as its loop is closed where it is at 0"));
  EXPECT_THAT(said, HasSubstr("the joint 'n' starts at its limit 0.2, as 0 is outside"));
}

TEST_F(SdfJoints, AxesOfOldVersionsAreThoseOfTheModel) {
  const std::string inside = model("m", link("b", pose("0 0 0 1.5707963267948966 0 0")) +
                                            joint("j", "revolute", "world", "b", axis("0 0 1")));
  // In 1.4 the axis is z of the model, about which gravity does not turn the link.
  for (const char* version : {"1.4", "1.5"}) {
    const Model m = read_text(sdf(inside, version));
    const Vec3 z = m.joints[0].R_a.col(2);
    EXPECT_NEAR((z - (version == std::string("1.4") ? Vec3(0, 0, 1) : Vec3(0, -1, 0))).norm(), 0.0,
                kRounding);
  }
}

TEST_F(SdfJoints, EqualLimitsFixAJoint) {
  const std::string inside =
      link("b") + joint("j", "prismatic", "world", "b",
                        axis("1 0 0", "<limit><lower>0.3</lower><upper>0.3</upper></limit>"));
  EXPECT_NEAR(body(read(inside), "b").position.x(), 0.3, kRounding);
  EXPECT_THAT(notes(inside), HasSubstr("the joint 'j' is fixed, as both its limits are 0.3"));
}

// The same mechanism as URDF and as SDFormat moves the same way.
TEST_F(SdfJoints, AUrdfAndAnSdfOfOneRobotAgree) {
  const std::string urdf =
      "<robot name='r'><link name='base'/>"
      "<link name='arm'><inertial><origin xyz='0.3 0.1 0' rpy='0.1 0.2 0.3'/><mass value='2'/>"
      "<inertia ixx='0.1' iyy='0.2' izz='0.25' ixy='0.01'/></inertial></link>"
      "<link name='slide'><inertial><mass value='1'/><inertia ixx='0.1' iyy='0.2' izz='0.25'/>"
      "</inertial></link>"
      "<joint name='j' type='continuous'><parent link='base'/><child link='arm'/>"
      "<origin xyz='0 0 1' rpy='0.3 0 0.2'/><axis xyz='0 1 1'/><dynamics damping='0.1'/></joint>"
      "<joint name='k' type='prismatic'><parent link='arm'/><child link='slide'/>"
      "<origin xyz='0.5 0 0' rpy='0 0.4 0'/><axis xyz='1 0 0'/></joint></robot>";
  const Model a = io::read_model(write("robot.urdf", urdf));
  const Model b = read(
      link("arm", pose("0 0 1 0.3 0 0.2"),
           "<inertial><pose>0.3 0.1 0 0.1 0.2 0.3</pose><mass>2</mass><inertia><ixx>0.1</ixx><iyy>"
           "0.2</iyy><izz>0.25</izz><ixy>0.01</ixy></inertia></inertial>") +
      link("slide", pose("0.5 0 0 0 0.4 0", "arm"),
           "<inertial><mass>1</mass><inertia><ixx>0.1</ixx><iyy>0.2</iyy><izz>0.25</izz></inertia>"
           "</inertial>") +
      joint("j", "continuous", "world", "arm",
            axis("0 1 1", "<dynamics><damping>0.1</damping></dynamics>")) +
      joint("k", "prismatic", "arm", "slide", axis("1 0 0")));
  for (const double step : kSteps) {
    const Simulation s = run(a, step, 0.1), t = run(b, step, 0.1);
    for (const char* name : {"arm", "slide"})
      EXPECT_NEAR((s.body(name).r - t.body(name).r).norm(), 0.0, 1e-12);
  }
}

}  // namespace
}  // namespace polhode::sdf_tests
