// SPDX-License-Identifier: Apache-2.0
// Axes and directions of fibres by element in files of FEBio.
#include "feb_fixture.hpp"

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
  EXPECT_THAT(fault(tissue(tag("SurfaceData", "", "surface='s'"))),
              HasSubstr("<SurfaceData> is not read"));
}

}  // namespace
}  // namespace polhode::feb_mesh_data_tests
