// SPDX-License-Identifier: Apache-2.0
// Models of MuJoCo's XML format: mass by closed forms, motions by energy and closed forms, and what
// is refused.
#include <algorithm>
#include <cmath>

#include <polhode/model/whole_mass.hpp>

#include "mjcf_fixture.hpp"

namespace polhode::mjcf_tests {
namespace {

// A capsule between two points, with the radius of a class and the density of its parent class:
// a cylinder and two halves of a ball.
TEST_F(Mjcf, MassFollowsFromGeomsAndClasses) {
  const Model model = read(R"(
<default>
  <geom density="500"/>
  <default class="thin"><geom type="capsule" size="0.1"/></default>
</default>
<worldbody>
  <body name="arm" childclass="thin">
    <joint axis="0 1 0"/>
    <geom fromto="0 0 0 1 0 0"/>
  </body>
</worldbody>
)");
  const BodySpec& arm = model.bodies.at(1);
  const double r = 0.1, l = 1.0, rho = 500.0;
  const double bar = rho * kPi * r * r * l, ball = rho * 4.0 / 3.0 * kPi * r * r * r;
  EXPECT_NEAR(arm.mass, bar + ball, kRounding * 100.0);
  EXPECT_NEAR((arm.position - Vec3(0.5, 0, 0)).norm(), 0.0, kRounding);
  EXPECT_NEAR(arm.inertia(0, 0), 0.5 * bar * r * r + 0.4 * ball * r * r, 1e-12);
  const double across =
      bar * (l * l / 12.0 + r * r / 4.0) + ball * (0.4 * r * r + l * l / 4.0 + 3.0 / 8.0 * l * r);
  EXPECT_NEAR(arm.inertia(1, 1), across, 1e-12);
  EXPECT_NEAR(arm.inertia(2, 2), across, 1e-12);
}

TEST_F(Mjcf, RotationsAreReadInEveryForm) {
  const auto x_of = [&](const std::string& attribute, const std::string& compiler = "") -> Vec3 {
    const Model model = read("<compiler " + compiler + "/><worldbody><body name='b' " + attribute +
                             "><freejoint/>" + kBall + "</body></worldbody>");
    return model.bodies.at(1).orientation * Vec3::UnitX();
  };
  EXPECT_NEAR((x_of("quat='1 0 0 1'") - Vec3(0, 1, 0)).norm(), 0.0, kRounding);
  EXPECT_NEAR((x_of("axisangle='0 0 2 90'") - Vec3(0, 1, 0)).norm(), 0.0, kRounding);
  EXPECT_NEAR(
      (x_of("axisangle='0 1 0 0.5'", "angle='radian'") - Vec3(std::cos(0.5), 0, -std::sin(0.5)))
          .norm(),
      0.0, kRounding);
  // About the moving z, then the moving y; capitals: about the fixed z, then the fixed y.
  EXPECT_NEAR((x_of("euler='90 90 0'", "eulerseq='zyx'") - Vec3(0, 0, -1)).norm(), 0.0, kRounding);
  EXPECT_NEAR((x_of("euler='90 90 0'", "eulerseq='ZYX'") - Vec3(0, 1, 0)).norm(), 0.0, kRounding);
  EXPECT_NEAR((x_of("xyaxes='0 3 0 -1 5 0'") - Vec3(0, 1, 0)).norm(), 0.0, kRounding);
  EXPECT_NEAR((x_of("zaxis='2 0 0'") - Vec3(0, 0, -1)).norm(), 0.0, kRounding);
}

// A pole on a cart without mass: its centre of mass only falls, and
// m y'^2/2 + J w^2/2 + m g y is constant, with y = l cos.
TEST_F(Mjcf, JointsOfABodyActOneAfterTheOther) {
  const std::string pole = R"(
<body name="pole">
  <joint name="slide" type="slide" axis="1 0 0"/>
  <joint name="hinge" axis="0 1 0"/>
  <inertial pos="0 0 0.5" mass="2" diaginertia="0.1 0.1 0.02"/>
</body>
)";
  for (const double step : {0.02, 0.002, 0.0002}) {
    Model model = read_bodies(pole, {"import.start.hinge=0.5"});
    model.analysis.step = step;
    Simulation simulation(model);
    const double x_0 = simulation.body("pole").r.x(), z_0 = simulation.body("pole").r.z();
    // The link between the joints takes 1e-10 of the pole, at its foot.
    EXPECT_NEAR(z_0, 0.5 * std::cos(0.5), 1e-10);
    while (simulation.time() < 0.599) simulation.step(1.0);
    const BodyMotion b = simulation.body("pole");
    const double w = b.omega().y();
    EXPECT_NEAR(b.r.x(), x_0, 2e-10) << step;
    const double kinetic = 0.5 * 2.0 * b.v.z() * b.v.z() + 0.5 * 0.1 * w * w;
    EXPECT_NEAR(kinetic, 2.0 * 9.81 * (z_0 - b.r.z()), 50.0 * step * step) << step;
    EXPECT_GT(kinetic, 1.0);
  }
}

// (J + armature) q'' = -k (q - springref) about a principal axis: q = s + (q_0 - s) cos(w t).
TEST_F(Mjcf, SpringsAndArmatureGiveTheFrequency) {
  const std::string wheel =
      "<body name='wheel'><joint name='j' axis='0 0 1' stiffness='4' "
      "armature='0.3' springref='0.2'/>" +
      kBall + "</body>";
  const double w = std::sqrt(4.0 / (0.1 + 0.3));
  for (const double step : {0.02, 0.002, 0.0002}) {
    Model model = read("<compiler angle='radian'/><worldbody>" + wheel + "</worldbody>",
                       {"import.start.j=0.5"});
    model.analysis.step = step;
    Simulation simulation(model);
    while (simulation.time() < 0.999) simulation.step(1.0);
    const Mat3 R = simulation.body("wheel").Lambda();
    const double t = simulation.time();
    EXPECT_NEAR(std::atan2(R(1, 0), R(0, 0)), 0.2 + 0.3 * std::cos(w * t), 3.0 * step * step)
        << step;
  }
}

// The pose of the file is that of the coordinate `ref`, in degrees.
TEST_F(Mjcf, CoordinatesCountFromTheirReference) {
  const std::string arm =
      "<body name='arm' pos='1 0 0'><joint name='j' axis='0 1 0' pos='0.5 0 0' ref='30' range='0 "
      "60'/>" +
      kBall + "</body>";
  const Model model = read_bodies(arm);
  EXPECT_NEAR((model.bodies.at(1).position - Vec3(1, 0, 0)).norm(), 0.0, kRounding);
  const Simulation simulation(model);
  EXPECT_NEAR(simulation.joint("j").coordinates[0], kPi / 6.0, kRounding);
  // Thirty degrees further about the point (1.5, 0, 0).
  const Model turned = read_bodies(arm, {"import.start.j=1.0471975511965976"});
  const Vec3 expected =
      Vec3(1.5, 0, 0) + Eigen::AngleAxisd(kPi / 6.0, Vec3::UnitY()) * Vec3(-0.5, 0, 0);
  EXPECT_NEAR((turned.bodies.at(1).position - expected).norm(), 0.0, kRounding);
  ASSERT_TRUE(turned.joints.at(0).limits.has_value());
  EXPECT_NEAR(turned.joints.at(0).limits->upper.value_or(0.0), kPi / 3.0, kRounding);
}

// A weight on two parallel rods, closed by <connect>: one freedom; and two rollers by <joint>.
TEST_F(Mjcf, EqualitiesAreExactConstraints) {
  const std::string text = R"(
<worldbody>
  <body name="left"><joint axis="0 1 0"/>)" +
                           kBall + R"(
    <body name="weight" pos="0 0 -1"><joint axis="0 1 0"/>)" +
                           kBall + R"(</body></body>
  <body name="right" pos="1 0 0"><joint axis="0 1 0"/>)" +
                           kBall + R"(
    <site name="end" pos="0 0 -1"/></body>
  <body name="a" pos="0 3 0"><joint name="qa" axis="0 1 0"/>)" +
                           kBall + R"(</body>
  <body name="b" pos="0 5 0"><joint name="qb" axis="0 1 0"/>)" +
                           kBall + R"(</body>
</worldbody>
<equality>
  <connect name="closes" body1="weight" body2="right" anchor="1 0 0"/>
  <joint joint1="qb" joint2="qa" polycoef="0 -3 0 0 0"/>
  <weld body1="a" body2="b" active="false"/>
</equality>
)";
  Simulation simulation(read(text));
  EXPECT_EQ(6 * simulation.system().body_count() - simulation.system().rows(),
            1);  // Two, and one row of the flat loop is redundant.
  EXPECT_THAT(notes(text),
              HasSubstr("the constraint 'closes' holds exactly, and is soft in MuJoCo"));
  EXPECT_THAT(notes(text), HasSubstr("a constraint of <equality> is not active"));
  const LoadSpec* row = load_of(simulation.model(), "qb_mimic");
  ASSERT_NE(row, nullptr);
  EXPECT_EQ(row->others.at(0).factor, -3.0);
}

// A fixed tendon of 2 q_a - q_b that keeps its length: b turns twice as much as a, from 0.4 on.
TEST_F(Mjcf, FixedTendonsThatAreHeldAreRows) {
  const std::string text =
      "<compiler angle='radian'/><worldbody>"
      "<body name='a'><joint name='qa' axis='0 1 0'/>" +
      kBall + "</body><body name='b'><joint name='qb' axis='0 1 0' ref='0.4'/>" + kBall +
      R"(</body></worldbody>
<tendon><fixed name="t"><joint joint="qa" coef="2"/><joint joint="qb" coef="-1"/></fixed></tendon>
<equality><tendon name="row" tendon1="t"/></equality>
)";
  Model model = read(text);
  const LoadSpec& row = *load_of(model, "row");
  EXPECT_EQ(row.others.at(0).factor, 0.5);
  EXPECT_EQ(row.parameters.at("offset"), -0.2);
  model.analysis.step = 0.01;
  model.bodies.at(1).angular_velocity = Vec3(0, 1, 0);
  model.bodies.at(2).angular_velocity = Vec3(0, 2, 0);
  Simulation simulation(model);
  while (simulation.time() < 0.499) simulation.step(1.0);
  const double qa = simulation.joint("qa").coordinates[0];
  EXPECT_GT(qa, 0.4);
  EXPECT_NEAR(simulation.joint("qb").coordinates[0] - 0.4, 2.0 * qa, 1e-13);
}

TEST_F(Mjcf, ActuatorsAreMotorsAndServos) {
  const std::string text = "<worldbody><body name='arm'><joint name='j' axis='0 1 0'/>" + kBall +
                           R"(</body></worldbody>
<default><motor gear="5"/></default>
<actuator>
  <motor name="m" joint="j"/>
  <position name="p" joint="j" kp="20" kv="2" gear="2" forcerange="-3 3"/>
  <velocity name="v" joint="j" kv="4" gear="1"/>
  <general name="g" joint="j" biastype="affine" biasprm="0 -7 -1" gear="1"/>
</actuator>
)";
  const Model model = read(text);
  EXPECT_EQ(load_of(model, "m")->type, "rotary_motor");
  const LoadSpec& p = *load_of(model, "p");
  EXPECT_EQ(p.type, "rotary_servo");
  EXPECT_EQ(p.parameters.at("stiffness"), 80.0);
  EXPECT_EQ(p.parameters.at("damping"), 8.0);
  EXPECT_EQ(p.parameters.at("max_moment"), 6.0);
  EXPECT_EQ(load_of(model, "v")->drive, "speed");
  EXPECT_EQ(load_of(model, "g")->parameters.at("stiffness"), 7.0);
  EXPECT_EQ(read(text, {"import.actuators=false"}).loads.size(), 0U);
}

// Damping of a free joint acts at the origin of the body, m v' = -d v.
TEST_F(Mjcf, FreeJointsMayBeDamped) {
  const std::string text =
      "<option gravity='0 0 0'/><worldbody><body name='b'><joint name='f' "
      "type='free' damping='3'/>" +
      kBall + "</body></worldbody>";
  for (const double step : {0.02, 0.002, 0.0002}) {
    Model model = read(text);
    model.bodies.at(1).velocity = Vec3(1, 0, 0);
    model.analysis.step = step;
    Simulation simulation(model);
    while (simulation.time() < 0.999) simulation.step(1.0);
    EXPECT_NEAR(simulation.body("b").v.x(), std::exp(-1.5 * simulation.time()), step * step)
        << step;
  }
}

// m v' = m g - a v' for the body's origin: the armature has no weight.
TEST_F(Mjcf, FreeJointsMayHaveAnArmature) {
  const std::string text =
      "<option gravity='0 0 -9'/><worldbody><body name='b'><joint name='f' type='free' "
      "armature='1'/>" +
      kBall + "</body></worldbody>";
  EXPECT_THAT(notes(text), HasSubstr("the armature of 'f' is a body on it, 'b_armature'"));
  for (const double step : {0.1, 0.01, 0.001}) {
    Model model = read(text);
    EXPECT_EQ(model.bodies.at(1).mass, 2.0);
    model.analysis.step = step;
    Simulation simulation(model);
    while (simulation.time() < 0.999) simulation.step(1.0);
    EXPECT_NEAR(simulation.body("b").v.z(), -6.0 * simulation.time(), 1e-11) << step;
  }
}

// A constraint with one joint holds its coordinate, in the file's unit from the reference.
TEST_F(Mjcf, EqualitiesHoldACoordinate) {
  const Model model = read(
      "<compiler angle='radian'/><worldbody><body name='b'><joint name='j' "
      "axis='0 1 0' ref='0.25'/>" +
      kBall +
      "</body></worldbody><equality><joint name='e' joint1='j' "
      "polycoef='0.125 7 7'/></equality>");
  const LoadSpec* row = load_of(model, "e");
  ASSERT_NE(row, nullptr);
  EXPECT_EQ(row->type, "coupling");
  EXPECT_TRUE(row->others.empty());
  Simulation simulation(model);
  while (simulation.time() < 0.1) simulation.step(0.2);
  const Mat3 R = simulation.body("b").Lambda();
  EXPECT_NEAR(std::atan2(R(0, 2), R(0, 0)), 0.125, kRounding);
}

TEST_F(Mjcf, FilesAreIncludedOnce) {
  write("arm.xml", "<mujocoinclude><body name='arm'><joint/>" + kBall + "</body></mujocoinclude>");
  EXPECT_EQ(read_bodies("<include file='arm.xml'/>").bodies.size(), 2U);
  EXPECT_THAT(body_fault("<include file='arm.xml'/><include file='arm.xml'/>"),
              HasSubstr("the file 'arm.xml' is included twice"));
  EXPECT_THAT(body_fault("<include file='leg.xml'/>"),
              HasSubstr("there is no file 'leg.xml' to include"));
  EXPECT_THAT(body_fault("<include/>"), HasSubstr("<include> has no 'file'"));
  write("bad.xml", "<mujoco><body>");
  EXPECT_THAT(body_fault("<include file='bad.xml'/>"), HasSubstr("is not XML, or too large"));
  write("self.xml", "<mujoco><include file='self.xml'/></mujoco>");
  EXPECT_THAT(body_fault("<include file='self.xml'/>"), HasSubstr("is included twice"));
}

/// A cube of 0.2 m about (0.1, 0.1, 0.1), in text STL.
std::string cube() {
  std::string text = "solid cube\n";
  const auto triangle = [&](const Vec3& a, const Vec3& b, const Vec3& c) {
    text += "facet normal 0 0 0\nouter loop\n";
    for (const Vec3& x : {a, b, c}) text += format("vertex {} {} {}\n", x.x(), x.y(), x.z());
    text += "endloop\nendfacet\n";
  };
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {0.0, 0.2}) {
      Vec3 x[4];
      for (int k = 0; k < 4; ++k) {
        x[k] = Vec3::Zero();
        x[k][axis] = side;
        x[k][(axis + 1) % 3] = k == 1 || k == 2 ? 0.2 : 0.0;
        x[k][(axis + 2) % 3] = k >= 2 ? 0.2 : 0.0;
      }
      if (side == 0.0) std::swap(x[1], x[3]);
      triangle(x[0], x[1], x[2]);
      triangle(x[0], x[2], x[3]);
    }
  return text + "endsolid cube\n";
}

TEST_F(Mjcf, MeshesHaveMass) {
  write("cube.stl", cube());
  for (const std::string how : {"legacy", "exact", "convex"}) {
    const Model model = read("<asset><mesh name='c' file='cube.stl' scale='2 2 2' inertia='" + how +
                             "'/></asset><worldbody><body name='b'><freejoint/><geom type='mesh' "
                             "mesh='c' density='1000'/></body></worldbody>");
    const BodySpec& b = model.bodies.at(1);
    EXPECT_NEAR(b.mass, 64.0, 1e-11) << how;
    EXPECT_NEAR((b.position - Vec3(0.2, 0.2, 0.2)).norm(), 0.0, kRounding) << how;
    EXPECT_NEAR((b.inertia - 64.0 * 0.16 / 6.0 * Mat3::Identity()).norm(), 0.0, 1e-12) << how;
    EXPECT_EQ(b.shapes.size(), 1U);
  }
  EXPECT_THAT(body_fault("<body><freejoint/><geom type='mesh' mesh='d'/></body>"),
              HasSubstr("there is no mesh 'd'"));
  EXPECT_THAT(fault("<asset><mesh file='no.stl'/></asset><worldbody><body><freejoint/><geom "
                    "type='mesh' mesh='no'/></body></worldbody>"),
              HasSubstr("the mass of the mesh 'no' is not known"));
}

TEST_F(Mjcf, SettingsOfTheCompilerAct) {
  const auto total = [&](const std::string& settings) {
    return whole_mass(read("<compiler " + settings + "/><worldbody><body><freejoint/>" + kBall +
                           "<geom size='0.1' mass='7'/></body></worldbody>"))
        .mass;
  };
  EXPECT_EQ(total(""), 2.0);
  EXPECT_NEAR(total("inertiafromgeom='true'"), 7.0, kRounding * 10.0);
  EXPECT_EQ(total("boundmass='3'"), 3.0);
  EXPECT_NEAR(total("settotalmass='12'"), 12.0, kRounding * 10.0);
  EXPECT_THAT(fault("<compiler coordinate='global'/>"), HasSubstr("the coordinates are 'global'"));
  EXPECT_THAT(fault("<compiler eulerseq='xyw'/>"), HasSubstr("'eulerseq' is 'xyw'"));
}

TEST_F(Mjcf, WhatIsNotReadIsRefusedOrListed) {
  const std::string arm = "<body name='arm'><joint name='j' axis='0 1 0'/>" + kBall + "</body>";
  const std::string world = "<worldbody>" + arm + "</worldbody>";
  EXPECT_THAT(fault(""), HasSubstr("the model has no body"));
  EXPECT_THAT(fault(world, {"import.base=floating"}),
              HasSubstr("an MJCF file says itself which bodies move freely"));
  EXPECT_THAT(fault(world + "<equality><tendon tendon1='t'/></equality>"),
              HasSubstr("the length of the tendon 't' is not a sum of coordinates"));
  EXPECT_THAT(fault(world + "<equality><flex flex='t'/></equality>"),
              HasSubstr("<flex> in <equality> is not read"));
  EXPECT_THAT(fault(world + "<equality><joint joint1='i' joint2='j'/></equality>"),
              HasSubstr("there is no joint 'i'. Joints: j."));
  EXPECT_THAT(fault(world + "<equality><joint joint1='j' joint2='j' polycoef='0 1 2'/></equality>"),
              HasSubstr("'j' follows by a polynomial of a higher order"));
  EXPECT_THAT(fault(world + "<equality><connect body1='leg'/></equality>"),
              HasSubstr("there is no body 'leg'"));
  EXPECT_THAT(fault(world + "<equality><connect site1='s' site2='s'/></equality>"),
              HasSubstr("there is no site 's'"));
  EXPECT_THAT(fault(world + "<actuator><muscle joint='j'/></actuator>"), HasSubstr("is a muscle"));
  EXPECT_THAT(fault(world + "<actuator><motor tendon='t'/></actuator>"),
              HasSubstr("there is no tendon 't'"));
  EXPECT_THAT(fault(world + "<actuator><motor site='s'/></actuator>"),
              HasSubstr("there is no site 's'"));
  EXPECT_THAT(fault(world + "<actuator><general joint='j' dyntype='user'/></actuator>"),
              HasSubstr("has the dynamics 'user'"));
  EXPECT_THAT(
      fault(world + "<actuator><general joint='j' biastype='affine' biasprm='0 1'/></actuator>"),
      HasSubstr("has a bias that is no spring and damper"));
  EXPECT_THAT(fault(world + "<actuator><general joint='j' gaintype='user'/></actuator>"),
              HasSubstr("has a gain or bias that is not affine"));
  EXPECT_THAT(fault(world + "<deformable/>"), HasSubstr("<deformable> is not read"));
  EXPECT_THAT(notes(world + "<keyframe/><sensor/><strange/>"),
              HasSubstr("<strange> in <mujoco> is unknown"));
  EXPECT_THAT(notes(world + "<deformable/>", {"import.allow_partial=true"}),
              HasSubstr("left out: <deformable> is not read"));
}

TEST_F(Mjcf, BodiesAndJointsThatCannotBeReadAreNamed) {
  const auto joint = [&](const std::string& attributes) {
    return body_fault("<body name='b'><joint name='j' " + attributes + "/>" + kBall + "</body>");
  };
  EXPECT_THAT(joint("type='screw'"), HasSubstr("the joint 'j' has the unknown type 'screw'"));
  EXPECT_THAT(joint("axis='0 0 0'"), HasSubstr("the axis of 'j' has no length"));
  EXPECT_THAT(joint("damping='-1'"), HasSubstr("'damping' of 'j' is -1"));
  EXPECT_THAT(joint("type='ball' damping='1 2'"), HasSubstr("'damping' of 'j' is a polynomial"));
  EXPECT_THAT(joint("range='2 1'"), HasSubstr("the joint 'j' has the limits"));
  EXPECT_THAT(joint("limited='maybe'"), HasSubstr("'limited' of <joint> is 'maybe'"));
  EXPECT_THAT(joint("type='ball' stiffness='2'"), HasSubstr("the ball joint 'j' has a stiffness"));
  EXPECT_THAT(joint("type='ball' armature='2'"), HasSubstr("the ball joint 'j' has an armature"));
  EXPECT_THAT(joint("type='ball' frictionloss='2'"),
              HasSubstr("the ball joint 'j' has a friction loss"));
  EXPECT_THAT(joint("type='ball' range='0 1'"), HasSubstr("the ball joint 'j' has a limit"));
  EXPECT_THAT(joint("type='free' stiffness='2'"),
              HasSubstr("the free joint 'j' has a stiffness or friction"));
  EXPECT_THAT(joint("class='no'"), HasSubstr("there is no class 'no'"));
  EXPECT_THAT(body_fault("<body name='a'><joint/>" + kBall +
                         "<body name='b'><freejoint name='f'/>" + kBall + "</body></body>"),
              HasSubstr("the free joint 'f' is not the only one of a body of the world"));
  EXPECT_THAT(body_fault("<body name='a'>" + kBall + "</body><body name='a'>" + kBall + "</body>"),
              HasSubstr("the body 'a' stands twice"));
  EXPECT_THAT(body_fault("<body><joint/><inertial pos='0 0 0'/></body>"),
              HasSubstr("<inertial> has no 'mass'"));
  EXPECT_THAT(body_fault("<body><joint/><inertial mass='-1' pos='0 0 0'/></body>"),
              HasSubstr("the mass is -1"));
  EXPECT_THAT(body_fault("<body quat='0 0 0 0'><joint/>" + kBall + "</body>"),
              HasSubstr("'quat' of <body> gives no direction"));
  EXPECT_THAT(body_fault("<body><joint/><geom type='cone' size='1'/></body>"),
              HasSubstr("<geom> has the unknown type 'cone'"));
  EXPECT_THAT(body_fault("<body><joint/><geom type='box' size='1'/></body>"),
              HasSubstr("the box has too few sizes"));
  EXPECT_THAT(
      body_fault("<body><joint/><geom type='capsule' size='1' fromto='0 0 0 0 0 0'/></body>"),
      HasSubstr("'fromto' of <geom> has no length"));
  EXPECT_THAT(body_fault("<body><joint/><geom size='1' shellinertia='true'/></body>"),
              HasSubstr("the mass of <geom> is in its shell"));
  EXPECT_THAT(body_fault("<body><joint/><geom size='1' density='-1'/></body>"),
              HasSubstr("the mass of <geom> is negative"));
  EXPECT_THAT(body_fault("<body><joint/><geom type='capsule' size='1e308 1e308'/></body>"),
              HasSubstr("the mass of <geom> cannot be computed: the size 'diameter'"));
  EXPECT_THAT(body_fault("<composite/>"), HasSubstr("<composite> is not read"));
  EXPECT_THAT(fault("<default><default><geom/></default></default>"),
              HasSubstr("a nested <default> has no 'class'"));
  std::ofstream(folder_ / "other.xml") << "<robot/>";
  try {
    static_cast<void>(io::read_model(folder_ / "other.xml"));
    FAIL();
  } catch (const io::ModelErrors& errors) {
    EXPECT_THAT(errors.text(), HasSubstr("the file's tag is <robot>, not <mujoco>"));
  }
}

TEST_F(Mjcf, PlanesOfTheWorldAreShapesOfTheFixedBody) {
  const Model m =
      read("<worldbody><geom type='plane' size='1 1 0.1' pos='0 0 -1'/><body name='a'>" + kBall +
           "<freejoint/></body></worldbody>");
  EXPECT_EQ(m.bodies[0].shapes.size(), 1U);
}

// A run of the model file that convert writes is that of the file itself.
TEST_F(Mjcf, TheWrittenModelIsTheSame) {
  const std::string text =
      "<worldbody><body name='a'><joint name='x' type='slide' axis='1 0 0'/>"
      "<joint name='y' axis='0 1 0' armature='0.1' damping='0.2'/>" +
      kBall + "<geom size='0.1'/></body></worldbody>";
  const Model direct = read(text);
  const io::ExpandedModel expanded = io::expanded_model(folder_ / "robot.xml", io::Overrides{});
  const Model again = io::read_model(write("model.yaml", expanded.text));
  ASSERT_EQ(again.bodies.size(), direct.bodies.size());
  for (std::size_t i = 0; i < direct.bodies.size(); ++i) {
    EXPECT_EQ(again.bodies[i].mass, direct.bodies[i].mass);
    EXPECT_EQ(again.bodies[i].inertia, direct.bodies[i].inertia);
    EXPECT_EQ(again.bodies[i].position, direct.bodies[i].position);
  }
  EXPECT_EQ(again.loads.size(), direct.loads.size());
}

}  // namespace
}  // namespace polhode::mjcf_tests
