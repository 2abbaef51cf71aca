// SPDX-License-Identifier: Apache-2.0
// Names of an MJCF that stand twice, or name nothing.
#include "mjcf_fixture.hpp"

namespace polhode::mjcf_names_tests {
namespace {

using namespace mjcf_tests;

class MjcfNames : public Mjcf {};

std::string bodies(const std::string& more = "") {
  return "<worldbody><body name='a'><joint name='j'/>" + kBall +
         "<site name='s'/><geom name='g' size='0.1'/>" + more + "</body></worldbody>";
}

TEST_F(MjcfNames, StandOnce) {
  EXPECT_EQ(fault(bodies()), "none");
  EXPECT_THAT(fault(bodies("<joint name='j' axis='1 0 0'/>")),
              HasSubstr("the joint 'j' stands twice"));
  EXPECT_THAT(fault(bodies("<site name='s'/>")), HasSubstr("the site 's' stands twice"));
  EXPECT_THAT(fault(bodies("<geom name='g' size='0.2'/>")), HasSubstr("the geom 'g' stands twice"));
  EXPECT_THAT(fault(bodies(kBall)), HasSubstr("the body 'a' has a second <inertial>"));
  // Names that are made for joints without one give way.
  EXPECT_EQ(fault("<worldbody><body name='a'><joint/>" + kBall +
                  "<body name='b' pos='1 0 0'><joint name='a_joint'/>" + kBall +
                  "</body></body></worldbody>"),
            "none");
}

TEST_F(MjcfNames, OfPairsAndExclusionsExistWithoutContactsToo) {
  for (const std::string contacts : {"", "contacts: {}\n"}) {
    const auto refused = [&](const std::string& inside) {
      write("robot.xml", "<mujoco>\n" + bodies() + inside + "</mujoco>\n");
      try {
        static_cast<void>(io::read_model(
            write("model.yaml", "format: 1\nimport: {file: robot.xml}\n" + contacts)));
      } catch (const io::ModelErrors& errors) {
        return errors.text();
      }
      return std::string("none");
    };
    EXPECT_THAT(refused("<contact><exclude body1='a' body2='aa'/></contact>"),
                HasSubstr("there is no body 'aa'. There are: a, world."));
    EXPECT_THAT(refused("<contact><pair geom1='g' geom2='h'/></contact>"),
                HasSubstr("there is no geom 'h'"));
  }
}

TEST_F(MjcfNames, OfSensorsExist) {
  EXPECT_THAT(fault(bodies() + "<sensor><jointpos joint='jj'/></sensor>"),
              HasSubstr("there is no joint 'jj'"));
  EXPECT_THAT(fault(bodies() + "<sensor><actuatorfrc actuator='m'/></sensor>"),
              HasSubstr("there is no actuator 'm'"));
  EXPECT_THAT(fault(bodies() + "<sensor><tendonpos tendon='t'/></sensor>"),
              HasSubstr("there is no tendon 't'"));
  EXPECT_EQ(fault(bodies() + "<actuator><motor name='m' joint='j'/></actuator>"
                             "<sensor><actuatorfrc actuator='m'/></sensor>"),
            "none");
}

TEST_F(MjcfNames, BitsOfContactsAreWhole) {
  EXPECT_THAT(body_fault("<body name='a'><joint/><geom size='1' contype='1.5'/></body>"),
              HasSubstr("'contype' of <geom> is 1.5"));
}

TEST_F(MjcfNames, MocapBodiesStartAtTheKeyframe) {
  const Model model = read(
      "<worldbody><body name='m' mocap='true' pos='1 0 0'><body name='c' pos='0 1 0'>"
      "<joint/>" +
      kBall + "</body></body></worldbody><keyframe><key mpos='0 0 3' mquat='0 1 0 0'/></keyframe>");
  // Half a turn about x.
  for (const BodySpec& b : model.bodies) {
    if (b.name == "c") {
      EXPECT_LT((b.position - Vec3(0, -1, 3)).norm(), kRounding);
    }
  }
  EXPECT_THAT(fault("<worldbody><body name='m' mocap='true'/></worldbody>"
                    "<keyframe><key mpos='0 0'/></keyframe>"),
              HasSubstr("'mpos' of <key> has 2 numbers, but the model 3"));
}

}  // namespace
}  // namespace polhode::mjcf_names_tests
