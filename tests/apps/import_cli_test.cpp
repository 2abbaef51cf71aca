// SPDX-License-Identifier: Apache-2.0
// Robots' files on the command line.
#include <cstdio>
#include <sstream>

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

// A block on a spring of 100 N/m: a force of 8 N that grows and goes back to its half.
TEST_F(Robot, AModelOfFebioIsOneTooAndItsStaticsIsAHistory) {
  write("spring.feb", R"(<febio_spec version="4.0"><Module type="solid"/>
<Control><analysis>STATIC</analysis><time_steps>20</time_steps><step_size>0.1</step_size></Control>
<Material><material id="1" name="base" type="rigid body"><center_of_mass>0,0,0</center_of_mass></material>
<material id="2" name="bar" type="rigid body"><density>1000</density></material></Material>
<Mesh><Nodes><node id="1">0,0,0</node><node id="2">1,0,0</node><node id="3">0,1,0</node><node id="4">0,0,1</node></Nodes>
<Elements type="tet4" name="p"><elem id="1">1,2,3,4</elem></Elements></Mesh>
<MeshDomains><SolidDomain name="p" mat="bar"/></MeshDomains>
<Rigid><rigid_bc type="rigid_fixed"><rb>base</rb><Rx_dof>1</Rx_dof><Ry_dof>1</Ry_dof><Rz_dof>1</Rz_dof><Ru_dof>1</Ru_dof><Rv_dof>1</Rv_dof><Rw_dof>1</Rw_dof></rigid_bc>
<rigid_bc type="rigid_fixed"><rb>bar</rb><Rx_dof>1</Rx_dof><Ry_dof>1</Ry_dof><Ru_dof>1</Ru_dof><Rv_dof>1</Rv_dof><Rw_dof>1</Rw_dof></rigid_bc>
<rigid_load type="rigid_force"><rb>bar</rb><dof>Rz</dof><value lc="1">8</value></rigid_load>
<rigid_connector name="k" type="rigid spring"><body_a>base</body_a><body_b>bar</body_b><k>100</k><insertion_a>0.25,0.25,-1</insertion_a><insertion_b>0.25,0.25,0.25</insertion_b></rigid_connector></Rigid>
<LoadData><load_controller id="1" type="loadcurve"><points><pt>0,0</pt><pt>1,1</pt><pt>2,0.5</pt></points></load_controller></LoadData>
</febio_spec>
)");
  write("spring.overlay.yaml", "format: 1\noutput: {probes: {bar: {body: bar}}}\n");
  const auto report = run({"import", "spring.feb", "--json"});
  ASSERT_EQ(report.code, 0) << report.err;
  EXPECT_EQ(value(report.out, "format"), "\"FEBio\"");
  EXPECT_EQ(value(report.out, "freedoms"), "1");
  const auto direct = run({"run", "spring.feb", "--json", "--quiet"});
  ASSERT_EQ(direct.code, 0) << direct.err;
  ASSERT_EQ(run({"convert", "spring.feb", "spring.yaml"}).code, 0);
  const auto converted = run({"run", "spring.yaml", "--json", "--quiet", "-o", "c"});
  ASSERT_EQ(converted.code, 0) << converted.err;
  EXPECT_EQ(value(direct.out, "result_hash"), value(converted.out, "result_hash"));
  std::istringstream rows(read("c/probes/bar.csv"));
  std::string row;
  int halves = 0;
  while (std::getline(rows, row)) {
    double t = 0, x = 0, y = 0, z = 0;
    if (std::sscanf(row.c_str(), "%lf,%lf,%lf,%lf", &t, &x, &y, &z) != 4) continue;
    EXPECT_NEAR(z - 0.25, 0.08 * (t <= 1 ? t : 1.5 - t / 2), 1e-9) << row;
    ++halves;
  }
  EXPECT_GE(halves, 20);
}

// A block of 2 x 1 x 1 m and 1000 kg/m^3.
TEST_F(Robot, TotalsOfTissueAreThoseOfItsSolids) {
  write("tissue.feb", R"(<febio_spec version="4.0">
<Control><analysis>DYNAMIC</analysis><time_steps>10</time_steps><step_size>0.1</step_size></Control>
<Material><material id="1" name="m" type="neo-Hookean"><density>1000</density><E>1e6</E><v>0.3</v></material></Material>
<Mesh><Nodes><node id="1">0,0,0</node><node id="2">2,0,0</node><node id="3">2,1,0</node><node id="4">0,1,0</node>
<node id="5">0,0,1</node><node id="6">2,0,1</node><node id="7">2,1,1</node><node id="8">0,1,1</node></Nodes>
<Elements type="hex8" name="part"><elem id="1">1,2,3,4,5,6,7,8</elem></Elements></Mesh>
<MeshDomains><SolidDomain name="part" mat="m"/></MeshDomains>
</febio_spec>
)");
  const auto report = run({"import", "tissue.feb", "--json"});
  ASSERT_EQ(report.code, 0) << report.err;
  EXPECT_EQ(value(report.out, "elements"), "1");
  EXPECT_EQ(value(report.out, "materials"), "1");
  EXPECT_NEAR(std::stod(value(report.out, "mass")), 2000.0, 1e-9);
  const std::string text = run({"import", "tissue.feb"}).out;
  EXPECT_THAT(text, HasSubstr("1 elements, 8 nodes"));
  EXPECT_THAT(text, HasSubstr("333.333333 833.333333 833.333333"));
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
