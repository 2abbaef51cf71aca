// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <polhode/beams/section.hpp>
#include <polhode/core/error.hpp>

namespace polhode::test::section_tests {

constexpr double kPi = std::numbers::pi;

TEST(Section, OfARectangle) {
  const SectionShape s = rectangle_section(0.2, 0.1, 0.3);
  EXPECT_DOUBLE_EQ(s.area, 0.02);
  EXPECT_DOUBLE_EQ(s.I_z, 0.1 * 0.008 / 12.0);
  EXPECT_DOUBLE_EQ(s.I_y, 0.2 * 0.001 / 12.0);
  EXPECT_NEAR(s.shear_y, 13.0 / 15.3, 1e-15);
  EXPECT_NEAR(rectangle_section(0.2, 0.1, 0.0).shear_z, 5.0 / 6.0, 1e-15);
}

// Timoshenko and Goodier, Theory of Elasticity, art. 109, table of k_1.
TEST(Section, OfARectangleHasThePublishedTorsionConstants) {
  for (const auto& [ratio, k] : {std::pair(1.0, 0.1406), std::pair(2.0, 0.229),
                                 std::pair(3.0, 0.263), std::pair(10.0, 0.312)}) {
    EXPECT_NEAR(rectangle_section(ratio, 1.0, 0.3).J / ratio, k, 5.01e-4) << ratio;
    EXPECT_DOUBLE_EQ(rectangle_section(ratio, 1.0, 0.3).J, rectangle_section(1.0, ratio, 0.3).J);
  }
}

TEST(Section, OfATubeIsACircleLessACircle) {
  const SectionShape tube = tube_section(0.02, 0.016, 0.3), outer = circle_section(0.02, 0.3),
                     inner = circle_section(0.016, 0.3);
  EXPECT_NEAR(tube.area, outer.area - inner.area, 1e-19);
  EXPECT_NEAR(tube.I_y, outer.I_y - inner.I_y, 1e-22);
  EXPECT_NEAR(tube.J, outer.J - inner.J, 1e-22);
  EXPECT_DOUBLE_EQ(outer.J, kPi / 32.0 * std::pow(0.02, 4));
  // From the full circle to the thin wall (Cowper): 6(1 + ν)/(7 + 6ν) and 2(1 + ν)/(4 + 3ν).
  EXPECT_NEAR(tube_section(1.0, 1e-6, 0.3).shear_y, 7.8 / 8.8, 1e-9);
  EXPECT_NEAR(tube_section(1.0, 1.0 - 1e-9, 0.3).shear_y, 2.6 / 4.9, 1e-8);
}

// IPE 200 without its fillets: area and second moments calculated by hand.
TEST(Section, OfAnI) {
  const SectionShape s = i_section({0.2, 0.1, 0.0056, 0.0085}, 0.3);
  EXPECT_NEAR(s.area, 2 * 0.1 * 0.0085 + 0.183 * 0.0056, 1e-15);
  EXPECT_NEAR(s.I_z,
              0.0056 * std::pow(0.183, 3) / 12 +
                  2 * (0.1 * std::pow(0.0085, 3) / 12 + 0.1 * 0.0085 * 0.09575 * 0.09575),
              1e-15);
  EXPECT_NEAR(s.J, (2 * 0.1 * std::pow(0.0085, 3) + 0.183 * std::pow(0.0056, 3)) / 3, 1e-18);
  // The web carries nearly all shear along y.
  EXPECT_NEAR(s.shear_y * s.area, 0.183 * 0.0056, 0.15 * 0.183 * 0.0056);
  EXPECT_LT(s.shear_z * s.area, 2 * 0.1 * 0.0085);
}

TEST(Section, OfAnElasticMaterial) {
  const SectionShape shape = rectangle_section(0.2, 0.1, 0.25);
  const BeamSection s = elastic_section(shape, 2.5e9, 0.25, 1000.0);
  EXPECT_DOUBLE_EQ(s.stiffness(0, 0), 2.5e9 * 0.02);
  EXPECT_DOUBLE_EQ(s.stiffness(1, 1), shape.shear_y * 1e9 * 0.02);
  EXPECT_DOUBLE_EQ(s.stiffness(3, 3), 1e9 * shape.J);
  EXPECT_DOUBLE_EQ(s.stiffness(4, 4), 2.5e9 * shape.I_y);
  EXPECT_DOUBLE_EQ(s.stiffness(5, 5), 2.5e9 * shape.I_z);
  EXPECT_DOUBLE_EQ(s.mass_per_length, 20.0);
  EXPECT_DOUBLE_EQ(s.inertia_per_length[0], s.inertia_per_length[1] + s.inertia_per_length[2]);
  EXPECT_TRUE(s.stiffness.isDiagonal());
}

TEST(Section, RefusesSectionsWithoutArea) {
  EXPECT_THROW((void)rectangle_section(0.0, 1.0, 0.3), InputError);
  EXPECT_THROW((void)circle_section(-1.0, 0.3), InputError);
  EXPECT_THROW((void)tube_section(0.1, 0.1, 0.3), InputError);
  EXPECT_THROW((void)tube_section(0.1, 0.2, 0.3), InputError);
  EXPECT_THROW((void)i_section({0.1, 0.1, 0.01, 0.05}, 0.3), InputError);
  EXPECT_THROW((void)i_section({0.1, 0.1, 0.2, 0.01}, 0.3), InputError);
  EXPECT_THROW((void)circle_section(1.0, 0.6), InputError);
  EXPECT_THROW((void)elastic_section(circle_section(1.0, 0.3), -1.0, 0.3, 1.0), InputError);
  EXPECT_THROW((void)elastic_section(circle_section(1.0, 0.3), 1.0, 0.3, -1.0), InputError);
}

}  // namespace polhode::test::section_tests
