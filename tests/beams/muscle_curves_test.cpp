// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <polhode/beams/muscle_curves.hpp>
#include <polhode/math/gauss_rule.hpp>

namespace polhode::test::muscle_curves_tests {

// Points that define the curves: De Groote et al. (2016), figure 1 and equations of the supplement.
// @tests{muscle-length} @tests{muscle-passive} @tests{muscle-velocity}
TEST(MuscleCurves, PassThroughTheirPoints) {
  EXPECT_NEAR(active_force_length(1.0).value, 1.0, 0.005);
  EXPECT_NEAR(active_force_length(1.0).slope, 0.165029, 1e-6);  // the maximum is at 1.014
  EXPECT_LT(active_force_length(0.4).value, 0.2);
  EXPECT_LT(active_force_length(1.7).value, 0.2);
  EXPECT_NEAR(passive_force_length(1.0).value, 0.0, 1e-15);
  EXPECT_NEAR(passive_force_length(1.6).value, 1.0, 1e-14);
  EXPECT_NEAR(force_velocity(0.0).value, 1.0, 1e-4);
  EXPECT_NEAR(force_velocity(-1.0).value, 0.0, 1e-4);
  EXPECT_GT(force_velocity(1.0).value, 1.3);
}

TEST(MuscleCurves, HaveTheirSlopesAndTheirEnergy) {
  const double h = 1e-6;
  for (const double x : {0.5, 0.8, 1.0, 1.2, 1.5}) {
    EXPECT_NEAR((active_force_length(x + h).value - active_force_length(x - h).value) / (2.0 * h),
                active_force_length(x).slope, 1e-8);
    EXPECT_NEAR((passive_force_length(x + h).value - passive_force_length(x - h).value) / (2.0 * h),
                passive_force_length(x).slope, 1e-8);
    EXPECT_NEAR((passive_energy(x + h) - passive_energy(x - h)) / (2.0 * h),
                passive_force_length(x).value, 1e-9);
    const double v = x - 1.0;
    EXPECT_NEAR((force_velocity(v + h).value - force_velocity(v - h).value) / (2.0 * h),
                force_velocity(v).slope, 1e-8);
  }
  EXPECT_NEAR(passive_energy(0.0), 0.0, 1e-15);
}

}  // namespace polhode::test::muscle_curves_tests
