// SPDX-License-Identifier: Apache-2.0
// Places of models that a simulator saved in the <state> of a world.
#include "sdf_fixture.hpp"

namespace polhode::sdf_state_tests {
namespace {

using namespace sdf_tests;

using testing::HasSubstr;

/// A world with a double pendulum, its links one below the other, and a state.
std::string world(const std::string& state, const std::string& more = "") {
  return sdf("<world name='w'><frame name='f'><pose>0 0 2 0 0 0.5</pose></frame>" +
             model("m", pose("1 0 0 0 0 0", "f") + link("a", pose("0 0 1 0 0 0")) +
                            link("b", pose("0 1 1 0 0 0")) +
                            joint("j", "revolute", "a", "b", axis("0 0 1"))) +
             more + "<state world_name='w'><sim_time>3 0</sim_time>" + state + "</state></world>");
}
std::string saved(const std::string& text, const std::string& inside = "") {
  return "<model name='m'><pose>" + text + "</pose><scale>1 1 1</scale>" + inside + "</model>";
}
std::string saved_link(const std::string& name, const std::string& text,
                       const std::string& inside = "") {
  return "<link name='" + name + "'><pose>" + text + "</pose>" + inside + "</link>";
}

class SdfWorldState : public SdfFixture {
 protected:
  std::string report(const std::string& text) {
    std::string list;
    for (const io::ImportNote& n : io::expanded_model(write("w.sdf", text)).report.notes)
      list += n.what + "\n";
    return list;
  }
};

TEST_F(SdfWorldState, MovesModelsAsAWhole) {
  const double half_pi = 0.5 * 3.14159265358979;
  const Model read = read_text(world(
      saved("5 6 7 0 0 1.570796326794895", saved_link("a", "5 6 8 0 0 1.570796326794895") +
                                               saved_link("b", "4 6 8 0 0 1.570796326794895"))));
  EXPECT_LT((body(read, "m__a").position - Vec3(5, 6, 8)).norm(), 1e-12);
  EXPECT_LT((body(read, "m__b").position - Vec3(4, 6, 8)).norm(), 1e-12);
  EXPECT_NEAR(Eigen::AngleAxisd(body(read, "m__a").orientation).angle(), half_pi, 1e-12);
  EXPECT_EQ(freedoms(read), 7);
  EXPECT_THAT(report(world(saved("5 6 7 0 0 0"))),
              HasSubstr("the model 'm' starts where the <state> has it"));
}

TEST_F(SdfWorldState, LeavesAModelThatHasNotMovedAsItIs) {
  const std::string at = "<pose>0.123456789 0 0 0 0 0</pose>";
  const auto x = [&](const std::string& state) {
    return body(read_text(sdf("<world name='w'>" + model("m", at + link("a")) +
                              "<state world_name='w'>" + state + "</state></world>")),
                "m__a")
        .position.x();
  };
  EXPECT_EQ(x(saved("0.123457 0 0 0 0 0")), 0.123456789);
  EXPECT_EQ(x(saved("0.1235 0 0 0 0 0")), 0.1235);
}

TEST_F(SdfWorldState, RefusesWhatChangesWithinModels) {
  EXPECT_THAT(text_fault(world(saved("5 6 7 0 0 0", saved_link("b", "5 6 8 0 0 0")))),
              HasSubstr("the <state> moves the link 'm::b' in its model"));
  EXPECT_THAT(
      text_fault(world(saved(
          "5 6 7 0 0 0", saved_link("a", "5 6 8 0 0 0", "<velocity>0 0 0.1 0 0 0</velocity>")))),
      HasSubstr("the link 'm::a' moves in the <state>"));
  EXPECT_THAT(text_fault(world(saved("5 6 7 0 0 0",
                                     "<joint name='j'><angle axis='0'>0.4</angle>"
                                     "</joint>"))),
              HasSubstr("the <state> moves a joint of 'm'"));
  EXPECT_THAT(text_fault(world("<model name='n'><pose>0 0 0 0 0 0</pose></model>")),
              HasSubstr("there is no link or frame 'n'"));
  EXPECT_THAT(text_fault(world("<deletions><name>m</name></deletions>")),
              HasSubstr("<deletions> of a <state> is not read"));
  EXPECT_THAT(text_fault(world(saved("5 6 7 0 0 0"),
                               joint("h", "revolute", "world", "m::a", axis("0 0 1")))),
              HasSubstr("the joint 'h' holds a model that the <state> moves"));
}

TEST_F(SdfWorldState, FramesThatAreRelativeToEachOtherAreErrors) {
  EXPECT_THAT(fault(link("a") + "<frame name='f'>" + pose("1 0 0 0 0 0", "g") +
                    "</frame><frame name='g'>" + pose("1 0 0 0 0 0", "f") + "</frame>"),
              HasSubstr("relative to itself"));
}

}  // namespace
}  // namespace polhode::sdf_state_tests
