// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include <polhode/io/read/read_model.hpp>
#include <support/paths.hpp>

namespace polhode::read_solids_tests {
namespace {

/// Rounding of a few operations on numbers of size 1.
constexpr double kRounding = 1e-14;

const Model& everything() {
  static const Model model = io::read_model(std::filesystem::path(test::source_dir()) / "tests" /
                                            "corpus" / "good" / "solids.yaml");
  return model;
}

TEST(ReadSolids, ResolvesMaterialsToSi) {
  const MaterialSpec& rubber = everything().materials[0];
  EXPECT_EQ(rubber.name, "rubber");
  EXPECT_EQ(rubber.type, "neo_hookean");
  EXPECT_DOUBLE_EQ(rubber.parameters.at("youngs_modulus"), 2e6);
  EXPECT_DOUBLE_EQ(rubber.density, 1100.0);
  EXPECT_DOUBLE_EQ(rubber.viscosity.relaxation_time, 1e-3);
  EXPECT_TRUE(rubber.fibres.empty());
  const MaterialSpec& gel = everything().materials[2];
  EXPECT_DOUBLE_EQ(gel.viscosity.shear, 10.0);
  ASSERT_EQ(gel.fibres.size(), 1u);
  EXPECT_EQ(gel.fibres[0].law, "exponential");
  EXPECT_DOUBLE_EQ(gel.fibres[0].parameters.at("xi"), 5e3);
  EXPECT_NEAR((gel.fibres[0].direction - Vec3(1, 1, 0).normalized()).norm(), 0.0, kRounding);
}

TEST(ReadSolids, TakesOneFamilyOfFibresOrAList) {
  const auto read = [](const std::string& fibre) {
    return io::read_model_text(
        "format: 1\nbodies: {b: {fixed: true}}\nmaterials: {m: {type: neo_hookean, youngs_modulus: "
        "1, "
        "poisson_ratio: 0.3, fibre: " +
            fibre + "}}\n",
        "model.yaml");
  };
  const Model two = read(
      "[{law: exponential, xi: 2 kPa, alpha: 1, dispersion: 0.1, direction: x}, {law: "
      "power_linear, modulus: 3, straight_stretch: 1.1, direction: [1, 1, 0]}]");
  ASSERT_EQ(two.materials[0].fibres.size(), 2u);
  EXPECT_EQ(two.materials[0].fibres[1].law, "power_linear");
  EXPECT_DOUBLE_EQ(two.materials[0].fibres[0].parameters.at("dispersion"), 0.1);
  EXPECT_NEAR(two.materials[0].fibres[1].direction.y(), std::sqrt(0.5), kRounding);
  const auto fault = [&](const std::string& fibre) -> std::string {
    try {
      (void)read(fibre);
    } catch (const io::ModelErrors& errors) {
      return errors.text();
    }
    return "none";
  };
  EXPECT_THAT(fault("[]"), testing::HasSubstr("is an empty list"));
  EXPECT_THAT(fault("[{law: exponential, xi: 1, alpha: 1, direction: x}, {law: toes}]"),
              testing::HasSubstr("materials.m.fibre.1"));
  EXPECT_THAT(fault("{law: exponential, xi: 1, alpha: 1, dispersion: 0.4, direction: x}"),
              testing::HasSubstr("dispersion"));
}

TEST(ReadSolids, TakesMeshesFromGeneratorsAndNumbers) {
  const MeshSpec& pad = everything().solids[0].mesh;
  EXPECT_EQ(pad.type, "block");
  EXPECT_EQ(pad.parameters.at("cells"), (std::vector<double>{4, 4, 4}));
  EXPECT_NEAR(pad.parameters.at("size")[2], 0.1,
              kRounding);  // A number without a unit, in millimetres.
  const MeshSpec& rod = everything().solids[1].mesh;
  EXPECT_EQ(rod.parameters.at("inner"), std::vector<double>{0.01});
  EXPECT_NEAR((rod.position - Vec3(0.3, 0, 0)).norm(), 0.0, kRounding);
  EXPECT_NEAR((rod.orientation * Vec3::UnitZ() - Vec3::UnitX()).norm(), 0.0, kRounding);
  const MeshSpec& tet = everything().solids[2].mesh;
  EXPECT_EQ(tet.type, "inline");
  ASSERT_EQ(tet.nodes.size(), 4u);
  EXPECT_NEAR(tet.nodes[3].z(), 0.01, kRounding);
  EXPECT_EQ(tet.elements, (std::vector<std::vector<int>>{{0, 1, 2, 3}}));
  EXPECT_EQ(tet.sets.at("foot"), (std::vector<int>{0, 1, 2}));
}

TEST(ReadSolids, KeepsBondsAndPrescribedNodesInTheOrderOfTheFile) {
  const Model& model = everything();
  const SolidSpec& pad = model.solids[0];
  ASSERT_EQ(pad.bonded.size(), 2u);
  EXPECT_EQ(model.body_name(pad.bonded[0].body), "base");
  EXPECT_EQ(pad.bonded[0].nodes[0].kind, solids::Selection::Kind::kPlane);
  EXPECT_EQ(pad.bonded[0].nodes[0].level, solids::Selection::Level::kMin);
  const SolidSpec& rod = model.solids[1];
  EXPECT_EQ(rod.bonded[0].body, kGround);
  EXPECT_EQ(rod.bonded[0].nodes[0].set, "start");
  EXPECT_EQ(rod.stress, "midpoint");
  EXPECT_DOUBLE_EQ(*rod.density, 7800.0);
  const SolidSpec& tet = model.solids[2];
  ASSERT_EQ(tet.prescribed.size(), 2u);
  EXPECT_EQ(tet.prescribed[0].name, "foot");
  EXPECT_TRUE(tet.prescribed[0].displacement[0]);
  EXPECT_FALSE(tet.prescribed[0].displacement[1]);
  EXPECT_NEAR((*tet.prescribed[0].displacement[2])(0.5), 1e-3 * std::sin(0.5), kRounding);
  EXPECT_NEAR((*tet.prescribed[1].displacement[1])(0.25), 0.5e-3, kRounding);
  EXPECT_DOUBLE_EQ(tet.velocity->z(), 1.0);
}

TEST(ReadSolids, ReadsLoadsOnSolids) {
  const Model& model = everything();
  const auto load = [&](const std::string& name) {
    for (const LoadSpec& one : model.loads)
      if (one.name == name) return one;
    return LoadSpec{};
  };
  EXPECT_EQ(load("squeeze").solid, 0);
  EXPECT_TRUE(load("squeeze").follower);
  EXPECT_NEAR((*load("squeeze").value)(0.5), 500.0, 1e3 * kRounding);
  EXPECT_FALSE(load("dead").follower);
  EXPECT_TRUE(load("dead").selection.empty());
  EXPECT_EQ(load("shear").selection[0].set, "outer");
  EXPECT_DOUBLE_EQ((*(*load("shear").vector)[2])(0.0), 1000.0);
  EXPECT_DOUBLE_EQ((*(*load("spin").vector)[1])(0.0), 1.0);
  EXPECT_TRUE(load("pull").selection[0].on_surface);
}

TEST(ReadSolids, ReadsProbesOfPointsNodesAndInterfaces) {
  const std::vector<ProbeSpec>& probes = everything().output.probes;
  EXPECT_NEAR((probes[0].point - Vec3(0.05, 0.05, 0)).norm(), 0.0, kRounding);
  EXPECT_EQ(probes[1].node, 0);
  EXPECT_EQ(probes[2].reaction_of, "base");
  EXPECT_EQ(probes[3].target, "tet");
}

}  // namespace
}  // namespace polhode::read_solids_tests
