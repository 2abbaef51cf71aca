// SPDX-License-Identifier: Apache-2.0
// Tendons of an MJCF as springs, cables and pulls, and sensors as probes.
#include <cmath>

#include "mjcf_fixture.hpp"

namespace polhode::mjcf_tests {
namespace {

/// A slide along x with a site, and three sites of the world.
const std::string kSites =
    "<worldbody><site name='a' pos='-2 0 0'/><site name='b' pos='0 0 3'/>"
    "<geom name='ball' size='0.5' pos='-1 0 0' contype='0'/>"
    "<geom name='bar' type='cylinder' size='0.5 1' pos='-1 0 0' "
    "euler='90 0 0' contype='0'/>"
    "<site name='up' pos='-1 0 2'/><site name='middle' pos='-1 0 0.1'/>"
    "<body name='cart'><joint name='x' type='slide' axis='1 0 0'/>" +
    kBall + "<site name='c' pos='0 0 0'/></body></worldbody>";

std::string spatial(const std::string& attributes, const std::string& path) {
  return kSites + "<tendon><spatial name='t' " + attributes + ">" + path + "</spatial></tendon>";
}
const std::string kStraight = "<site site='a'/><site site='c'/>";
const std::string kBent = "<site site='a'/><site site='b'/><site site='c'/>";
std::string around(const std::string& geom, const std::string& side = "up") {
  return "<site site='a'/><geom geom='" + geom + "' sidesite='" + side + "'/><site site='c'/>";
}
/// From a point to the opposite one, both at 1 m from the axis, around a radius of 0.5 m.
const double kAround = 2.0 * std::sqrt(0.75) + 0.5 * (kPi - 2.0 * std::acos(0.5));

// m x'' = -k (l - l_0) - d l' along the line from (-2, 0, 0).
TEST_F(Mjcf, TendonsBetweenTwoSitesAreSprings) {
  const std::string text = "<option gravity='0 0 0'/>" +
                           spatial("stiffness='50' damping='4' springlength='2.5'", kStraight);
  for (const double step : {0.02, 0.002, 0.0002}) {
    Model model = read(text);
    model.analysis.step = step;
    Simulation simulation(model);
    while (simulation.time() < 0.999) simulation.step(1.0);
    const double t = simulation.time(), w = std::sqrt(25.0 - 1.0);
    const double x = 0.5 - 0.5 * std::exp(-t) * (std::cos(w * t) + std::sin(w * t) / w);
    EXPECT_NEAR(simulation.joint("x").coordinates[0], x, 20.0 * step * step) << step;
  }
  // By default the free length is that where all joint springs are relaxed.
  EXPECT_EQ(load_of(read(text + "<keyframe><key qpos='1'/></keyframe>"), "t")
                ->parameters.at("free_length"),
            2.5);
  const std::string plain =
      spatial("stiffness='50'", kStraight) + "<keyframe><key qpos='1'/></keyframe>";
  EXPECT_EQ(load_of(read(plain), "t")->parameters.at("free_length"), 2.0);
  const Model slack = read(spatial("stiffness='50' springlength='1 2.5'", kStraight));
  EXPECT_EQ(load_of(slack, "t")->words.at("acts"), "tension");
  EXPECT_EQ(load_of(slack, "t")->parameters.at("free_length"), 2.5);
  EXPECT_EQ(load_of(slack, "t_push")->words.at("acts"), "compression");
  EXPECT_EQ(load_of(slack, "t_push")->parameters.at("free_length"), 1.0);
}

TEST_F(Mjcf, TendonsOverSeveralSitesAreCables) {
  const Model model = read(spatial("stiffness='50' damping='4'", kBent));
  const CableLineSpec& cable = model.cables.at(0);
  const double length = std::hypot(2.0, 3.0) + 3.0;
  EXPECT_EQ(cable.name, "t");
  EXPECT_TRUE(cable.slides);
  EXPECT_FALSE(cable.tension_only);
  EXPECT_NEAR(cable.free_length.value_or(0.0), length, kRounding * 10.0);
  EXPECT_NEAR(cable.stiffness, 50.0 * length, kRounding * 1000.0);
  EXPECT_EQ(cable.damping, 4.0);
  EXPECT_TRUE(read(spatial("stiffness='50' springlength='0 4'", kBent)).cables.at(0).tension_only);
  EXPECT_EQ(read(spatial("damping='4'", kBent)).cables.at(0).stiffness, 0.0);
  EXPECT_THAT(notes(spatial("stiffness='50' damping='1' springlength='0 4'", kBent)),
              HasSubstr("the tendon 't' is damped only while it pulls"));
}

// The line around a sphere or cylinder is straight, an arc, and straight.
TEST_F(Mjcf, TendonsRunAroundSpheresAndCylinders) {
  for (const std::string geom : {"ball", "bar"}) {
    const Model model = read(spatial("stiffness='50'", around(geom)));
    const CableLineSpec& cable = model.cables.at(0);
    EXPECT_NEAR(cable.free_length.value_or(0.0), kAround, 1e-12) << geom;
    ASSERT_EQ(cable.around.size(), 1U);
    const ObstacleSpec& obstacle = cable.around[0];
    EXPECT_EQ(obstacle.name, geom);
    EXPECT_EQ(obstacle.semi_axes.x(), 0.5);
    EXPECT_EQ(std::isinf(obstacle.semi_axes.z()), geom == "bar");
    EXPECT_NEAR((*obstacle.side - Vec3::UnitZ()).norm(), 0.0, kRounding);
    // It is relaxed: the cart rests.
    Model still = model;
    still.analysis.step = 0.01;
    Simulation simulation(still);
    while (simulation.time() < 0.199) simulation.step(1.0);
    EXPECT_NEAR(simulation.joint("x").coordinates[0], 0.0, 1e-12) << geom;
  }
}

// A constant pull of 3 N along the line: positive controls lengthen the tendon.
TEST_F(Mjcf, MotorsPullTendons) {
  const std::string motor =
      "<actuator><motor name='m' tendon='t' gear='-3'/></actuator>"
      "<keyframe><key ctrl='1'/></keyframe>";
  for (const std::string& path : {kStraight, kBent}) {
    Model model = read("<option gravity='0 0 0'/>" + spatial("", path) + motor);
    for (const double step : {0.02, 0.002}) {
      model.analysis.step = step;
      Simulation simulation(model);
      simulation.step(1.0);
      const double t = simulation.time();
      // The cart of 2 kg is pulled along -x, or straight up from the end of the bent line.
      const double x = path == kStraight ? -0.5 * 1.5 * t * t : 0.0;
      EXPECT_NEAR(simulation.joint("x").coordinates[0], x, t * t * t) << step;
    }
  }
  EXPECT_THAT(notes(spatial("", kStraight) + motor),
              HasSubstr("the actuator 'm' is the pull of the tendon 't'"));
  EXPECT_EQ(read(spatial("", kStraight) + motor, {"import.actuators=false"}).loads.size(), 0U);
}

// A sum of one coordinate, 2 x: its spring of 10 N/m is one of 40 N/m on the slide.
TEST_F(Mjcf, FixedTendonsOfOneJointAreItsSpring) {
  const std::string cart =
      "<worldbody><body name='cart'><joint name='x' type='slide' axis='1 0 0' "
      "stiffness='10' springref='0.3' damping='1'/>" +
      kBall + "</body></worldbody>";
  const std::string sum = "<joint joint='x' coef='2'/></fixed></tendon>";
  const Model model =
      read(cart + "<tendon><fixed name='t' stiffness='10' damping='3' springlength='1'>" + sum);
  const auto& p = load_of(model, "x_spring")->parameters;
  EXPECT_EQ(p.at("stiffness"), 50.0);
  EXPECT_EQ(p.at("damping"), 13.0);
  EXPECT_NEAR(p.at("free_displacement"), (10.0 * 0.3 + 40.0 * 0.5) / 50.0, kRounding);
  // By default it is relaxed where the joint's spring is.
  EXPECT_NEAR(load_of(read(cart + "<tendon><fixed name='t' stiffness='10'>" + sum), "x_spring")
                  ->parameters.at("free_displacement"),
              0.3, kRounding);
  const Model driven = read(cart + "<tendon><fixed name='t'>" + sum +
                            "<actuator><motor name='m' tendon='t' gear='3'/><position name='p' "
                            "tendon='t' kp='5'/></actuator><keyframe><key ctrl='1 1'/></keyframe>");
  EXPECT_EQ((*load_of(driven, "m")->value)(0.0), 6.0);
  EXPECT_EQ(load_of(driven, "p")->parameters.at("stiffness"), 20.0);
  EXPECT_EQ((*load_of(driven, "p")->value)(0.0), 0.5);
}

// A motor of a sum drives each of its joints with its factor.
TEST_F(Mjcf, MotorsOfSumsDriveAllTheirJoints) {
  const std::string text =
      "<worldbody><body name='a'><joint name='p' axis='0 1 0'/>" + kBall +
      "</body><body name='b'><joint name='q' axis='0 1 0'/>" + kBall +
      "</body></worldbody><tendon><fixed name='t'><joint joint='p' coef='2'/><joint joint='q' "
      "coef='-1'/></fixed></tendon><keyframe><key ctrl='3'/></keyframe><actuator>";
  const Model model = read(text + "<motor name='m' tendon='t'/></actuator>");
  EXPECT_EQ((*load_of(model, "m_p")->value)(0.0), 6.0);
  EXPECT_EQ((*load_of(model, "m_q")->value)(0.0), -3.0);
}

TEST_F(Mjcf, TendonsThatCannotBeReadAreNamed) {
  EXPECT_THAT(fault(spatial("", "<site site='a'/><pulley divisor='2'/><site site='c'/>")),
              HasSubstr("the tendon 't' has a <pulley>"));
  EXPECT_THAT(fault(spatial("", "<site site='a'/>")),
              HasSubstr("the tendon 't' has fewer than two sites, or ends on a geom"));
  EXPECT_THAT(fault(spatial("", "<geom geom='ball'/><site site='a'/>")),
              HasSubstr("a geom of the tendon 't' has no site before it"));
  EXPECT_THAT(fault(spatial("", "<site site='z'/>")), HasSubstr("there is no site 'z'"));
  EXPECT_THAT(fault(spatial("", around("box"))), HasSubstr("there is no sphere or cylinder 'box'"));
  EXPECT_THAT(fault(spatial("", around("ball", "c"))),
              HasSubstr("there is no site 'c' on the body of 'ball'"));
  EXPECT_THAT(fault(spatial("", around("bar", "middle"))),
              HasSubstr("the tendon 't' passes through the inside of 'bar'"));
  EXPECT_THAT(fault(spatial("stiffness='1' springlength='1 2'", kBent)),
              HasSubstr("the tendon 't' pushes where it is shorter than 1"));
  EXPECT_THAT(fault(spatial("stiffness='1' springlength='0'", kBent)),
              HasSubstr("the tendon 't' has no free length"));
  EXPECT_THAT(fault(spatial("stiffness='1' springlength='-3 -2'", kStraight)),
              HasSubstr("the tendon 't' has the free length -2"));
  EXPECT_THAT(fault(spatial("stiffness='1' springlength='2 1'", kStraight)),
              HasSubstr("'springlength' is from 2 to 1"));
  EXPECT_THAT(fault(spatial("stiffness='-1'", kStraight)),
              HasSubstr("'stiffness' of the tendon 't' is -1"));
  EXPECT_THAT(fault(spatial("damping='1 2'", kStraight)),
              HasSubstr("'damping' of the tendon 't' is a polynomial"));
  EXPECT_THAT(fault(spatial("armature='1'", kStraight)),
              HasSubstr("the tendon 't' has an armature"));
  EXPECT_THAT(fault(spatial("range='0 1'", kBent)),
              HasSubstr("the tendon 't' has limits of a length over several points"));
  EXPECT_THAT(notes(spatial("range='0 1'", kStraight)),
              HasSubstr("there is no 't_limits', as the length is 2 at the start, outside of it"));
  EXPECT_THAT(fault(spatial("frictionloss='1'", kStraight)),
              HasSubstr("the tendon 't' has friction of a line"));
  EXPECT_THAT(notes(spatial("", kBent)),
              HasSubstr("a tendon without stiffness, damping and actuator exerts no force"));
  EXPECT_THAT(notes(spatial("stiffness='1'", "<site site='a'/><site site='b'/>")),
              HasSubstr("the tendon 't' is between points that do not move"));
  EXPECT_THAT(fault(spatial("", kBent) + "<actuator><muscle name='p' tendon='t'/></actuator>"),
              HasSubstr("the actuator 'p' is a muscle with curves of its own"));
  const auto sum = [&](const std::string& attributes, const std::string& joints) {
    return fault(kSites + "<tendon><fixed name='t' " + attributes + ">" + joints +
                 "</fixed></tendon>");
  };
  EXPECT_THAT(notes(kSites + "<tendon><fixed name='t' stiffness='1'/></tendon>"),
              HasSubstr("a fixed tendon without joints exerts no force"));
  EXPECT_THAT(sum("range='1 0' limited='true'", "<joint joint='x' coef='1'/>"),
              HasSubstr("the tendon 't' has the limits 1 to 0"));
  EXPECT_THAT(sum("", "<joint joint='y' coef='1'/>"), HasSubstr("there is no joint 'y'"));
}

TEST_F(Mjcf, SensorsAreProbes) {
  const std::string sensors = R"(
<actuator><motor name="m" joint="x"/><motor name="pull" tendon="t"/></actuator>
<sensor>
  <jointpos name="place" joint="x"/>
  <actuatorfrc actuator="m"/>
  <tendonpos name="line" tendon="t"/>
  <framequat name="turn" objtype="body" objname="cart"/>
  <gyro name="gyro" site="c"/>
  <framepos name="seen" objtype="site" objname="c" reftype="body" refname="cart"/>
  <force name="load" site="c"/>
  <touch name="skin" site="c"/>
  <framepos name="eye" objtype="camera" objname="c"/>
</sensor>
)";
  const Model model = read(spatial("", kBent) + sensors);
  const auto probe = [&](const std::string& name) {
    for (const ProbeSpec& p : model.output.probes)
      if (p.name == name) return p;
    ADD_FAILURE() << name;
    return ProbeSpec{};
  };
  EXPECT_EQ(model.output.probes.size(), 7U);
  EXPECT_EQ(probe("place").kind, "joint");
  EXPECT_EQ(probe("load").kind, "joint");
  EXPECT_EQ(probe("actuatorfrc_m").kind, "load");
  EXPECT_EQ(probe("line").kind, "cable");
  EXPECT_EQ(probe("turn").rotation, "quaternion");
  EXPECT_TRUE(probe("gyro").angular);
  EXPECT_NE(probe("seen").seen_from, kGround);
  const std::string list = notes(spatial("", kBent) + sensors);
  EXPECT_THAT(list, HasSubstr("sensors become probes, which record all of a joint"));
  EXPECT_THAT(list, HasSubstr("<touch> in <sensor> is not recorded by a probe"));
  EXPECT_THAT(list, HasSubstr("a sensor of a camera is not recorded"));
  EXPECT_THAT(notes(spatial("", kBent) + "<sensor><tendonpos name='l' tendon='t'/></sensor>"),
              HasSubstr("the sensor 'l' is of 't', which is not in the model"));
  EXPECT_THAT(fault(kSites + "<sensor><gyro site='z'/></sensor>"),
              HasSubstr("there is no site 'z'"));
  EXPECT_THAT(fault(kSites + "<sensor><framepos objtype='body' objname='z'/></sensor>"),
              HasSubstr("there is no body 'z'"));
  EXPECT_THAT(fault(kSites + "<sensor><jointpos/></sensor>"), HasSubstr("'joint'"));
}

}  // namespace
}  // namespace polhode::mjcf_tests
