// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>

#include <polhode/model/whole_mass.hpp>

#include <io/importers/sdf_fixture.hpp>

namespace polhode::sdf_tests {
namespace {

using testing::HasSubstr;
using testing::Not;

class Sdf : public SdfFixture {};

// A frame attached to a link that is turned by 90 degrees, a link relative to it, and a joint whose
// pose is in its child.
TEST_F(Sdf, PosesAreRelativeToTheFramesTheyName) {
  const Model m = read(
      link("base", pose("1 0 0 0 0 1.5707963267948966")) +
      "<frame name='mark' attached_to='base'><pose degrees='true'>0 2 0 90 0 0</pose></frame>" +
      link("arm", pose("0 0 3 0 0 0", "mark")) +
      link("hand", "<pose relative_to='arm' rotation_format='quat_xyzw'>0 0 1 0 0 2 0</pose>") +
      joint("j", "fixed", "world", "base") +
      joint("k", "revolute", "base", "arm", pose("0 0 -3 0 0 0") + axis("0 0 1")) +
      joint("l", "fixed", "arm", "hand"));
  // y of the base is -x of the world, and z of the mark is -y of the base.
  EXPECT_NEAR((body(m, "arm").position - Vec3(1 - 2 + 3, 0, 0)).norm(), 0.0, kRounding);
  EXPECT_NEAR((body(m, "hand").position - Vec3(3, 0, 0)).norm(), 0.0, kRounding);
  const Mat3 hand = body(m, "hand").orientation.toRotationMatrix();
  const Mat3 arm = body(m, "arm").orientation.toRotationMatrix();
  EXPECT_NEAR((hand - arm * Vec3(-1, -1, 1).asDiagonal()).norm(), 0.0, 4 * kRounding);
  EXPECT_EQ(freedoms(m), 1);
  EXPECT_EQ(m.gravity, Vec3(0, 0, -9.81));
}

TEST_F(Sdf, InertiasHaveAPoseAndStandardValues) {
  const Model m =
      read(link("a", "",
                "<inertial><pose>0 0 1 0 0 1.5707963267948966</pose><mass>2</mass><inertia>"
                "<ixx>0.3</ixx><iyy>0.2</iyy><izz>0.4</izz><ixy>0.01</ixy></inertia></inertial>") +
           link("b", "", ""));
  EXPECT_EQ(body(m, "a").mass, 2.0);
  EXPECT_NEAR(body(m, "a").inertia(0, 0), 0.2, kRounding);
  EXPECT_NEAR(body(m, "a").inertia(0, 1), -0.01, kRounding);
  EXPECT_EQ(body(m, "b").mass, 1.0);
  EXPECT_EQ(body(m, "b").inertia, Mat3::Identity());
  EXPECT_THAT(notes(link("b", "", "")), HasSubstr("the link 'b' has no <inertial>: 1 kg"));
}

// A box of water with a ball of lead on it.
TEST_F(Sdf, AutomaticInertiasFollowFromCollisions) {
  const std::string inside =
      "<collision name='c'><geometry><box><size>0.1 0.2 0.3</size></box></geometry></collision>"
      "<collision name='d'><pose>0 0 0.25 0 0 0</pose><density>11340</density>"
      "<geometry><sphere><radius>0.1</radius></sphere></geometry></collision>";
  const BodySpec b = body(read(link("a", inside, "<inertial auto='true'/>")), "a");
  const double box = 1000 * 0.006, ball = 11340 * 4.0 / 3.0 * std::numbers::pi * 1e-3;
  EXPECT_NEAR(b.mass, box + ball, 1e-13 * (box + ball));
  EXPECT_NEAR(b.com.z(), 0.25 * ball / (box + ball), 1e-13);
  EXPECT_THAT(fault(link("a",
                         "<collision name='c'><geometry><mesh><uri>a.stl</uri></mesh></geometry>"
                         "</collision>",
                         "<inertial auto='true'/>")),
              HasSubstr("the mass of 'a' cannot be computed from this collision"));
}

TEST_F(Sdf, NestedModelsHaveScopedNames) {
  const Model m = read("<model name='in'><pose>0 0 1 0 0 0</pose>" +
                       link("a", pose("1 0 0 0 0 0")) + link("b", pose("0 1 0 0 0 0", "a")) +
                       "</model>" + link("c", pose("0 0 1 0 0 0", "in::a")) +
                       joint("j", "fixed", "c", "in::b") + joint("k", "ball", "c", "in"));
  EXPECT_NEAR((body(m, "in__b").position - Vec3(1, 1, 1)).norm(), 0.0, kRounding);
  EXPECT_NEAR((body(m, "c").position - Vec3(1, 0, 2)).norm(), 0.0, kRounding);
  EXPECT_EQ(freedoms(m), 18 - 6 - 3);
}

TEST_F(Sdf, PlacementFrameIsWhereThePoseSays) {
  const Model m =
      read_text(sdf("<world name='w'><model name='m' placement_frame='tip'>"
                    "<pose>5 0 0 0 0 0</pose>" +
                    link("a") +
                    "<frame name='tip' attached_to='a'>"
                    "<pose>0 0 1 0 1.5707963267948966 0</pose></frame></model></world>"));
  // The tip is at (5, 0, 0) with the axes of the world: the link is turned by -90 degrees.
  EXPECT_NEAR((body(m, "m__a").position - Vec3(6, 0, 0)).norm(), 0.0, kRounding);
  EXPECT_EQ(m.title, "w");
  EXPECT_EQ(m.gravity, Vec3(0, 0, -9.8));
}

TEST_F(Sdf, IncludedModelsAreFoundNamedAndPlaced) {
  write("models/leg/model.config",
        "<model><sdf version='1.4'>old.sdf</sdf><sdf version='1.9'>leg.sdf</sdf></model>");
  write("models/leg/leg.sdf",
        sdf("<model name='leg'><pose>9 9 9 0 0 0</pose>" + link("shin") + "</model>"));
  write("near.sdf", sdf(model("foot", link("toe"))));
  const std::string world =
      "<world name='w'><gravity>0 0 -1.62</gravity>"
      "<include><uri>model://leg</uri><name>left</name><pose>0 1 0 0 0 0</pose></include>"
      "<include><uri>model://leg</uri><static>true</static></include>"
      "<include><uri>near.sdf</uri></include></world>";
  const Model m = read_text(sdf(world), {"import.package_paths=[models]"});
  EXPECT_EQ(m.gravity, Vec3(0, 0, -1.62));
  EXPECT_EQ(body(m, "left__shin").position, Vec3(0, 1, 0));
  EXPECT_EQ(body(m, "leg__shin").position, Vec3(9, 9, 9));
  EXPECT_TRUE(body(m, "leg__shin").fixed);
  EXPECT_FALSE(body(m, "foot__toe").fixed);
  EXPECT_THAT(text_fault(sdf(world)), HasSubstr("no SDFormat file 'model://leg' to include"));
}

TEST_F(Sdf, ErrorsOfIncludedFilesHaveTheirPlace) {
  write("part.sdf", sdf(model("part",
                              "<link name='a'>\n<inertial><mass>two</mass></inertial>\n"
                              "</link>")));
  const std::string said = fault("<include><uri>part.sdf</uri></include>");
  EXPECT_THAT(said, HasSubstr("part.sdf:4:"));
  EXPECT_THAT(said, HasSubstr("<mass> is 'two', not a number"));
  write("self.sdf", sdf(model("self", link("a") + "<include><uri>self.sdf</uri></include>")));
  EXPECT_THAT(fault("<include><uri>self.sdf</uri></include>"),
              HasSubstr("self.sdf' includes itself"));
  write("twice.sdf",
        sdf(model("twice", link("a") + "<include><uri>twice.sdf</uri><name>x</name></include>"
                                       "<include><uri>twice.sdf</uri><name>y</name></include>")));
  EXPECT_THAT(fault("<include><uri>twice.sdf</uri></include>"),
              HasSubstr("twice.sdf' includes itself"));
  // Each includes the next one, or includes it twice.
  const auto chain = [&](int count, int times) {
    for (int k = 0; k <= count; ++k) {
      std::string inside = link("a");
      for (int i = 0; i < times; ++i)
        inside += format("<include><uri>c{}.sdf</uri><name>n{}</name></include>", k + 1, i);
      write(format("c{}.sdf", k), sdf(model("c", k < count ? inside : link("a"))));
    }
    return fault("<include><uri>c0.sdf</uri></include>");
  };
  EXPECT_EQ(chain(15, 1), "none");
  EXPECT_THAT(chain(25, 1), HasSubstr("files are included more than 20 deep"));
  EXPECT_THAT(chain(15, 2), HasSubstr("more than 2000 files are included"));
}

TEST_F(Sdf, MergedModelsBelongToTheOneAround) {
  const Model m =
      read("<model name='in' merge='true'><pose>0 0 1 0 0 0</pose>" + link("a") + "</model>" +
           link("b", pose("0 0 1 0 0 0", "a")) + joint("j", "revolute", "a", "b", axis("1 0 0")));
  EXPECT_EQ(body(m, "a").position, Vec3(0, 0, 1));
  EXPECT_EQ(body(m, "b").position, Vec3(0, 0, 2));
}

TEST_F(Sdf, StaticModelsAreFixedAndOthersFree) {
  const std::string inside =
      link("a") + link("b") + joint("j", "revolute", "a", "b", axis("1 0 0"));
  EXPECT_EQ(freedoms(read(inside)), 7);
  const Model m = read("<static>true</static>" + inside);
  EXPECT_TRUE(body(m, "a").fixed);
  EXPECT_TRUE(body(m, "b").fixed);
  EXPECT_THAT(fault(inside, {"import.base=floating"}),
              HasSubstr("says itself which models move freely"));
}

TEST_F(Sdf, ShapesHaveTheirSizes) {
  const std::string shapes =
      "<visual name='a'><geometry><cylinder><radius>0.1</radius><length>0.5</length></cylinder>"
      "</geometry></visual><visual name='b'><pose>1 0 0 0 0 0</pose><geometry><capsule><radius>0.1"
      "</radius><length>0.5</length></capsule></geometry></visual><visual name='c'><geometry>"
      "<ellipsoid><radii>0.1 0.2 0.3</radii></ellipsoid></geometry></visual>"
      "<visual name='d'><geometry><heightmap><uri>x</uri></heightmap></geometry></visual>"
      "<collision name='e'><surface><friction/></surface><geometry><box><size>1 2 3</size></box>"
      "</geometry></collision>";
  EXPECT_EQ(body(read(link("a", shapes)), "a").shapes.size(), 3U);
  EXPECT_EQ(body(read(link("a", shapes), {"import.shapes=collision"}), "a").shapes.size(), 1U);
  const std::string said = notes(link("a", shapes));
  EXPECT_THAT(said, HasSubstr("<heightmap> in <geometry> is not read"));
  EXPECT_THAT(said, HasSubstr("<surface> in <collision> has no influence on the motion"));
}

TEST_F(Sdf, PlanesAreThoseOfFixedBodies) {
  const std::string plane =
      "<collision name='c'><geometry><plane><normal>0 1 0</normal></plane></geometry></collision>";
  const std::string inside = link("a", pose("0 0 2 1.5707963267948966 0 0") + plane);
  const BodySpec a = body(read("<static>1</static>" + inside, {"import.shapes=collision"}), "a");
  EXPECT_EQ(a.shapes.size(), 1U);
  EXPECT_TRUE(body(read(inside), "a").shapes.empty());
  EXPECT_THAT(notes(inside), HasSubstr("a plane on a body that moves is not read"));
}

TEST_F(Sdf, WhatIsNotReadIsListed) {
  const std::string said =
      notes(link("a", "<sensor name='s' type='imu'/><colour/>") + "<plugin name='p'/><plugin/>");
  EXPECT_THAT(said, HasSubstr("<sensor> in <link> has no influence on the motion"));
  EXPECT_THAT(said, HasSubstr("<plugin> in <model> has no influence on the motion (2 times)"));
  EXPECT_THAT(said, HasSubstr("<colour> in <link> is unknown"));
}

TEST_F(Sdf, BrokenFilesAreRefusedWithTheirLine) {
  EXPECT_THAT(text_fault("<robot/>"), HasSubstr("the file's tag is <robot>, not <sdf>"));
  EXPECT_THAT(text_fault("<sdf/>"), HasSubstr("<sdf> has no 'version'"));
  EXPECT_THAT(text_fault(sdf("", "1.2")), HasSubstr("the version '1.2' of SDFormat is not read"));
  EXPECT_THAT(text_fault(sdf("")), HasSubstr("the file has no link"));
  EXPECT_THAT(fault(link("a") + link("a")), HasSubstr("robot.sdf:4:1: error: the name 'a' stands"));
  EXPECT_THAT(fault(link("arm", pose("0 0 0 0 0 0", "amr"))),
              HasSubstr("there is no link or frame 'amr'"));
  EXPECT_THAT(fault(link("arm", pose("0 0 0 0 0 0", "amr"))), HasSubstr("Did you mean 'arm'?"));
  EXPECT_THAT(fault(link("a", pose("0 0 0 0 0 0", "b")) + link("b", pose("0 0 0 0 0 0", "a"))),
              HasSubstr("is relative to itself"));
  EXPECT_THAT(fault(link("a") +
                    "<frame name='f' attached_to='g'/><frame name='g' "
                    "attached_to='f'/>" +
                    joint("j", "fixed", "a", "f")),
              HasSubstr("the frame 'g' is attached to itself"));
  EXPECT_THAT(fault(link("a", "<pose>1 2 3</pose>")),
              HasSubstr("<pose> is '1 2 3', not 6 numbers"));
  EXPECT_THAT(fault(link("a") + link("b") + joint("j", "hinge", "a", "b")),
              HasSubstr("the joint 'j' has the unknown type 'hinge'"));
  EXPECT_THAT(fault(link("a") + joint("j", "fixed", "a", "b")),
              HasSubstr("there is no link or frame 'b'"));
  EXPECT_THAT(fault(link("a") + joint("j", "fixed", "a", "a")),
              HasSubstr("the joint 'j' connects 'a' with itself"));
  EXPECT_THAT(fault(link("a") + link("b") + joint("j", "revolute", "a", "b", axis("0 0 0"))),
              HasSubstr("the axis of 'j' has no length"));
  EXPECT_THAT(fault(link("a", "", "<inertial><pose relative_to='b'>1 0 0 0 0 0</pose></inertial>")),
              HasSubstr("the pose of the mass of 'a' is relative to 'b', not to its link"));
  EXPECT_THAT(fault(link("a") + link("b") + link("c") +
                    joint("u", "universal", "a", "b",
                          axis("1 0 0", "<dynamics><damping>1</damping></dynamics>") +
                              axis("0 1 0", "", "axis2")) +
                    joint("u_axis2", "fixed", "b", "c")),
              HasSubstr("the name 'u_axis2' is that of another joint too"));
  write("part.sdf", sdf(model("part", link("a"))));
  EXPECT_THAT(fault("<include><uri>part.sdf</uri><placement_frame>a</placement_frame></include>"),
              HasSubstr("<placement_frame> has no <pose> beside it"));
  EXPECT_THAT(fault(link("a", "<kinematic>1</kinematic>")), HasSubstr("the link 'a' is kinematic"));
  EXPECT_THAT(fault(link("a") + "<drake:joint name='x'/>"), HasSubstr("<drake:joint> is not read"));
  EXPECT_THAT(fault(link("a") + "<drake:joint name='x'/>", {"import.allow_partial=true"}),
              HasSubstr("none"));
}

TEST_F(Sdf, DirectionsHaveAnyLengthAndLinksAnyName) {
  const auto arm = [&](const std::string& direction, const std::string& turn) {
    return read(link("a") +
                link("u_cross", "<pose rotation_format='quat_xyzw'>0 0 0 " + turn + "</pose>") +
                joint("h", "revolute", "world", "a", axis(direction)) +
                joint("u", "universal", "a", "u_cross",
                      axis("1 0 0", "<dynamics><damping>1</damping></dynamics>") +
                          axis("0 1 0", "", "axis2")));
  };
  const Model one = arm("1 1 0", "0 0 1 1"), huge = arm("1e300 1e300 0", "0 0 1e300 1e300"),
              tiny = arm("1e-300 1e-300 0", "0 0 1e-300 1e-300");
  for (const Model* other : {&huge, &tiny}) {
    const State a = Simulation(one).state(), b = Simulation(*other).state();
    ASSERT_EQ(one.bodies.size(), other->bodies.size());
    for (std::size_t k = 0; k < one.bodies.size(); ++k)
      EXPECT_LT((one.bodies[k].position - other->bodies[k].position).norm(), kRounding);
    EXPECT_EQ(freedoms(one), freedoms(*other));
    EXPECT_EQ(freedoms(one), 3);
    EXPECT_EQ(a.blocks.size(), b.blocks.size());
  }
}

}  // namespace
}  // namespace polhode::sdf_tests
