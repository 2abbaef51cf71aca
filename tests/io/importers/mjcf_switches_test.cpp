// SPDX-License-Identifier: Apache-2.0
// Forces and constraints that <option> of an MJCF switches off, and values of actuators by their
// defaults.
#include <cmath>

#include "mjcf_fixture.hpp"

namespace polhode::mjcf_tests {
namespace {

/// An arm with everything that a flag switches off, and a cart that follows a leader.
std::string arm(const std::string& option) {
  return "<option gravity='0 0 -10'>" + option +
         "</option><worldbody><body name='a'><joint name='p' axis='0 1 0' stiffness='3' "
         "damping='2' frictionloss='0.4' range='-90 90'/>" +
         kBall + "</body><body name='b' pos='0 1 0'><joint name='q' axis='0 1 0'/>" + kBall +
         "</body></worldbody><equality><joint name='e' joint1='q' joint2='p'/></equality>"
         "<actuator><motor name='m' joint='p' ctrlrange='-1 1' group='2'/></actuator>"
         "<keyframe><key ctrl='5'/></keyframe>";
}

bool has_limits(const Model& model) {
  return model.joints.at(static_cast<std::size_t>(model.joint_index("p"))).limits.has_value();
}

TEST_F(Mjcf, FlagsSwitchPartsOfThePhysicsOff) {
  const auto off = [](const std::string& flag) { return arm("<flag " + flag + "='disable'/>"); };
  const auto count = [](const Model& model) { return model.loads.size(); };
  const Model all = read(arm(""));
  EXPECT_TRUE(has_limits(all));
  EXPECT_EQ((*load_of(all, "m")->value)(0.0), 1.0);
  EXPECT_NE(load_of(all, "q_mimic"), nullptr);
  EXPECT_FALSE(has_limits(read(off("limit"))));
  EXPECT_EQ((*load_of(read(off("clampctrl")), "m")->value)(0.0), 5.0);
  EXPECT_EQ(load_of(read(off("equality")), "q_mimic"), nullptr);
  EXPECT_EQ(load_of(read(off("actuation")), "m"), nullptr);
  const Model constraint = read(off("constraint"));
  EXPECT_FALSE(has_limits(constraint));
  EXPECT_EQ(load_of(constraint, "q_mimic"), nullptr);
  // Spring and damper are one load of two parameters.
  const Model both = read(arm("<flag spring='disable' damper='disable'/>"));
  EXPECT_EQ(count(both) + 1, count(all));
  EXPECT_EQ(load_of(read(arm("<flag actuation='enable'/>")), "m")->name, "m");
  EXPECT_THAT(fault(arm("<flag limit='off'/>")), HasSubstr("'limit' of <flag> is 'off'"));
}

TEST_F(Mjcf, GroupsOfActuatorsAreSwitchedOff) {
  const auto with = [&](const std::string& groups) {
    std::string text = arm("");
    return text.replace(text.find("gravity"), 0, "actuatorgroupdisable='" + groups + "' ");
  };
  EXPECT_NE(load_of(read(with("0 1")), "m"), nullptr);
  EXPECT_EQ(load_of(read(with("0 2")), "m"), nullptr);
  EXPECT_THAT(notes(with("2")), HasSubstr("an actuator that <option> switches off exerts no"));
}

TEST_F(Mjcf, OptionsOfTheSolverAreNamedAndOthersListed) {
  const std::string report = notes(
      "<option timestep='0.001' graviti='0 0 0'><flag warmstart='disable' sping='disable'/>"
      "</option><worldbody><body name='a'><joint name='j'/>" +
      kBall + "</body></worldbody>");
  EXPECT_THAT(report, HasSubstr("<option> timestep, flag warmstart belongs to another solver"));
  EXPECT_THAT(report, HasSubstr("attribute 'graviti' of <option> is unknown"));
  EXPECT_THAT(report, HasSubstr("attribute 'sping' of <flag> is unknown"));
  EXPECT_EQ(notes(arm("")).find("another solver"), std::string::npos);
}

TEST_F(Mjcf, UnknownAttributesAreListedEverywhere) {
  const std::string report = notes(
      "<default><joint dampng='1'/><foo/></default><asset><mesh name='x' file='x.stl' scal='1'/>"
      "</asset><worldbody><body name='a'><joint name='j'/><site name='s' bogus='1'/>" +
      kBall +
      "</body></worldbody><tendon><fixed name='t' stifness='1'><joint joint='j' coef='1' c='1'/>"
      "</fixed></tendon><actuator><motor joint='j' geer='3'/></actuator><sensor><gyro site='s' "
      "nam='g'/></sensor><contact><exclude body1='world' body2='a' b='1'/></contact>");
  for (const char* unknown :
       {"'dampng' of <joint>", "'scal' of <mesh>", "'bogus' of <site>", "'stifness' of <fixed>",
        "'c' of <joint>", "'geer' of <motor>", "'nam' of <gyro>", "'b' of <exclude>"})
    EXPECT_THAT(report, HasSubstr(std::string("attribute ") + unknown + " is unknown"));
  EXPECT_THAT(report, HasSubstr("<foo> in <default> is unknown"));
}

/// The servo of an actuator by its own tag and the tags of its class.
struct Servo {
  double gain = 0.0, stiffness = 0.0, damping = 0.0;
};

class MjcfDefaults : public Mjcf {
 protected:
  /// Gain, stiffness and damping of an actuator at the control 1.
  Servo servo(const std::string& own, const std::string& defaults) {
    const Model model = read(
        "<default>" + defaults + "</default><worldbody><body name='a'><joint name='j'/>" + kBall +
        "</body></worldbody><actuator>" + own + "</actuator><keyframe><key ctrl='1'/></keyframe>");
    const LoadSpec& load = *load_of(model, "m");
    Servo result;
    const auto number = [&](const char* key) {
      const auto found = load.parameters.find(key);
      return found == load.parameters.end() ? 0.0 : found->second;
    };
    result.stiffness = number("stiffness");
    result.damping = number("damping");
    result.gain = (*load.value)(0.0) * (result.stiffness > 0.0 ? result.stiffness
                                        : result.damping > 0.0 ? result.damping
                                                               : 1.0);
    return result;
  }
};

// MuJoCo 4.0: actuator_gainprm, actuator_biasprm and actuator_gear of the compiled models.
TEST_F(MjcfDefaults, AClassHasOneSetForAllActuators) {
  const std::string general = "<general gainprm='7' biastype='affine' biasprm='0 -7 -3'/>";
  const auto expect = [&](const std::string& own, const std::string& defaults, double gain,
                          double stiffness, double damping) {
    const Servo s = servo(own, defaults);
    EXPECT_NEAR(s.gain, gain, 1e-13) << own << defaults;
    EXPECT_NEAR(s.stiffness, stiffness, 1e-13) << own << defaults;
    EXPECT_NEAR(s.damping, damping, 1e-13) << own << defaults;
  };
  expect("<motor name='m' joint='j'/>", general, 1.0, 0.0, 0.0);
  expect("<position name='m' joint='j'/>", general, 7.0, 7.0, 3.0);
  expect("<velocity name='m' joint='j'/>", general, 7.0, 0.0, 7.0);
  expect("<velocity name='m' joint='j'/>", "<position kp='6' kv='3'/>", 1.0, 0.0, 1.0);
  expect("<general name='m' joint='j'/>", "<position kp='6' kv='3'/>", 6.0, 6.0, 3.0);
  expect("<general name='m' joint='j'/>", "<position kp='6' kv='3'/><motor/>", 1.0, 0.0, 0.0);
  expect("<position name='m' joint='j'/>", "<position kp='6' kv='3'/><velocity/>", 1.0, 1.0, 0.0);
  expect("<position name='m' joint='j'/>", "<position kp='5' kv='2'/><general/>", 5.0, 5.0, 2.0);
  expect("<general name='m' joint='j' biasprm='1'/>", general, 8.0, 7.0, 3.0);
  expect("<position name='m' joint='j' kp='20' kv='1'/>", "<position dampratio='1'/>", 20.0, 20.0,
         1.0);
  expect("<motor name='m' joint='j'/>", "<general gear='2'/><motor gear='1.5'/>", 1.5, 0.0, 0.0);
  expect("<motor name='m' joint='j' class='c'/>",
         "<motor gear='2'/><default class='c'><general gear='3'/></default>", 3.0, 0.0, 0.0);
}

// A damper has kv 0 unless it is given, and a class with a negative one is an error.
TEST_F(MjcfDefaults, FaultsOfServosAreNamed) {
  const auto message = [&](const std::string& own) {
    return fault("<worldbody><body name='a'><joint name='j'/>" + kBall +
                 "</body></worldbody><actuator>" + own + "</actuator>");
  };
  EXPECT_THAT(message("<position joint='j' kv='-1'/>"), HasSubstr("'kv' of <position> is -1"));
  EXPECT_THAT(message("<position joint='j' kv='1' dampratio='1'/>"),
              HasSubstr("<position> has both 'kv' and 'dampratio'"));
  EXPECT_THAT(message("<motor joint='j' ctrllimited='yes'/>"),
              HasSubstr("'ctrllimited' of <motor> is 'yes'"));
  EXPECT_THAT(message("<motor joint='j' delay='0.1' nsample='2'/>"), HasSubstr("has a delay"));
  EXPECT_THAT(message("<position joint='j' inheritrange='1'/>"), HasSubstr("inherits its range"));
}

// gear² times armature and damping act on the joint; MuJoCo 4.0: M = 2 and 2 + 9 * 0.5, and a
// passive moment of -4.5 at 1 rad/s.
TEST_F(Mjcf, ArmatureAndDampingOfActuatorsActOnTheirJoints) {
  const auto slide = [](const std::string& actuator) {
    return "<option gravity='0 0 0'/><worldbody><body name='a'><joint name='j' type='slide' "
           "axis='1 0 0'/><inertial pos='0 0 0' mass='2' diaginertia='1 1 1'/></body></worldbody>"
           "<actuator><motor name='m' joint='j' gear='3' " +
           actuator + "/></actuator><keyframe><key qvel='1'/></keyframe>";
  };
  for (const double step : {0.02, 0.002, 0.0002}) {
    Model damped = read(slide("damping='0.5' armature='0.5'"));
    damped.analysis.step = step;
    Simulation simulation(damped);
    while (simulation.time() < 0.6 - 0.5 * step) simulation.step(0.6);
    EXPECT_NEAR(simulation.joint("j").rates[0], std::exp(-4.5 / 6.5 * 0.6), step * step) << step;
  }
  EXPECT_THAT(fault(slide("damping='0.5 1'")), HasSubstr("'damping' of <motor> is a polynomial"));
  const Model off = read(slide("damping='0.5'") + "<option><flag damper='disable'/></option>");
  EXPECT_EQ(off.loads.size(), 1U);
}

// MuJoCo 4.0: eq_data of polycoef="0.5" is (0.5, 1, 0, 0, 0), and geom_size of the capsule (0.1,
// 0.2).
TEST_F(Mjcf, PartsOfArraysKeepTheOtherNumbers) {
  const Model model = read(
      "<default><geom size='0.05 0.2'/></default><worldbody><body name='a'><joint name='p' "
      "axis='1 0 0'/><geom type='capsule' size='0.1'/></body><body name='b' pos='0 1 0'><joint "
      "name='q' axis='1 0 0'/>" +
      kBall +
      "</body></worldbody><equality><joint joint1='q' joint2='p' polycoef='0.5'/></equality>");
  const double r = 0.1, l = 0.4;
  EXPECT_NEAR(model.bodies.at(1).mass, 1000.0 * kPi * (r * r * l + 4.0 / 3.0 * r * r * r), 1e-10);
  const LoadSpec& follows = *load_of(model, "q_mimic");
  EXPECT_EQ(follows.parameters.at("offset"), 0.5);
  EXPECT_THAT(fault("<compiler angle='radians'/><worldbody/>"),
              HasSubstr("'angle' of <compiler> is 'radians'"));
}

TEST_F(Mjcf, ShapesThatTouchNothingAreCounted) {
  const std::string text =
      "<worldbody><geom type='plane' size='1 1 1'/><body name='a' pos='0 0 1'><freejoint/><geom "
      "size='0.1'/></body></worldbody>";
  EXPECT_THAT(notes(text), HasSubstr("2 shapes of 2 bodies touch nothing"));
  EXPECT_EQ(notes("<option><flag contact='disable'/></option>" + text).find("touch nothing"),
            std::string::npos);
}

TEST_F(Mjcf, AWeldThatTheKeyframeBreaksIsRefused) {
  const auto weld = [](const char* qpos) {
    return "<worldbody><body name='a'><joint name='j'/>" + kBall +
           "</body><body name='c' pos='0.3 0.1 1'><freejoint/>" + kBall +
           "</body></worldbody><equality><weld name='w' body1='a' body2='c'/></equality>"
           "<keyframe><key qpos='" +
           qpos + "'/></keyframe>";
  };
  EXPECT_THAT(fault(weld("0 0.3 0.1 1 1 1 0 0")),
              HasSubstr("the constraint 'w' holds another rotation than that of the start"));
  EXPECT_THAT(fault(weld("0 0.3 0.1 1 1 0 0 0")), HasSubstr("none"));
}

TEST_F(Mjcf, FramesOfSensorsAreSaid) {
  const std::string report = notes(
      "<worldbody><body name='a'><freejoint/><site name='s' euler='90 0 0'/>" + kBall +
      "</body><body name='b' pos='1 0 0'><freejoint/><site name='t' pos='0 0.1 0.2'/>" + kBall +
      "</body></worldbody><sensor><framequat name='f' objtype='site' objname='s'/><framepos "
      "name='g' objtype='site' objname='s' reftype='site' refname='t'/><framelinacc name='h' "
      "objtype='xbody' objname='a'/></sensor>");
  EXPECT_THAT(report, HasSubstr("the rotation of the sensor 'f' is that of the body 'a'"));
  EXPECT_THAT(report, HasSubstr("in the body, the quaternion 0.707107 0.707107 0 0"));
  EXPECT_THAT(report, HasSubstr("the sensor 'g' is seen from the body 'b', and in MuJoCo from a "
                                "frame in it at 0 0.1 0.2"));
  EXPECT_THAT(report, HasSubstr("'h' is that of the point, from which MuJoCo subtracts gravity"));
}

}  // namespace
}  // namespace polhode::mjcf_tests
