// SPDX-License-Identifier: Apache-2.0
// Axes and directions of fibres by element in files of FEBio.
#include "feb_fixture.hpp"

#include <polhode/compile/build_solids.hpp>

namespace polhode::feb_mesh_data_tests {
namespace {

using namespace feb_tests;

using testing::HasSubstr;

/// Two blocks of one material with fibres, and data for elements.
std::string tissue(const std::string& data, const std::string& fibre = "",
                   const std::string& type = "trans iso Mooney-Rivlin") {
  return feb(control("DYNAMIC", 1, 1.0) +
             tag("Material",
                 tag("material",
                     tag("density", "1000") + tag("c1", "1e4") + tag("c2", "0") + tag("c3", "5e3") +
                         tag("c4", "40") + tag("c5", "1e6") + tag("lam_max", "1.1") +
                         tag("c", "1e4") + tag("k1", "1e3") + tag("k2", "2") + tag("kappa", "0") +
                         tag("gamma", "30") + tag("k", "1e7") + fibre,
                     "id='1' name='m' type='" + type + "'")) +
             tag("Mesh", block(1, "one", Vec3::Zero(), Vec3::Ones()) +
                             block(11, "two", Vec3(2, 0, 0), Vec3(3, 1, 1)) +
                             tag("ElementSet", "11,1", "name='all'")) +
             tag("MeshDomains", domain("one", "m") + domain("two", "m")) + tag("MeshData", data));
}
std::string data(const std::string& type, const std::string& set, const std::string& inside) {
  return tag("ElementData", inside, "type='" + type + "' elem_set='" + set + "'");
}
std::string axes(int lid, const std::string& a, const std::string& d) {
  return tag("elem", tag("a", a) + tag("d", d), format("lid='{}'", lid));
}

class FebMeshData : public FebFixture {};

TEST_F(FebMeshData, AxesOfElementsTurnTheFibres) {
  // The fibre is along the second of the material's axes; element 11 is the first of the set.
  const std::string along = tag("fiber", "0,1,0", "type='vector'");
  const Model m = read(tissue(data("mat_axis", "all", axes(1, "0,0,2", "1,0,0")), along));
  ASSERT_EQ(m.solids.size(), 2u);
  EXPECT_TRUE(m.solids[0].fibre_directions.empty());
  ASSERT_EQ(m.solids[1].fibre_directions.size(), 1u);
  EXPECT_LT((m.solids[1].fibre_directions[0] - Vec3::UnitX()).norm(), 1e-15);
  // In place of the material's own axes, and for all its families.
  const std::string own = tag("mat_axis", tag("a", "0,1,0") + tag("d", "1,0,0"), "type='vector'");
  const Model n = read(
      tissue(data("mat_axis", "one", axes(1, "0,0,1", "1,0,0")), own, "Holzapfel-Gasser-Ogden"));
  ASSERT_EQ(n.solids[0].fibre_directions.size(), 2u);
  const double c = std::cos(std::acos(-1.0) / 6), s = 0.5;
  EXPECT_LT((n.solids[0].fibre_directions[0] - Vec3(s, 0, c)).norm(), 1e-14);
  EXPECT_LT((n.solids[0].fibre_directions[1] - Vec3(-s, 0, c)).norm(), 1e-14);
  EXPECT_LT((n.materials[0].fibres[0].direction - Vec3(s, c, 0)).norm(), 1e-14);
}

TEST_F(FebMeshData, DirectionsOfElementsStandForTheMaterials) {
  const Model m = read(tissue(data("fiber", "two", tag("elem", "3,0,4", "lid='1'"))));
  ASSERT_EQ(m.solids[1].fibre_directions.size(), 1u);
  EXPECT_LT((m.solids[1].fibre_directions[0] - Vec3(0.6, 0, 0.8)).norm(), 1e-15);
}

/// A unit cube of St. Venant-Kirchhoff's material.
std::string cube(const std::string& control_text, const std::string& sets, const std::string& map,
                 const std::string& more) {
  return feb(
      control_text +
      tag("Material", tag("material", tag("density", "1000") + tag("E", "1e6") + tag("v", "0.3"),
                          "id='1' name='m' type='St.Venant-Kirchhoff'")) +
      tag("Mesh", block(1, "one", Vec3::Zero(), Vec3::Ones()) + sets) +
      tag("MeshDomains", domain("one", "m")) + tag("MeshData", map) + more +
      tag("LoadData", curve(1, "0,0;1,1")));
}
std::string values(const std::string& member, const std::vector<double>& list) {
  std::string text;
  for (std::size_t k = 0; k < list.size(); ++k)
    text += tag(member, format("{}", list[k]), format("lid='{}'", k + 1));
  return text;
}
const std::string kAll = tag("NodeSet", "1:8", "name='all'");
std::string stretched(const std::string& map, const std::string& name = "way") {
  return cube(control("STATIC", 10, 0.1), kAll, map,
              tag("Boundary", tag("bc", tag("dof", "x") + tag("value", name, "lc='1' type='map'"),
                                  "name='pull' node_set='all' type='prescribed displacement'") +
                                  tag("bc", tag("y_dof", "1") + tag("z_dof", "1"),
                                      "name='sides' node_set='all' type='zero displacement'")));
}
std::string node_map(const std::vector<double>& list) {
  return tag("NodeData", values("node", list), "name='way' node_set='all' data_type='scalar'");
}

// A stretch l along x with all else held: s = (L + 2 m) (l^2 - 1)/2 l.
TEST_F(FebMeshData, MapsOfNodesPrescribeDisplacements) {
  Simulation s(read(stretched(node_map({0, 0.3, 0.3, 0, 0, 0.3, 0.3, 0}))));
  ASSERT_EQ(s.run().end, RunEnd::finished);
  const SolidReport report = s.solid(0);
  const double l = 1.3, modulus = 1e6 * 0.7 / (1.3 * 0.4);
  ASSERT_EQ(report.elements.size(), 1U);
  EXPECT_NEAR(report.elements[0].cauchy(0, 0) / (modulus * (l * l - 1) / 2 * l), 1.0, 1e-12);
  for (std::size_t k = 0; k < 8; ++k)
    EXPECT_NEAR(report.displacement[k].x(), s.solids()[0].plan.start[k].x() * 0.3, 1e-14);
  EXPECT_EQ(s.model().solids[0].prescribed.size(), 3U);
}

// Dead pressures of 500 Pa on the top and 200 Pa on the side of a free cube of 1000 kg: its centre
// moves by -p/m t^2/2, exactly for any step.
TEST_F(FebMeshData, MapsOfSurfacesArePressuresByFacet) {
  const std::string text = cube(
      control("DYNAMIC", 100, 1e-3, typed("solver", "solid", tag("rhoi", "1"))),
      tag("Surface", tag("quad4", "5,6,7,8", "id='1'") + tag("quad4", "2,3,7,6", "id='2'"),
          "name='skin'"),
      tag("SurfaceData", values("face", {500, 200}), "name='p' surface='skin' data_type='scalar'"),
      tag("Loads", tag("surface_load", tag("pressure", "p", "type='map'") + tag("linear", "1"),
                       "surface='skin' type='pressure'")));
  for (const double step : {1e-2, 1e-3, 1e-4}) {
    const Simulation s = run(read(text), 0.1, step);
    const SolidReport report = s.solid(0);
    Vec3 centre = Vec3::Zero();
    for (const Vec3& x : report.position) centre += x / 8.0;
    const Vec3 way = -0.5 * 0.01 * Vec3(0.2, 0.0, 0.5);
    EXPECT_NEAR((centre - Vec3::Constant(0.5) - way).norm(), 0.0, 1e-12) << step;
  }
}

TEST_F(FebMeshData, MapsThatDoNotFitAreNamed) {
  EXPECT_THAT(fault(stretched(node_map({0, 0.3}))),
              HasSubstr("the map 'way' has no value for a member of 'all'"));
  EXPECT_THAT(fault(stretched(node_map(std::vector<double>(9, 0.1)))),
              HasSubstr("'all' has 8 members, and none of this lid"));
  EXPECT_THAT(fault(stretched(node_map(std::vector<double>(8, 0.1)), "wax")),
              HasSubstr("there is no map 'wax'. Did you mean 'way'?"));
  EXPECT_THAT(fault(stretched(tag("NodeData", "", "name='v' node_set='all' data_type='vec3'"))),
              HasSubstr("<NodeData> of data_type 'vec3' is not read"));
}

TEST_F(FebMeshData, WhatCannotBeReadIsNamed) {
  EXPECT_THAT(fault(tissue(data("shell thickness", "one", ""))),
              HasSubstr("<ElementData> of type 'shell thickness' is not read"));
  EXPECT_THAT(fault(tissue(data("fiber", "three", ""))),
              HasSubstr("there are no elements 'three'"));
  EXPECT_THAT(fault(tissue(data("fiber", "two", tag("elem", "1,0,0", "lid='2'")))),
              HasSubstr("the set 'two' has 1 elements, and none of this lid"));
  EXPECT_THAT(fault(tissue(data("fiber", "two", tag("elem", "0,0,0", "lid='1'")))),
              HasSubstr("the direction of a fibre is zero"));
  EXPECT_THAT(fault(tissue(data("mat_axis", "two", axes(1, "0,0,1", "0,0,1")))),
              HasSubstr("<a> and <d> are along one line"));
  EXPECT_THAT(fault(tissue(data("fiber", "two", tag("elem", "1,0,0", "lid='1'")), "",
                           "Holzapfel-Gasser-Ogden")),
              HasSubstr("whose material has several families of fibres"));
}

}  // namespace
}  // namespace polhode::feb_mesh_data_tests
