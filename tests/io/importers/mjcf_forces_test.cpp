// SPDX-License-Identifier: Apache-2.0
// Actuators with dynamics and bounds, tendons over several joints, a medium and contact of an MJCF.
#include <cmath>

#include "mjcf_fixture.hpp"

namespace polhode::mjcf_tests {
namespace {

/// Two carts of 2 kg on slides along x, and the sum of their places as a fixed tendon.
std::string sum_of_carts(const std::string& tendon, const std::string& more = "") {
  return "<option gravity='0 0 -10'/><worldbody><body name='a'><joint name='p' type='slide' "
         "axis='1 "
         "0 0'/>" +
         kBall + "</body><body name='b' pos='0 1 0'><joint name='q' type='slide' axis='1 0 0'/>" +
         kBall + "</body></worldbody><tendon><fixed name='t' " + tendon +
         "><joint joint='p' coef='1'/><joint joint='q' coef='1'/></fixed></tendon>" + more;
}
const std::string kMoving = "<keyframe><key qvel='1 1'/></keyframe>";

/// A cart that rests, with an actuator on its slide.
std::string cart(const std::string& actuator, const std::string& key = "") {
  return "<worldbody><site name='post'/><body name='a' euler='0 0 90'><joint name='p' type='slide' "
         "axis='0 0 1'/>" +
         kBall + "<site name='s' pos='1 0 0' euler='90 0 0'/></body></worldbody><actuator>" +
         actuator + "</actuator><keyframe><key " + key + "/></keyframe>";
}

double moved(const Model& given, const char* joint, double step, double end) {
  Model model = given;
  model.analysis.step = step;
  Simulation simulation(model);
  while (simulation.time() < end - 0.5 * step) simulation.step(end);
  return simulation.joint(joint).coordinates[0];
}

// The coordinate c of a servo with k (c - q) + d (c' - q') is such that k c + d c' is the force of
// the activation, 9 (0.5 - 0.7 exp(-t/0.2)).
TEST_F(Mjcf, LagsAreFunctionsOfTime) {
  const std::string key = "ctrl='0.5' act='-0.2'";
  const Model model =
      read(cart("<position name='m' joint='p' kp='9' kv='1' timeconst='0.2'/>", key));
  const LoadSpec& servo = *load_of(model, "m");
  for (const double t : {0.0, 0.1, 0.7}) {
    const TimeRates c = servo.value->rates(t, TimeSide::kAfter);
    EXPECT_NEAR(9.0 * c.value + c.rate, 9.0 * (0.5 - 0.7 * std::exp(-t / 0.2)), 1e-13) << t;
  }
  // Where that coordinate would be infinite, or the activation has bounds, it is a motor's force.
  for (const std::string kv : {"1.8", "1"}) {
    const Model split =
        read(cart("<general name='m' joint='p' dyntype='filter' dynprm='0.2' "
                  "gainprm='9' biastype='affine' biasprm='0 -9 -" +
                      kv + "'" + (kv == "1" ? " actrange='-1 0.3'" : "") + "/>",
                  key));
    EXPECT_EQ((*load_of(split, "m")->value)(0.4), 0.0);
    const double act = 0.5 - 0.7 * std::exp(-2.0);
    EXPECT_NEAR((*load_of(split, "m_activation")->value)(0.4),
                9.0 * (kv == "1" ? std::min(act, 0.3) : act), 1e-13);
  }
  EXPECT_THAT(notes(cart("<position joint='p' timeconst='1'/>")),
              HasSubstr("activations of actuators are functions of time, as their controls are"));
  const Model ramp = read(cart("<intvelocity name='m' joint='p' kp='4' actrange='-1 0.6'/>", key));
  EXPECT_NEAR((*load_of(ramp, "m")->value)(0.4), -0.2 + 0.2, kRounding);
  EXPECT_NEAR((*load_of(ramp, "m")->value)(2.0), 0.6, kRounding);
}

// A force between -1 and 5 is one between -3 and 3 beside a constant one of 2.
TEST_F(Mjcf, BoundsOfForces) {
  const Model model =
      read(cart("<position name='m' joint='p' kp='8' forcerange='-1 5'/>", "ctrl='1'"));
  EXPECT_EQ(load_of(model, "m")->parameters.at("max_force"), 3.0);
  EXPECT_EQ((*load_of(model, "m")->value)(0.0), 1.0 - 2.0 / 8.0);
  EXPECT_EQ((*load_of(model, "m_middle")->value)(0.0), 2.0);
  const Model motor =
      read(cart("<motor name='m' joint='p' gear='-2' forcerange='-1 5'/>", "ctrl='9'"));
  EXPECT_EQ((*load_of(motor, "m")->value)(0.0), -10.0);
  EXPECT_THAT(fault(cart("<general joint='p' name='m' dyntype='integrator' actrange='0 1' "
                         "gainprm='2' biastype='affine' biasprm='0 -2 -1' forcerange='0 1'/>",
                         "ctrl='1'")),
              HasSubstr("the actuator 'm' is a servo whose activation and force are limited"));
}

// The axes of the site, turned with the body: x of the site is y of the world at the start.
TEST_F(Mjcf, MotorsOfSitesAreForcesAndMoments) {
  const Model model = read(cart("<motor name='m' site='s' gear='3 0 0 0 2 0'/>", "ctrl='2'"));
  const LoadSpec& force = *load_of(model, "m");
  EXPECT_TRUE(force.body_fixed);
  EXPECT_NEAR((force.Z_b - Vec3(1, 0, 0)).norm(), 0.0, kRounding);
  const auto at_start = [](const LoadSpec& load) {
    Vec3 v;
    for (std::size_t k = 0; k < 3; ++k) v[static_cast<int>(k)] = (*(*load.vector)[k])(0.0);
    return v;
  };
  EXPECT_NEAR((at_start(force) - Vec3(6, 0, 0)).norm(), 0.0, kRounding * 10.0);
  EXPECT_NEAR((at_start(*load_of(model, "m_moment")) - Vec3(0, 0, 4)).norm(), 0.0,
              kRounding * 10.0);
  const Model still =
      read(cart("<motor name='m' site='s' refsite='post' gear='3 0 0'/>", "ctrl='2'"));
  EXPECT_FALSE(load_of(still, "m")->body_fixed);
  EXPECT_THAT(fault(cart("<velocity name='m' site='s'/>")),
              HasSubstr("the actuator 'm' is a servo of a site"));
  EXPECT_THAT(fault(cart("<motor name='m' site='post' refsite='s'/>")),
              HasSubstr("acts between the sites 'post' and 's', which both may move"));
  EXPECT_THAT(notes(cart("<motor name='m' site='post'/>")),
              HasSubstr("the actuator 'm' acts on no body that moves"));
  EXPECT_THAT(fault(cart("<adhesion name='m' body='a'/>")),
              HasSubstr("the actuator 'm' pulls a body to what it touches"));
  EXPECT_THAT(fault(cart("<motor name='m'/>")),
              HasSubstr("the actuator 'm' does not act on a joint, tendon or site"));
}

TEST_F(Mjcf, MotorsOfBallAndFreeJointsAreForcesAndMoments) {
  const auto model = [&](const std::string& actuator) {
    return "<worldbody><body name='p' euler='90 0 0'><body name='b'><joint name='ball' "
           "type='ball'/>" +
           kBall + "<body name='c'><joint name='inner' type='ball'/>" + kBall +
           "</body></body></body><body name='d'><freejoint name='free'/>" + kBall +
           "</body></worldbody><actuator><" + actuator + "/></actuator><keyframe><key ctrl='2'/>" +
           "</keyframe>";
  };
  const auto vector = [&](const std::string& actuator, const std::string& name, bool own_axes) {
    const Model read_model = read(model(actuator));
    const LoadSpec* load = load_of(read_model, name);
    if (load == nullptr) return Vec3(Vec3::Constant(1e9));
    EXPECT_EQ(load->body_fixed, own_axes);
    Vec3 value;
    for (std::size_t k = 0; k < 3; ++k) value[static_cast<int>(k)] = (*(*load->vector)[k])(0.0);
    return value;
  };
  const std::string free = "motor name='m' joint='free' gear='1 2 3 4 5 6'";
  EXPECT_EQ(vector(free, "m", false), Vec3(2, 4, 6));
  EXPECT_EQ(vector(free, "m_2", true), Vec3(8, 10, 12));
  EXPECT_EQ(vector("motor name='m' jointinparent='free' gear='1 2 3 4 5 6'", "m_moment", false),
            Vec3(8, 10, 12));
  EXPECT_EQ(vector("motor name='m' joint='ball' gear='1 2 3'", "m", true), Vec3(2, 4, 6));
  // About the parent's axes, which are turned by 90 degrees about x: (x, y, z) is (x, -z, y).
  EXPECT_LT(
      (vector("motor name='m' jointinparent='ball' gear='1 2 3'", "m", false) - Vec3(2, -6, 4))
          .norm(),
      kRounding);
  EXPECT_THAT(fault(model("motor name='m' joint='inner'")),
              HasSubstr("the actuator 'm' turns the ball 'inner' between two bodies that move"));
  EXPECT_THAT(fault(model("position name='m' joint='ball'")),
              HasSubstr("the actuator 'm' is a servo of 'ball', which has several coordinates"));
}

// x_1 + x_2 = x with a spring, beside the same of one cart with twice the stiffness: both carts
// move together, and 2 x'' = -k (2 x) - d (2 x').
TEST_F(Mjcf, SpringsOfSumsOfCoordinates) {
  const Model model = read(sum_of_carts("stiffness='9' damping='2'", kMoving));
  const double w = std::sqrt(9.0 - 1.0);
  for (const double step : {0.02, 0.002, 0.0002})
    EXPECT_NEAR(moved(model, "q", step, 0.6), std::exp(-0.6) * std::sin(0.6 * w) / w,
                2.0 * step * step + 1e-9)
        << step;
  EXPECT_NEAR(Simulation(model).joint("t_length").rates[0], 2.0, 1e-12);
  EXPECT_THAT(notes(sum_of_carts("stiffness='9'")),
              HasSubstr("the length of the tendon 't' is the displacement of 't_length', which has "
                        "1e-10 of the inertia of its joints"));
  EXPECT_THAT(fault(sum_of_carts("stiffness='9'"), {"import.start.t_length=1"}),
              HasSubstr("is the length of a tendon, which follows from its joints"));
}

TEST_F(Mjcf, StopsFrictionAndInertiaOfSumsOfCoordinates) {
  for (const double step : {0.02, 0.002, 0.0002}) {
    // Each cart stops where the sum is 0.5, within the band of the stop; as a row at that place.
    Model stops = read(sum_of_carts("range='-1 0.5'", kMoving));
    EXPECT_NEAR(moved(stops, "p", step, 0.6), 0.25, 2.0 * step + 1e-3) << step;
    stops.contacts.present = true;
    stops.contacts.standard.potential = "rigid";
    EXPECT_NEAR(moved(stops, "p", step, 0.6), 0.25, 1e-9) << step;
    // A friction of 2 N decelerates each cart of 2 kg by 1 m/s².
    EXPECT_NEAR(moved(read(sum_of_carts("frictionloss='2'", kMoving)), "p", step, 0.6),
                0.6 - 0.5 * 0.36, 2.0 * step * step + 1e-6)
        << step;
    // An inertia of 1 kg of the sum: 3 x_1'' + x_2'' = 8, x_1'' + 3 x_2'' = 0.
    EXPECT_NEAR(moved(read(sum_of_carts("armature='1'",
                                        "<actuator><motor name='m' joint='p'/></actuator>"
                                        "<keyframe><key ctrl='8'/></keyframe>")),
                      "p", step, 0.6),
                0.5 * 3.0 * 0.36, 1e-8)
        << step;
  }
}

// A string of 2.5 m from (-2, 0, 0) holds the cart at x = 0.5.
TEST_F(Mjcf, LimitsOfTwoSitesAreThoseOfTheirDistance) {
  const Model model = read(
      "<option gravity='0 0 0'/><worldbody><site name='a' pos='-2 0 0'/><body><joint name='x' "
      "type='slide' axis='1 0 0'/>" +
      kBall +
      "<site name='c'/></body></worldbody><tendon><spatial name='t' range='0 2.5'><site "
      "site='a'/><site site='c'/></spatial></tendon><keyframe><key qvel='1'/></keyframe>");
  for (const double step : {0.02, 0.002, 0.0002}) {
    EXPECT_NEAR(moved(model, "x", step, 0.4), 0.4, 1e-10) << step;
    EXPECT_NEAR(moved(model, "x", step, 0.8), 0.5, 2.0 * step + 5e-3) << step;
  }
}

// The weight of 2 kg along the slide, of which a force holds a quarter.
TEST_F(Mjcf, GravityIsCompensatedInPart) {
  const Model model = read(
      "<option gravity='0 0 -10'/><worldbody><body gravcomp='0.25'><joint name='z' type='slide'/>" +
      kBall + "</body></worldbody>");
  for (const double step : {0.02, 0.002, 0.0002})
    EXPECT_NEAR(moved(model, "z", step, 0.4), -0.5 * 7.5 * 0.16, 1e-11) << step;
}

// A ball of radius r has the inertia of a cube of the edge 2 sqrt(3/5) r. Sliding against its
// resistance, v' = -c v - d v², it is at ln(1 + d v_0 (1 - exp(-c t))/c)/d.
TEST_F(Mjcf, AMediumResistsByBoxes) {
  const std::string body =
      "<worldbody><body name='a'><joint name='z' type='slide'/><geom size='0.2' mass='2'/></body>"
      "</worldbody><keyframe><key qvel='3'/></keyframe>";
  const std::string medium = "<option gravity='0 0 0' density='90' viscosity='0.4'/>";
  const Model model = read(medium + body);
  const double edge = 0.4 * std::sqrt(0.6), c = 3.0 * kPi * edge * 0.4 / 2.0;
  const double d = 0.5 * 90.0 * edge * edge / 2.0;
  for (const double step : {0.02, 0.002, 0.0002})
    EXPECT_NEAR(moved(model, "z", step, 0.4),
                std::log1p(d * 3.0 * (1.0 - std::exp(-0.4 * c)) / c) / d, 40.0 * step * step)
        << step;
  EXPECT_THAT(fault("<option density='1' wind='1 0 0'/>" + body),
              HasSubstr("the medium moves with a wind"));
  EXPECT_THAT(fault("<option density='1'/><worldbody><body><joint/><geom size='1' "
                    "fluidshape='ellipsoid'/></body></worldbody>"),
              HasSubstr("a medium flows around a <geom> as around an ellipsoid"));
}

const std::string kTouching = R"(
<worldbody>
  <geom name="floor" type="plane" size="1 1 1"/>
  <body name="a" pos="0 0 1"><freejoint/><geom name="g" size="0.1" contype="2" conaffinity="1"/></body>
  <body name="b" pos="0 0 2"><freejoint/><geom name="h" size="0.1" contype="0" conaffinity="0"/></body>
  <body name="c" pos="0 0 3"><freejoint/><geom size="0.1" contype="4" conaffinity="2"/></body>
  <body name="d" pos="0 0 4"><freejoint/><inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/></body>
</worldbody>
<contact>
  <exclude body1="world" body2="a"/><exclude body1="d" body2="a"/>
  <pair name="both" geom1="floor" geom2="h" condim="6" friction="0.4 0.4 0.02 0.001"/>
</contact>)";

class MjcfContact : public Mjcf {
 protected:
  Model read_with_contacts(const std::string& more = "") {
    write("robot.xml", "<mujoco>" + kTouching + more + "</mujoco>");
    return io::read_model(write(
        "model.yaml", "format: 1\nimport: {file: robot.xml, shapes: collision}\ncontacts: {}\n"));
  }
};

TEST_F(MjcfContact, PairsAndExclusionsActInModelsWithContacts) {
  const Model model = read_with_contacts();
  ASSERT_EQ(model.contacts.excluded.size(), 1U);
  EXPECT_EQ(model.contacts.excluded[0][0].index, model.body_index("world"));
  EXPECT_EQ(model.contacts.excluded[0][1].index, model.body_index("a"));
  ASSERT_EQ(model.contacts.pairs.size(), 1U);
  EXPECT_EQ(model.contacts.pairs[0].name, "both");
  EXPECT_EQ(model.contacts.pairs[0].law.friction, 0.4);
  EXPECT_EQ(model.contacts.pairs[0].law.torsion, 0.02);
  EXPECT_EQ(model.contacts.pairs[0].law.rolling, 0.001);
  const auto side = [&](const char* body) {
    return model.bodies.at(static_cast<std::size_t>(model.body_index(body))).shapes.at(0).contact;
  };
  const auto touch = [&](const char* one, const char* other) {
    const auto accepts = [](const ContactSideSpec& x, const ContactSideSpec& y) {
      for (const std::string& group : *y.groups)
        for (const std::string& met : *x.meets)
          if (group == met) return true;
      return false;
    };
    return accepts(side(one), side(other)) && accepts(side(other), side(one));
  };
  EXPECT_TRUE(touch("world", "a"));  // A bit of the floor's first number is in a's second.
  EXPECT_TRUE(touch("world", "b"));  // The pair.
  EXPECT_TRUE(touch("a", "c"));
  EXPECT_FALSE(touch("world", "c"));
  EXPECT_FALSE(touch("a", "b"));
  EXPECT_FALSE(touch("c", "c"));
  EXPECT_THAT(notes(kTouching), HasSubstr("<contact> acts where the model has 'contacts'"));
  EXPECT_EQ(read(kTouching).contacts.present, false);
}

// The larger coefficient of two geoms holds, unless the model has one of its own.
TEST_F(MjcfContact, FrictionOfGeomsIsThatOfContact) {
  const auto with = [&](const std::string& second, const std::string& contacts) {
    write("robot.xml",
          "<mujoco><worldbody><geom type='plane' size='1 1 1'/><body name='a' pos='0 0 1'>"
          "<freejoint/><geom size='0.1' friction='0.7'/></body><body name='b' pos='0 0 2'>"
          "<freejoint/><geom size='0.1' " +
              second + "/></body></worldbody></mujoco>");
    return io::read_model(
        write("model.yaml", "format: 1\nimport: {file: robot.xml}\ncontacts: " + contacts + "\n"));
  };
  const Model model = with("friction='0.2'", "{}");
  EXPECT_EQ(model.contacts.friction, Combination::maximum);
  const auto friction = [](const Model& m, const char* body) {
    const auto& shape = m.bodies.at(static_cast<std::size_t>(m.body_index(body))).shapes.at(0);
    for (const ContactMaterialSpec& material : m.contacts.materials)
      if (material.name == shape.contact.material) return material.friction;
    return m.contacts.standard.friction;
  };
  EXPECT_EQ(friction(model, "world"), 1.0);
  EXPECT_EQ(friction(model, "a"), 0.7);
  EXPECT_EQ(friction(model, "b"), 0.2);
  EXPECT_EQ(friction(with("condim='1'", "{}"), "b"), 0.0);
  const Model own = with("friction='0.2'", "{default: {friction: 0.4}}");
  EXPECT_EQ(friction(own, "world"), 0.4);
  EXPECT_EQ(friction(own, "a"), 0.4);
  const Model one = read_with_contacts();
  EXPECT_EQ(one.contacts.standard.friction, 1.0);
  EXPECT_TRUE(one.contacts.materials.empty());
}

// A body with two joints, and one welded to it, do not touch their parent; those above it do.
TEST_F(MjcfContact, RelativesDoNotTouch) {
  const std::string geom = "<geom size='0.3'/>";
  write("robot.xml", "<mujoco><worldbody><body name='a'><joint axis='1 0 0'/>" + geom +
                         "<body name='b' pos='0 0 1'><joint axis='1 0 0'/><joint axis='0 1 0'/>" +
                         geom + "<body name='c' pos='0 0 1'>" + geom +
                         "<body name='d' pos='0 0 1'><joint/>" + geom +
                         "</body></body></body></body></worldbody></mujoco>");
  const Model model =
      io::read_model(write("model.yaml", "format: 1\nimport: {file: robot.xml}\ncontacts: {}\n"));
  const auto excluded = [&](const char* one, const char* other) {
    const Side a = model.body_index(one), b = model.body_index(other);
    for (const auto& pair : model.contacts.excluded)
      if ((pair[0] == a && pair[1] == b) || (pair[0] == b && pair[1] == a)) return true;
    return false;
  };
  EXPECT_TRUE(excluded("a", "b"));
  EXPECT_TRUE(excluded("a", "c"));
  EXPECT_TRUE(excluded("b", "d"));
  EXPECT_FALSE(excluded("a", "d"));
  EXPECT_EQ(model.contacts.excluded.size(), 3U);  // Others have a joint between them.
}

TEST_F(MjcfContact, FaultsOfContactsAreNamed) {
  const auto message = [&](const std::string& more) {
    try {
      static_cast<void>(read_with_contacts("<contact>" + more + "</contact>"));
    } catch (const io::ModelErrors& errors) {
      return errors.text();
    }
    return std::string("none");
  };
  EXPECT_THAT(message("<exclude body1='a' body2='z'/>"), HasSubstr("there is no body 'z'"));
  EXPECT_THAT(message("<pair geom1='g' geom2='z'/>"), HasSubstr("there is no geom 'z'"));
}

// A joint of a loop that the file closes outside of its limits has none.
TEST_F(Mjcf, ALoopIsClosedWhereJointsAreOutsideTheirLimits) {
  const std::string text =
      "<worldbody><body name='a'><joint name='p' type='slide' range='0.1 1'/>" + kBall +
      "</body></worldbody><equality><weld body1='a'/></equality>";
  EXPECT_THAT(notes(text), HasSubstr("the joint 'p' has no stops, as its loop is closed where it"));
  EXPECT_EQ(Simulation(read(text)).joint("p").coordinates[0], 0.0);
}

TEST_F(Mjcf, ServosOfLinesThatCannotBeReadAreNamed) {
  const auto line = [&](const std::string& actuator) {
    return fault(
        "<worldbody><site name='u' pos='0 0 3'/><body name='a'><joint type='slide'/>" + kBall +
        "<site name='s'/></body></worldbody><tendon><spatial name='t'><site site='u'/><site "
        "site='s'/></spatial></tendon><actuator>" +
        actuator + "</actuator>");
  };
  EXPECT_THAT(line("<position name='m' tendon='t' forcerange='0 1'/>"),
              HasSubstr("the actuator 'm' is a servo of the length of 't' with a 'forcerange'"));
  EXPECT_THAT(line("<position name='m' tendon='t' dampratio='1'/>"),
              HasSubstr("the actuator 'm' has a damping ratio along the tendon 't'"));
  EXPECT_THAT(line("<cylinder name='m' tendon='t' timeconst='0'/>"), HasSubstr("none"));
  EXPECT_THAT(line("<general name='m' tendon='t' dyntype='filter' dynprm='0'/>"),
              HasSubstr("the time constant of 'm' is 0"));
}

}  // namespace
}  // namespace polhode::mjcf_tests
