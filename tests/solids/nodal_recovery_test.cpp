// SPDX-License-Identifier: Apache-2.0
#include <polhode/solids/nodal_recovery.hpp>

#include <cmath>

#include <gtest/gtest.h>

#include <polhode/solids/mesh/generators.hpp>

namespace polhode::nodal_recovery_tests {
namespace {

constexpr solids::LinearModuli kModuli{2.0, 1.0};  // bulk modulus 8/3

TEST(VonMises, IsTheStressOfATensionTestAndRoot3TimesAShear) {
  Mat3 tension = Mat3::Zero(), shear = Mat3::Zero();
  tension(0, 0) = 5.0;
  shear(0, 1) = shear(1, 0) = 2.0;
  EXPECT_NEAR(solids::von_mises(tension), 5.0, 1e-14);
  EXPECT_NEAR(solids::von_mises(shear), 2.0 * std::sqrt(3.0), 1e-14);
  EXPECT_NEAR(solids::von_mises(7.0 * Mat3::Identity()), 0.0, 1e-14);
}

/// Two cubes side by side.
solids::Mesh two_cubes() {
  return solids::make_mesh("two", "block", {{"size", {2, 1, 1}}, {"cells", {2, 1, 1}}}, "hex8");
}

// @tests{nodal-stress}
TEST(NodalFields, OfLinearHexahedraAreMeansByVolume) {
  const solids::Mesh mesh = two_cubes();
  std::vector<ElementSample> elements(2);
  elements[0].volume = 1.0;
  elements[0].strain_energy_density = 3.0;
  elements[0].cauchy(0, 0) = 6.0;
  elements[1].volume = 2.0;
  const solids::NodalFields nodal = solids::NodalRecovery(mesh, kModuli).fields(elements);
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    const double x = mesh.nodes[i].x();
    EXPECT_DOUBLE_EQ(nodal.strain_energy_density[i], x < -0.5 ? 3.0 : x < 0.5 ? 1.0 : 0.0);
    EXPECT_DOUBLE_EQ(nodal.cauchy[i](0, 0), x < -0.5 ? 6.0 : x < 0.5 ? 2.0 : 0.0);
    EXPECT_NEAR(nodal.von_mises[i], nodal.cauchy[i](0, 0), 1e-14);
  }
  // Half of the nodes of each have 2: off by 4 in the first, by 2 in the other.
  EXPECT_NEAR(nodal.stress_error[0], std::sqrt(16.0 / 2.0), 1e-14);
  EXPECT_NEAR(nodal.stress_error[1], std::sqrt(4.0 / 2.0), 1e-14);
}

// A tension σ has the energy σ²/(2 E) per volume, with 1/E = 1/(3 G) + 1/(9 K). Differences that
// grow along x from 0 to 4 and fall from 2 to 0: a third of their squares, in volumes 1 and 2.
// @tests{stress-error-energy}
TEST(NodalFields, HaveTheEnergyOfTheStressAndOfItsJumps) {
  const solids::Mesh mesh = two_cubes();
  std::vector<ElementSample> elements(2);
  elements[0].volume = 1.0;
  elements[0].cauchy(0, 0) = 6.0;
  elements[1].volume = 2.0;
  const solids::NodalFields nodal = solids::NodalRecovery(mesh, kModuli).fields(elements);
  const double flexibility = 1.0 / 3.0 + 3.0 / (9.0 * 8.0);
  EXPECT_NEAR(nodal.error_energy, 0.5 * flexibility * (16.0 / 3.0 + 2.0 * 4.0 / 3.0), 1e-13);
  // 6 to 2: the mean of the squares is (36 + 12 + 4)/3; 2 to 0: 4/3.
  EXPECT_NEAR(nodal.energy, 0.5 * flexibility * (52.0 / 3.0 + 2.0 * 4.0 / 3.0), 1e-13);
}

/// Samples of a field in elements whose stress is its linear interpolation between the corners.
template <class Field>
std::vector<ElementSample> samples(const solids::Mesh& mesh, const Field& field) {
  std::vector<ElementSample> elements(static_cast<std::size_t>(mesh.element_count()));
  for (int e = 0; e < mesh.element_count(); ++e) {
    ElementSample& sample = elements[static_cast<std::size_t>(e)];
    sample.volume = solids::element_volume(mesh, e);
    for (const int node : mesh.element_nodes(e)) {
      const double f = field(mesh.nodes[static_cast<std::size_t>(node)]);
      sample.cauchy_at_nodes.emplace_back(f * Mat3::Identity());
      sample.energy_at_nodes.push_back(f * f);
    }
  }
  return elements;
}

// @tests{stress-patch}
TEST(NodalFields, OfPatchesAreExactForLinearFieldsUpToTheBoundary) {
  const auto field = [](const Vec3& X) { return 3.0 + X.x() - 2.0 * X.y() + 0.5 * X.z(); };
  for (const char* cell : {"hex20", "hex27", "tet10"})
    for (const std::vector<double>& cells :
         {std::vector<double>{1, 1, 1}, {2, 1, 1}, {3, 2, 1}, {2, 2, 2}}) {
      const solids::Mesh mesh =
          solids::make_mesh("m", "block", {{"size", {2, 1, 3}}, {"cells", cells}}, cell);
      const solids::NodalFields nodal =
          solids::NodalRecovery(mesh, kModuli).fields(samples(mesh, field));
      for (std::size_t i = 0; i < mesh.nodes.size(); ++i)
        ASSERT_NEAR(nodal.cauchy[i](1, 1), field(mesh.nodes[i]), 1e-12) << cell << ' ' << i;
      for (const double error : nodal.stress_error) EXPECT_NEAR(error, 0.0, 1e-12) << cell;
      EXPECT_NEAR(nodal.error_energy, 0.0, 1e-24) << cell;
    }
}

}  // namespace
}  // namespace polhode::nodal_recovery_tests
