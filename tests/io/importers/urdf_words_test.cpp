// SPDX-License-Identifier: Apache-2.0
// Tags and attributes of a URDF that change the motion if they are not read.
#include <fstream>

#include <gmock/gmock.h>

#include <polhode/core/format.hpp>
#include <polhode/io/read/read_import.hpp>
#include <polhode/io/text/diagnostics.hpp>
#include <polhode/io/text/file_error.hpp>

#include <support/scratch.hpp>

namespace polhode::urdf_words_tests {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class UrdfWords : public testing::Test {
 protected:
  std::string write(const std::string& inside) {
    std::ofstream(folder_ / "robot.urdf")
        << "<robot name='r'><link name='base'/>" + inside + "</robot>";
    return folder_ / "robot.urdf";
  }
  std::string fault(const std::string& inside) {
    try {
      static_cast<void>(io::read_model(write(inside), {}));
    } catch (const io::ModelErrors& errors) {
      return errors.text();
    } catch (const io::FileError& error) {
      return error.what();
    }
    return "none";
  }
  /// Notes of a report, one a line.
  std::string notes(const std::string& inside) {
    std::string text;
    for (const io::ImportNote& n : io::expanded_model(write(inside)).report.notes)
      text += n.what + "\n";
    return text;
  }
  test::Scratch folder_;
};

std::string arm(const std::string& origin, const std::string& more = "",
                const std::string& in_link = "") {
  return "<link name='arm'><inertial><origin xyz='0 0 -0.5'/><mass value='2'/>"
         "<inertia ixx='0.3' iyy='0.3' izz='0.2'/></inertial>" +
         in_link +
         "</link><joint name='j' type='continuous'><parent link='base'/><child link='arm'/>"
         "<origin " +
         origin + "/><axis xyz='0 1 0'/>" + more + "</joint>";
}

TEST_F(UrdfWords, OriginsHaveQuaternions) {
  const auto turn = [&](const std::string& origin) {
    return io::read_model(write(arm(origin)), {}).bodies.back().orientation;
  };
  // One rotation by angles, by its quaternion, and by quaternions of other lengths.
  const Quat by_angles = turn("rpy='0.3 -0.4 1.1'");
  const Quat unit = by_angles.normalized();
  for (const double length : {1.0, 3.0, 1e-3})
    EXPECT_LT(turn(format("xyz='0 0 1' quat_xyzw='{} {} {} {}'", length * unit.x(),
                          length * unit.y(), length * unit.z(), length * unit.w()))
                  .angularDistance(by_angles),
              1e-15 * 10.0);
  EXPECT_THAT(fault(arm("rpy='0 0 0' quat_xyzw='0 0 0 1'")),
              HasSubstr("<origin> has both 'rpy' and 'quat_xyzw'"));
  EXPECT_THAT(fault(arm("quat_xyzw='0 0 0 0'")), HasSubstr("has no length"));
  EXPECT_THAT(fault(arm("quat_xyzw='0 0 1'")), HasSubstr("not 4 numbers"));
}

TEST_F(UrdfWords, TagsOfXacroAreNotLeftOut) {
  // With xacro its message, as there is no such file; without it that it is missing.
  EXPECT_THAT(fault("<xacro:include filename='no_such_file.xacro'/>" + arm("xyz='0 0 1'")),
              HasSubstr("xacro"));
  EXPECT_EQ(fault("<!-- <xacro:include filename='old.xacro'/> -->" + arm("xyz='0 0 1'")), "none");
}

TEST_F(UrdfWords, TagsThatStandTwiceAreErrors) {
  EXPECT_THAT(fault(arm("xyz='0 0 1'", "", "<inertial><mass value='9'/></inertial>")),
              HasSubstr("<inertial> stands twice in <link>"));
  EXPECT_THAT(fault(arm("xyz='0 0 1'", "<axis xyz='1 0 0'/>")),
              HasSubstr("<axis> stands twice in <joint>"));
}

TEST_F(UrdfWords, AHingeWithoutLimitsIsSaid) {
  std::string text = arm("xyz='0 0 1'");
  text.replace(text.find("continuous"), 10, "revolute");
  std::string notes;
  for (const io::ImportNote& n : io::expanded_model(write(text)).report.notes) notes += n.what;
  EXPECT_THAT(notes, HasSubstr("the joint 'j' has no <limit>, and no stops"));
}

// A box of no size stands for a link that has only a place.
TEST_F(UrdfWords, BoxesOfNoSizeAreNoShapes) {
  const auto box = [](const std::string& size) {
    return arm("xyz='0 0 1'", "",
               "<visual><geometry><box size='" + size + "'/></geometry></visual>");
  };
  EXPECT_TRUE(io::read_model(write(box("0 0 0")), {}).bodies.back().shapes.empty());
  EXPECT_THAT(notes(box("0 0 0")), HasSubstr("a <box> of the size 0 0 0 has no surface"));
  for (const char* size : {"0 0 1", "-1 1 1"})
    EXPECT_THAT(fault(box(size)), HasSubstr("must be three numbers above 0")) << size;
}

TEST_F(UrdfWords, ConstraintsWithoutAnAgreedMeaningAreRefused) {
  for (const std::string tag : {"constraint", "coupling"})
    EXPECT_THAT(fault(arm("xyz='0 0 1'") + "\n<" + tag + " name='c'/>"),
                AllOf(HasSubstr("robot.urdf:2:"),
                      HasSubstr("<" + tag + "> has no meaning that is agreed on")));
}

TEST_F(UrdfWords, LoopsThatStartOpenAreSaid) {
  const auto loop = [](const std::string& place) {
    return arm("xyz='0 0 1'") + "<loop_joint name='l' type='spherical'><link1 link='base' xyz='" +
           place + "'/><link2 link='arm' xyz='0 0 -1'/></loop_joint>";
  };
  EXPECT_THAT(notes(loop("0 0 0")), Not(HasSubstr("is open")));
  EXPECT_THAT(notes(loop("0.6 0 0.2")),
              HasSubstr("the loop of 'l' is open by 0.632 m where its joints start"));
}

}  // namespace
}  // namespace polhode::urdf_words_tests
