// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include <polhode/surface_contact/surface_law.hpp>

namespace polhode::test::surface_law_tests {
namespace {

// @tests{surface-start}
TEST(SurfaceLaw, HasABandThatEndsWhereAPointStarts) {
  SurfaceLaw law;
  law.normal.tolerance = 2e-4;
  law.normal.stiffness = 1e6;
  const double middle = law.normal.force(0.0);
  for (const double start : {1.9e-4, 1e-4, 0.0, -1e-4, -1.79e-4}) {
    const contact::NormalLaw own = law.with_band_lowered(law.lowered_for(start)).normal;
    EXPECT_NEAR(own.reach(), start, 1e-18);
    EXPECT_EQ(own.floor(), -2e-4);
    EXPECT_NEAR(own.energy(start), 0.0, 1e-30);
    EXPECT_NEAR(own.force(0.5 * (start - 2e-4)), middle, 1e-9 * middle) << "in its middle";
  }
  EXPECT_NEAR(law.with_band_lowered(law.lowered_for(-1.99e-4)).normal.band(), 0.05 * 4e-4, 1e-18)
      << "a twentieth is left";
}

TEST(SurfaceLaw, KeepsItsBandForWhatStartsElsewhere) {
  SurfaceLaw law;
  EXPECT_EQ(law.lowered_for(law.normal.reach()), 0.0);
  EXPECT_EQ(law.lowered_for(std::numeric_limits<double>::infinity()), 0.0);
  EXPECT_EQ(law.lowered_for(std::nan("")), 0.0) << "nothing is near";
  EXPECT_EQ(law.with_band_lowered(0.0).normal.stiffness, law.normal.stiffness);
  law.normal.potential = contact::NormalPotential::linear;
  EXPECT_EQ(law.lowered_for(-1e-3), 0.0) << "overlaps are allowed";
}

}  // namespace
}  // namespace polhode::test::surface_law_tests
