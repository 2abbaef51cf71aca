// SPDX-License-Identifier: Apache-2.0
// Robots' files on the command line.
#include <gmock/gmock.h>

#include "command_line.hpp"

namespace polhode::import_cli_tests {
namespace {

using testing::HasSubstr;
using testing::Not;

constexpr const char* kRobot = R"(<robot name="arm">
  <link name="base"/>
  <link name="arm">
    <inertial><origin xyz="0.3 0 0"/><mass value="2"/><inertia ixx="0.01" iyy="0.02" izz="0.02"/></inertial>
    <visual><geometry><box size="0.1 0.1 0.1"/></geometry></visual>
  </link>
  <joint name="turn" type="revolute"><parent link="base"/><child link="arm"/>
    <axis xyz="0 1 0"/><limit lower="0" upper="2" effort="1"/></joint>
</robot>
)";

class Robot : public test::CommandLine {
 protected:
  Robot() { write("arm.urdf", kRobot); }
};

TEST_F(Robot, IsReportedAndItsLimitAtTheStartIsNoWarning) {
  const auto report = run({"import", "arm.urdf", "--json"});
  ASSERT_EQ(report.code, 0) << report.err;
  EXPECT_EQ(value(report.out, "mass"), "2.0");
  EXPECT_EQ(value(report.out, "freedoms"), "1");
  EXPECT_EQ(value(report.out, "loops"), "0");
  EXPECT_THAT(report.out, HasSubstr("attribute 'effort' of <limit>"));
  EXPECT_THAT(run({"import", "arm.urdf", "--report"}).out, HasSubstr("freedoms"));
  EXPECT_THAT(run({"import", "arm.urdf", "--floating"}).err,
              HasSubstr("the link 'base' has no mass. Give it, or let the base be fixed."));
  const auto check = run({"check", "arm.urdf", "--json"});
  ASSERT_EQ(check.code, 0) << check.err;
  EXPECT_THAT(check.out, HasSubstr("\"warnings\": []"));
  EXPECT_THAT(run({"import", "model.yaml"}).err, HasSubstr("imports nothing"));
}

TEST_F(Robot, IsConvertedToAModelWithTheSameResults) {
  ASSERT_EQ(run({"convert", "arm.urdf", "arm.yaml"}).code, 0);
  const auto direct =
      run({"run", "arm.urdf", "--json", "--quiet", "--set", "analysis.duration=0.1 s"});
  const auto converted =
      run({"run", "arm.yaml", "--json", "--quiet", "-o", "c", "--set", "analysis.duration=0.1 s"});
  ASSERT_EQ(direct.code, 0) << direct.err;
  ASSERT_EQ(converted.code, 0) << converted.err;
  EXPECT_EQ(value(direct.out, "result_hash"), value(converted.out, "result_hash"));
  EXPECT_EQ(run({"convert", "arm.urdf", "arm.csv"}).code, 2);
  // Results contain the converted model.
  EXPECT_EQ(run({"view", "arm.results", "--html", "page.html", "--quiet"}).code, 0);
  EXPECT_THAT(read("page.html"), HasSubstr("position_of"));
}

TEST_F(Robot, AWorldOfGazeboIsOneToo) {
  write("hall.world",
        "<sdf version='1.10'><world name='hall'><model name='m'><link name='a'><inertial><mass>2"
        "</mass></inertial><sensor/></link><joint name='j' type='revolute'><parent>world</parent>"
        "<child>a</child><axis><xyz>0 1 0</xyz></axis></joint></model></world></sdf>");
  const auto report = run({"import", "hall.world", "--json"});
  ASSERT_EQ(report.code, 0) << report.err;
  EXPECT_EQ(value(report.out, "format"), "\"SDFormat\"");
  EXPECT_EQ(value(report.out, "freedoms"), "1");
  EXPECT_THAT(report.out, HasSubstr("<sensor> in <link> has no influence on the motion"));
  EXPECT_EQ(run({"convert", "hall.world", "hall.yaml"}).code, 0);
  EXPECT_EQ(run({"check", "hall.yaml"}).code, 0);
}

TEST_F(Robot, FaultsAreThoseOfItsLines) {
  write("bad.urdf",
        "<robot name='r'>\n  <link name='a'/>\n  <joint name='j' type='fixed'>\n    <parent "
        "link='a'/><child link='b'/></joint></robot>\n");
  const auto bad = run({"check", "bad.urdf"});
  EXPECT_EQ(bad.code, 3);
  EXPECT_THAT(bad.err, HasSubstr("bad.urdf:3:3: error: there is no link 'b'"));
  EXPECT_EQ(run({"check", "none.urdf"}).code, 5);
  write("x.xacro", "<robot/>");
  EXPECT_THAT(run({"check", "x.xacro"}).err, Not(HasSubstr("internal")));
}

}  // namespace
}  // namespace polhode::import_cli_tests
