// SPDX-License-Identifier: Apache-2.0
// Keyframes of an MJCF as the start, and springs, dampers and servos that MuJoCo's compiler chooses
// by the inertia of the model's configuration.
#include <cmath>

#include "mjcf_fixture.hpp"

namespace polhode::mjcf_tests {
namespace {

/// A body that moves freely, and an arm on a hinge with a ball joint at its end.
const std::string kTree =
    "<body name='f' pos='1 0 0'><freejoint/>"
    "<inertial pos='0.1 0 0' mass='2' diaginertia='0.3 0.2 0.1'/></body>"
    "<body name='arm' pos='0 2 0'><joint name='h' axis='0 1 0'/>" +
    kBall + "<body name='tip' pos='1 0 0'><joint name='b' type='ball'/>" + kBall + "</body></body>";
const std::string kHalf = format("{}", std::sqrt(0.5));
const std::string kKeys = "<keyframe><key name='home' qpos='0 0 3 " + kHalf + " 0 0 " + kHalf +
                          " 0.5 " + kHalf + " " + kHalf +
                          " 0 0' qvel='1 2 3 0 0 4 0.7 0 0.2 0.3'/>"
                          "<key qpos='0 0 5 1 0 0 0 -0.25 1 0 0 0'/></keyframe>";

// Velocities of a free body are those of its origin in world axes and of its rotation in its own; a
// ball turns in the axes of its body.
TEST_F(Mjcf, KeyframesAreTheStart) {
  const Model model = read("<worldbody>" + kTree + "</worldbody>" + kKeys);
  const BodySpec &f = model.bodies.at(1), &arm = model.bodies.at(2), &tip = model.bodies.at(3);
  const double c = std::cos(0.5), s = std::sin(0.5);
  EXPECT_NEAR((f.position - Vec3(0, 0.1, 3)).norm(), 0.0, kRounding);
  EXPECT_NEAR((f.velocity - Vec3(1 - 0.4, 2, 3)).norm(), 0.0, kRounding);
  EXPECT_NEAR((f.angular_velocity - Vec3(0, 0, 4)).norm(), 0.0, kRounding);
  EXPECT_NEAR(arm.velocity.norm(), 0.0, kRounding);
  EXPECT_NEAR((arm.angular_velocity - Vec3(0, 0.7, 0)).norm(), 0.0, kRounding);
  EXPECT_NEAR((tip.position - Vec3(c, 2, -s)).norm(), 0.0, kRounding);
  EXPECT_NEAR((tip.velocity - Vec3(-0.7 * s, 0, -0.7 * c)).norm(), 0.0, kRounding);
  // The axes of the tip: y of the file is z of the arm, and z is -y of the arm.
  const Vec3 turning = 0.2 * Vec3(s, 0, c) + 0.3 * Vec3(0, -1, 0);
  EXPECT_NEAR((tip.angular_velocity - Vec3(0, 0.7, 0) - turning).norm(), 0.0, kRounding);
  EXPECT_NEAR(Simulation(model).joint("h").coordinates[0], 0.5, kRounding);
  EXPECT_THAT(fault("<worldbody>" + kTree + "</worldbody><keyframe><key mpos='1'/></keyframe>"),
              HasSubstr("'mpos' of <key> has 1 numbers, but the model 0"));
  EXPECT_THAT(fault("<worldbody>" + kTree + "</worldbody><keyframe><key act='1'/></keyframe>"),
              HasSubstr("'act' of <key> has 1 numbers, but the model 0 activations"));
  EXPECT_THAT(notes("<worldbody>" + kTree + "</worldbody>" + kKeys),
              testing::AllOf(HasSubstr("the model starts at the keyframe 'home'"),
                             HasSubstr("a <key> other than that of the start is not read")));
}

TEST_F(Mjcf, KeyframesAreChosenByNameOrNumber) {
  const std::string text = "<worldbody>" + kTree + "</worldbody>" + kKeys;
  EXPECT_NEAR(read(text, {"import.keyframe='1'"}).bodies.at(1).position.z(), 5.0, kRounding);
  const Model reference = read(text, {"import.keyframe=none"});
  EXPECT_EQ(reference.bodies.at(1).position.x(), 1.1);
  EXPECT_EQ(reference.bodies.at(1).velocity, Vec3(0, 0, 0));
  // Coordinates of import.start replace those of the keyframe.
  EXPECT_NEAR(Simulation(read(text, {"import.start.h=0.1"})).joint("h").coordinates[0], 0.1,
              kRounding);
  EXPECT_THAT(fault(text, {"import.keyframe=hone"}),
              HasSubstr("there is no keyframe 'hone'. Did you mean 'home'? Keyframes: home, 1, "
                        "none."));
  EXPECT_THAT(fault("<worldbody>" + kTree + "</worldbody>", {"import.keyframe=home"}),
              HasSubstr("there is no keyframe 'home'. The file has none."));
  const auto key = [&](const std::string& attributes) {
    return fault("<worldbody>" + kTree + "</worldbody><keyframe><key " + attributes +
                 "/></keyframe>");
  };
  EXPECT_THAT(key("qpos='1 2'"),
              HasSubstr("'qpos' of <key> has 2 numbers, but the model 12 positions"));
  EXPECT_THAT(key("qvel='1'"), HasSubstr("has 1 numbers, but the model 10 velocities"));
  EXPECT_THAT(key("ctrl='1'"), HasSubstr("has 1 numbers, but the model 0 controls"));
  EXPECT_THAT(key("qpos='0 0 0 0 0 0 0 0 1 0 0 0'"),
              HasSubstr("the rotation of 'f_joint' in 'qpos' is a quaternion of length 0"));
  write("robot.urdf", "<robot name='r'><link name='l'/></robot>");
  try {
    static_cast<void>(io::read_model(folder_ / "robot.urdf", {"import.keyframe=home"}));
    FAIL();
  } catch (const io::ModelErrors& errors) {
    EXPECT_THAT(errors.text(), HasSubstr("is given, and only an MJCF has keyframes"));
  }
}

// Coordinates outside of a limit start at it, as MuJoCo's limits are soft.
TEST_F(Mjcf, KeyframesStayWithinStops) {
  const std::string text =
      "<compiler angle='radian'/><worldbody><body name='a'>"
      "<joint name='j' axis='0 1 0' range='-1 1'/>" +
      kBall + "</body></worldbody><keyframe><key qpos='1.25'/></keyframe>";
  EXPECT_NEAR(Simulation(read(text)).joint("j").coordinates[0], 1.0, kRounding);
  EXPECT_THAT(notes(text), HasSubstr("the joint 'j' starts at its limit 1, as 1.25 is outside"));
  EXPECT_NEAR(Simulation(read(text, {"import.limits=false"})).joint("j").coordinates[0], 1.25,
              kRounding);
}

// A joint that follows another one has its multiple of that one's position and velocity.
TEST_F(Mjcf, JointsThatFollowStartWithTheirLeader) {
  const Model model = read("<worldbody><body name='a'><joint name='p' axis='0 1 0'/>" + kBall +
                           "</body><body name='b'><joint name='q' axis='0 1 0'/>" + kBall +
                           "</body></worldbody><equality><joint joint1='q' joint2='p' "
                           "polycoef='0.1 -3 0 0 0'/></equality>"
                           "<keyframe><key qpos='0.2 9' qvel='0.5 9'/></keyframe>");
  EXPECT_NEAR(Simulation(model).joint("q").coordinates[0], 0.1 - 0.6, kRounding);
  EXPECT_NEAR((model.bodies.at(2).angular_velocity - Vec3(0, -1.5, 0)).norm(), 0.0, kRounding);
}

TEST_F(Mjcf, ControlsOfAKeyframeAreSetPoints) {
  const Model model = read("<worldbody><body name='arm'><joint name='j' axis='0 1 0'/>" + kBall +
                           R"(</body></worldbody>
<actuator>
  <motor name="m" joint="j" gear="5" ctrlrange="-1 1"/>
  <motor name="w" joint="j" gear="-2" forcerange="-3 3"/>
  <position name="p" joint="j" kp="20" kv="2" gear="2"/>
  <velocity name="v" joint="j" kv="4" gear="4"/>
  <general name="g" joint="j" gainprm="14" biastype="affine" biasprm="0 -7 -1"/>
</actuator>
<keyframe><key ctrl="3 4 0.5 0.25 0.5"/></keyframe>
)");
  const auto value = [&](const std::string& name) { return (*load_of(model, name)->value)(0.0); };
  EXPECT_EQ(value("m"), 5.0);
  EXPECT_EQ(value("w"), -6.0);
  EXPECT_EQ(value("p"), 0.25);    // 20 (0.5 - 2 q) = 0
  EXPECT_EQ(value("v"), 0.0625);  // 4 (0.25 - 4 q') = 0
  EXPECT_EQ(value("g"), 1.0);     // 14 x 0.5 - 7 q = 0
}

/// A cart of 3 kg that carries another one of 1 kg on the same axis.
std::string carts(const std::string& lower, const std::string& upper) {
  return "<worldbody><body name='l'><joint name='x' type='slide' axis='1 0 0' " + lower +
         "/><inertial pos='0 0 0' mass='3' diaginertia='1 1 1'/><body name='u'><joint name='y' "
         "type='slide' axis='1 0 0' " +
         upper + "/><inertial pos='0 0 0' mass='1' diaginertia='1 1 1'/></body></body></worldbody>";
}

// The lower cart alone is felt where both move freely: 3 kg; at the upper one 3 x 1 / (3 + 1) kg.
// MuJoCo's compiler chooses k = m / (tau zeta)^2 and d = 2 m / tau.
TEST_F(Mjcf, SpringsFollowFromTimeAndDampingRatio) {
  const Model model = read(carts("springdamper='0.5 2'", "springdamper='0.1 0.5'"));
  const auto value = [&](const char* joint, const char* key) {
    return load_of(model, joint)->parameters.at(key);
  };
  EXPECT_NEAR(value("x_spring", "stiffness"), 3.0, kRounding * 10.0);
  EXPECT_NEAR(value("x_spring", "damping"), 12.0, kRounding * 100.0);
  EXPECT_NEAR(value("y_spring", "stiffness"), 0.75 / 0.0025, kRounding * 1000.0);
  EXPECT_NEAR(value("y_spring", "damping"), 15.0, kRounding * 100.0);
  // One of the two numbers alone chooses nothing.
  EXPECT_EQ(
      read(carts("springdamper='0 1' stiffness='4'", "")).loads.at(0).parameters.at("stiffness"),
      4.0);
}

// A pendulum's inertia about its hinge with its armature, and a decay by exp(-t / tau).
TEST_F(Mjcf, TunedJointsOscillateWithTheirTimeConstant) {
  const double tau = 0.3, zeta = 0.4;
  for (const double step : {0.02, 0.002, 0.0002}) {
    Model model = read(
        "<option gravity='0 0 0'/><worldbody><body name='a'><joint name='j' "
        "axis='0 1 0' armature='0.5' springdamper='0.3 0.4'/><inertial pos='0.5 0 "
        "0' mass='2' diaginertia='0.3 0.2 0.1'/></body></worldbody>",
        {"import.start.j=0.4"});
    EXPECT_NEAR(load_of(model, "j_spring")->parameters.at("damping"), 2.0 * (0.5 + 0.7) / tau,
                1e-14);
    model.analysis.step = step;
    Simulation simulation(model);
    while (simulation.time() < 0.499) simulation.step(1.0);
    const double t = simulation.time(), w = std::sqrt(1.0 / (zeta * zeta) - 1.0) / tau;
    const double q = 0.4 * std::exp(-t / tau) * (std::cos(w * t) + std::sin(w * t) / (tau * w));
    EXPECT_NEAR(simulation.joint("j").coordinates[0], q, 10.0 * step * step) << step;
  }
}

// The servo feels the lower cart alone where both move freely: m = 3 kg, k = g^2 kp, and critical
// damping is 2 sqrt(k m).
TEST_F(Mjcf, DampingRatiosOfServosCountTheInertiaOfTheirJoint) {
  const std::string servo =
      "<actuator><position name='p' joint='x' kp='9' gear='2' dampratio='0.5'/></actuator>";
  const Model model = read(carts("", "") + servo);
  EXPECT_EQ(load_of(model, "p")->parameters.at("stiffness"), 36.0);
  EXPECT_NEAR(load_of(model, "p")->parameters.at("damping"), std::sqrt(108.0), 1e-13);
  // A general one with a positive third bias is the same.
  const Model other = read(carts("", "") +
                           "<actuator><general name='p' joint='x' gear='2' gainprm='9' "
                           "biastype='affine' biasprm='0 -9 0.5'/></actuator>");
  EXPECT_NEAR(load_of(other, "p")->parameters.at("damping"), std::sqrt(108.0), 1e-13);
}

TEST_F(Mjcf, SpringsThatCannotBeTunedAreRefused) {
  EXPECT_THAT(
      body_fault("<body><joint name='j' type='ball' springdamper='1 1'/>" + kBall + "</body>"),
      HasSubstr("the joint 'j' has a 'springdamper', but is no hinge or slide"));
  EXPECT_THAT(body_fault("<body><joint name='j' springdamper='1 1'/></body>"),
              HasSubstr("the 'springdamper' of 'j' acts on a tree that has no inertia"));
  EXPECT_THAT(fault("<worldbody><body><joint name='j'/></body></worldbody><actuator><position "
                    "name='p' joint='j' dampratio='1'/></actuator>"),
              HasSubstr("the actuator 'p' has a damping ratio in a tree that has no inertia"));
  std::string many = "<body name='a'><joint name='j' springdamper='1 1'/>" + kBall + "</body>";
  for (int k = 0; k < 167; ++k) many += "<body><freejoint/>" + kBall + "</body>";
  EXPECT_THAT(body_fault(many), HasSubstr("the 'springdamper' of 'j' stands in a model with more "
                                          "than 1000 joint velocities"));
  EXPECT_THAT(fault("<worldbody>" + many.substr(many.find("</body>") + 7) +
                    "<body><joint name='k'/>" + kBall +
                    "</body></worldbody><actuator><position name='p' joint='k' "
                    "dampratio='1'/></actuator>"),
              HasSubstr("the actuator 'p' has a damping ratio in a model with more than 1000"));
}

}  // namespace
}  // namespace polhode::mjcf_tests
