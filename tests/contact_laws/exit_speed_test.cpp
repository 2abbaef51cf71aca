// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <polhode/contact_laws/exit_speed.hpp>

namespace polhode::test::exit_speed_tests {

namespace {

using contact::least_exit_speed;

/// @tests{nonsmooth-exit}
TEST(LeastExitSpeed, NeverAddsEnergyAndLandsInTwoSteps) {
  for (const double e : {0.0, 0.3, 0.9, 1.0})
    for (const double w : {-3.0, -1e-3, 0.0, 1e-3, 2.0})
      for (const double gap : {-1e-3, -1e-9, 0.0, 1e-6, 1e-3, 0.1}) {
        const double dt = 1e-3, least = least_exit_speed(gap, w, e, dt, 0.02);
        // p (w_n + w_{n+1})/2 is the work of the contact.
        EXPECT_LE(w + least, 0.0) << e << ' ' << w << ' ' << gap;
      }
  // For any gap at its first impulse, the body is at rest at the surface one step later.
  for (const double part : {0.51, 0.8, 1.0, 1.3, 1.49}) {
    const double w = -2.0, dt = 1e-2;
    double gap = -part * w * dt;
    const double first = least_exit_speed(gap, w, 0.0, dt, 0.0);
    ASSERT_GT(first, w);
    gap += 0.5 * dt * (w + first);
    EXPECT_GE(gap, 0.0);
    const double second = least_exit_speed(gap, first, 0.0, dt, 0.0);
    EXPECT_NEAR(second, 0.0, 1e-12);
    EXPECT_NEAR(gap + 0.5 * dt * (first + second), 0.0, 1e-15);
  }
}

}  // namespace

}  // namespace polhode::test::exit_speed_tests
