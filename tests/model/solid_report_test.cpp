// SPDX-License-Identifier: Apache-2.0
#include <polhode/model/solid_report.hpp>

#include <cmath>

#include <gtest/gtest.h>

namespace polhode {
namespace {

TEST(VonMises, IsTheStressOfATensionTestAndRoot3TimesAShear) {
  Mat3 tension = Mat3::Zero(), shear = Mat3::Zero();
  tension(0, 0) = 5.0;
  shear(0, 1) = shear(1, 0) = 2.0;
  EXPECT_NEAR(von_mises(tension), 5.0, 1e-14);
  EXPECT_NEAR(von_mises(shear), 2.0 * std::sqrt(3.0), 1e-14);
  EXPECT_NEAR(von_mises(7.0 * Mat3::Identity()), 0.0, 1e-14);
}

TEST(NodalAverages, WeighElementsByTheirVolume) {
  Mesh mesh;
  mesh.nodes.assign(5, Vec3::Zero());
  mesh.blocks = {{"tet4", {0, 1, 2, 3, 1, 2, 3, 4}}};
  std::vector<ElementSample> elements(2);
  elements[0].volume = 1.0;
  elements[0].strain_energy_density = 3.0;
  elements[0].cauchy(0, 0) = 6.0;
  elements[1].volume = 2.0;
  const NodalAverages nodal = nodal_averages(mesh, elements);
  EXPECT_DOUBLE_EQ(nodal.strain_energy_density[0], 3.0);
  EXPECT_DOUBLE_EQ(nodal.strain_energy_density[1], 1.0);
  EXPECT_DOUBLE_EQ(nodal.strain_energy_density[4], 0.0);
  EXPECT_DOUBLE_EQ(nodal.cauchy[2](0, 0), 2.0);
  EXPECT_NEAR(nodal.von_mises[2], 2.0, 1e-14);
  // 6 of its own against 6, 2, 2, 2; 0 against 2, 2, 2, 0.
  EXPECT_NEAR(nodal.stress_error[0], std::sqrt(3.0 * 16.0 / 4.0), 1e-14);
  EXPECT_NEAR(nodal.stress_error[1], std::sqrt(3.0 * 4.0 / 4.0), 1e-14);
}

TEST(NodalAverages, TakeStressesThatElementsHaveAtTheirNodes) {
  Mesh mesh;
  mesh.nodes.assign(4, Vec3::Zero());
  mesh.blocks = {{"tet4", {0, 1, 2, 3}}};
  std::vector<ElementSample> elements(1);
  elements[0].volume = 2.0;
  for (int a = 0; a < 4; ++a) {
    elements[0].cauchy_at_nodes.emplace_back(a * Mat3::Identity());
    elements[0].energy_at_nodes.push_back(10.0 * a);
  }
  const NodalAverages nodal = nodal_averages(mesh, elements);
  for (std::size_t a = 0; a < 4; ++a) {
    EXPECT_DOUBLE_EQ(nodal.cauchy[a](1, 1), static_cast<double>(a));
    EXPECT_DOUBLE_EQ(nodal.strain_energy_density[a], 10.0 * static_cast<double>(a));
  }
  EXPECT_DOUBLE_EQ(nodal.stress_error[0], 0.0);
}

}  // namespace
}  // namespace polhode
