// SPDX-License-Identifier: Apache-2.0
// Contact in files of FEBio: a cube of E = 1e6 Pa and v = 0 is pressed from above, so that its
// force is E (l^2 - 1)/2 l; the barrier acts in a thin band.
#include <cmath>
#include <cstdio>
#include <map>
#include <sstream>

#include <gmock/gmock.h>

#include <polhode/core/format.hpp>

#include "command_line.hpp"

namespace polhode::feb_contact_tests {
namespace {

using testing::HasSubstr;

/// A block of hexahedra, n along each edge, with numbers of nodes and elements from `first` on.
struct Block {
  int first, n;
  double from, size, bottom;

  int node(int i, int j, int k) const { return first + (i * (n + 1) + j) * (n + 1) + k; }
  std::string nodes() const {
    std::string text;
    for (int i = 0; i <= n; ++i)
      for (int j = 0; j <= n; ++j)
        for (int k = 0; k <= n; ++k)
          text += format("<node id='{}'>{},{},{}</node>", node(i, j, k), from + size * i / n,
                         from + size * j / n, bottom + 1.0 * k / n);
    return text;
  }
  std::string face(int i, int j, int k) const {
    return format("{},{},{},{}", node(i, j, k), node(i + 1, j, k), node(i + 1, j + 1, k),
                  node(i, j + 1, k));
  }
  std::string elements() const {
    std::string text;
    int e = first;
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
        for (int k = 0; k < n; ++k)
          text += format("<elem id='{}'>{},{}</elem>", e++, face(i, j, k), face(i, j, k + 1));
    return text;
  }
  std::string surface(int k) const {
    std::string text;
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
        text += format("<quad4 id='{}'>{}</quad4>", i * n + j + 1, face(i, j, k));
    return text;
  }
  std::string layer(int k) const {
    std::string text;
    for (int i = 0; i <= n; ++i)
      for (int j = 0; j <= n; ++j) text += format("{}{}", text.empty() ? "" : ",", node(i, j, k));
    return text;
  }
};

/// A cube on the ground and a cube, or a wider rigid block, above it that moves down by 0.1 m.
std::string press(bool rigid, double gap, const std::string& contact,
                  const std::string& analysis = "STATIC") {
  const Block low{1, 2, 0, 1, 0};
  const Block high = rigid ? Block{101, 1, -0.5, 2, 1 + gap} : Block{101, 3, 0, 1, 1 + gap};
  std::string text =
      "<febio_spec version='4.0'><Module type='solid'/>\n<Control><analysis>" + analysis +
      "</analysis><time_steps>10</time_steps><step_size>0.1</step_size></Control>\n"
      "<Material><material id='1' name='m' type='isotropic elastic'><density>1</density><E>1e6</E>"
      "<v>0</v></material>";
  if (rigid)
    text += "<material id='2' name='top' type='rigid body'><density>1</density></material>";
  text += "</Material>\n<Mesh><Nodes>" + low.nodes() + high.nodes() +
          "</Nodes>\n<Elements type='hex8' name='low'>" + low.elements() +
          "</Elements><Elements type='hex8' name='high'>" + high.elements() +
          "</Elements>\n<NodeSet name='foot'>" + low.layer(0) + "</NodeSet><NodeSet name='head'>" +
          high.layer(high.n) + "</NodeSet><Surface name='a'>" + low.surface(2) +
          "</Surface><Surface name='b'>" + high.surface(0) +
          "</Surface><SurfacePair name='p'><primary>a</primary><secondary>b</secondary>"
          "</SurfacePair></Mesh>\n<MeshDomains><SolidDomain name='low' mat='m'/>"
          "<SolidDomain name='high' mat='" +
          (rigid ? "top" : "m") +
          "'/></MeshDomains>\n<Boundary><bc name='ground' type='zero displacement' "
          "node_set='foot'><x_dof>1</x_dof><y_dof>1</y_dof><z_dof>1</z_dof></bc>";
  if (!rigid)
    text +=
        "<bc name='side' type='zero displacement' node_set='head'><x_dof>1</x_dof><y_dof>1"
        "</y_dof></bc><bc name='press' type='prescribed displacement' node_set='head'><dof>z</dof>"
        "<value lc='1'>-0.1</value></bc>";
  text += "</Boundary>\n<Contact>" + contact + "</Contact>\n";
  if (rigid)
    text +=
        "<Rigid><rigid_bc type='rigid_fixed'><rb>top</rb><Rx_dof>1</Rx_dof><Ry_dof>1</Ry_dof>"
        "<Ru_dof>1</Ru_dof><Rv_dof>1</Rv_dof><Rw_dof>1</Rw_dof></rigid_bc>"
        "<rigid_bc type='rigid_displacement'><rb>top</rb><dof>z</dof><value lc='1'>-0.1</value>"
        "</rigid_bc></Rigid>\n";
  return text +
         "<LoadData><load_controller id='1' type='loadcurve'><points><pt>0,0</pt><pt>1,1</pt>"
         "</points></load_controller></LoadData></febio_spec>\n";
}

std::string contact(const std::string& type, const std::string& inside = "",
                    const std::string& pair = "p") {
  return "<contact name='c' type='" + type + "' surface_pair='" + pair + "'>" + inside +
         "</contact>";
}

/// Force of a cube of length l.
double force(double l) { return 1e6 * (1 - l * l) / 2 * l; }

class FebContactCli : public test::CommandLine {
 protected:
  /// Force of the ground on the lower cube at the end.
  double reaction(const std::string& text) {
    write("press.feb", text);
    // A boundary condition cannot have the name of the ground.
    write("press.overlay.yaml",
          "format: 1\noutput: {probes: {p: {solid: low, interface: ground_2}}}\n");
    const auto done = run({"run", "press.feb", "--quiet", "-o", "r"});
    EXPECT_EQ(done.code, 0) << done.err;
    std::istringstream rows(read("r/probes/p.csv"));
    std::string row, end;
    while (std::getline(rows, row)) end = row;
    std::istringstream cells(end);
    for (int k = 0; k < 4; ++k) std::getline(cells, row, ',');
    return std::stod(row);
  }
  std::string fault(const std::string& text) {
    write("press.feb", text);
    const auto done = run({"check", "press.feb"});
    EXPECT_EQ(done.code, 3) << done.out;
    return done.err;
  }
};

TEST_F(FebContactCli, ARigidBlockPressesACube) {
  for (const std::string type :
       {"sliding-elastic", "sliding-facet-on-facet", "sliding-node-on-facet"})
    EXPECT_NEAR(reaction(press(true, 0, contact(type))) / force(0.9), 1, 0.01) << type;
  EXPECT_NEAR(reaction(press(true, 0.01, contact("sliding-elastic"))) / force(0.91), 1, 0.01);
  EXPECT_NEAR(reaction(press(true, 0.2, contact("sliding-elastic"))), 0, 1e-6);
}

TEST_F(FebContactCli, TwoCubesPressEachOther) {
  const std::string text = press(false, 0.01, contact("sliding-elastic"));
  EXPECT_NEAR(reaction(text) / force(1 - 0.09 / 2), 1, 0.02);
  ASSERT_EQ(run({"convert", "press.feb", "press.yaml"}).code, 0);
  const auto direct = run({"run", "press.feb", "--json", "--quiet", "-o", "a"});
  const auto converted = run({"run", "press.yaml", "--json", "--quiet", "-o", "b"});
  EXPECT_EQ(value(direct.out, "result_hash"), value(converted.out, "result_hash"));
  EXPECT_NE(value(direct.out, "result_hash"), "missing");
}

// Without the band: nodes that are tied are bonded.
TEST_F(FebContactCli, ATieToARigidBodyIsExact) {
  for (const std::string type :
       {"tied-elastic", "tied-facet-on-facet", "tied-node-on-facet", "sticky"})
    EXPECT_NEAR(reaction(press(true, 0, contact(type))), force(0.9), 1e-6) << type;
}

// A rigid block on a rigid plate slows down by the coefficient times the acceleration of gravity.
TEST_F(FebContactCli, ABlockSlidesOnAPlate) {
  const Block plate{1, 1, -2, 4, 0}, block{101, 1, -0.5, 1, 1};
  for (const double step : {0.01, 1e-3}) {
    const int steps = static_cast<int>(std::lround(0.2 / step));
    write("slide.feb",
          format("<febio_spec version='4.0'><Module type='solid'/><Control><analysis>DYNAMIC"
                 "</analysis><time_steps>{}</time_steps><step_size>{}</step_size></Control>",
                 steps, step) +
              "<Material><material id='1' name='plate' type='rigid body'><density>1</density>"
              "</material><material id='2' name='block' type='rigid body'><density>1</density>"
              "</material></Material><Mesh><Nodes>" +
              plate.nodes() + block.nodes() + "</Nodes><Elements type='hex8' name='low'>" +
              plate.elements() + "</Elements><Elements type='hex8' name='high'>" +
              block.elements() + "</Elements><Surface name='a'>" + plate.surface(1) +
              "</Surface><Surface name='b'>" + block.surface(0) +
              "</Surface><SurfacePair name='p'><primary>a</primary><secondary>b</secondary>"
              "</SurfacePair></Mesh><MeshDomains><SolidDomain name='low' mat='plate'/>"
              "<SolidDomain name='high' mat='block'/></MeshDomains><Loads><body_load "
              "type='body force'><force>0,0,10</force></body_load></Loads><Contact>" +
              contact("sliding-elastic", "<fric_coeff>0.3</fric_coeff>") +
              "</Contact><Rigid><rigid_bc type='rigid_fixed'><rb>plate</rb><Rx_dof>1</Rx_dof>"
              "<Ry_dof>1</Ry_dof><Rz_dof>1</Rz_dof><Ru_dof>1</Ru_dof><Rv_dof>1</Rv_dof>"
              "<Rw_dof>1</Rw_dof></rigid_bc><rigid_ic type='initial_rigid_velocity'><rb>block</rb>"
              "<value>1,0,0</value></rigid_ic></Rigid></febio_spec>");
    write("slide.overlay.yaml", "format: 1\noutput: {probes: {p: {body: block}}}\n");
    const auto done = run({"run", "slide.feb", "--quiet", "-o", "r"});
    ASSERT_EQ(done.code, 0) << done.err;
    std::istringstream rows(read("r/probes/p.csv"));
    std::string row, end;
    while (std::getline(rows, row)) end = row;
    std::istringstream cells(end);
    for (int k = 0; k < 2; ++k) std::getline(cells, row, ',');
    EXPECT_NEAR(std::stod(row), 0.2 - 0.5 * 3 * 0.04, 2e-3) << step;
  }
}

TEST_F(FebContactCli, WhatIsNotReadIsSaid) {
  EXPECT_THAT(fault(press(true, 0, contact("sliding-elastic", "<fric_coeff>0.1</fric_coeff>"))),
              HasSubstr("statics has no friction between surfaces"));
  EXPECT_THAT(
      fault(press(true, 0, contact("sliding-elastic", "<fric_coeff>-1</fric_coeff>"), "DYNAMIC")),
      HasSubstr("<fric_coeff> is -1"));
  EXPECT_THAT(fault(press(true, 0, contact("sliding-elastic", "", "q"))),
              HasSubstr("there is no <SurfacePair> 'q'"));
  EXPECT_THAT(fault(press(true, 0, contact("rigid_wall"))),
              HasSubstr("contact of type 'rigid_wall' is not read"));
  EXPECT_THAT(fault(press(false, 0.01, contact("tied-elastic"))),
              HasSubstr("a tie between two solids"));
  std::string self = press(true, 0, contact("sliding-elastic"));
  const std::string secondary = "<secondary>b";
  self.replace(self.find(secondary), secondary.size(), "<secondary>a");
  EXPECT_THAT(fault(self), HasSubstr("contact of a part with itself is not read"));
  std::string odd = press(true, 0, contact("sliding-elastic"));
  odd.replace(odd.find(secondary), secondary.size(), "<secondary>z");
  EXPECT_THAT(fault(odd), HasSubstr("is not that of one solid or rigid body"));
}

}  // namespace
}  // namespace polhode::feb_contact_tests
