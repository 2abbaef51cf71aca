// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <polhode/dynamics/mean_turn.hpp>
#include <polhode/math/cayley.hpp>

namespace polhode::mean_turn_tests {
namespace {

/// @tests{nonsmooth-step}
TEST(MeanTurn, ChangesTheMomentumByTheImpulse) {
  const Mat3 R = cay({0.3, -0.8, 0.5});
  const Mat3 J = R * Vec3(0.2, 0.5, 0.6).asDiagonal() * R.transpose();
  const Vec3 omega(3.0, -7.0, 4.0), tau(0.4, 0.3, -1.1);
  for (const double dt : {1e-3, 1e-2, 0.1, -1e-2}) {
    Vec3 mean = omega;
    ASSERT_TRUE(try_mean_turn(J, omega, tau, dt, mean)) << dt;
    const Vec3 change = cay(dt * mean) * (J * (2.0 * mean - omega)) - J * omega;
    EXPECT_LT((change - tau).norm(), 1e-14);
    // Work of the moment over the turn is the change of the kinetic energy.
    const Mat3 J_1 = cay(dt * mean) * J * cay(dt * mean).transpose();
    const Vec3 omega_1 = cay(dt * mean) * (2.0 * mean - omega);
    EXPECT_NEAR(0.5 * omega_1.dot(J_1 * omega_1) - 0.5 * omega.dot(J * omega), tau.dot(mean),
                1e-13);
  }
}

TEST(MeanTurn, OfABallHasAClosedForm) {
  const Vec3 omega(3.0, -7.0, 4.0), tau(0.4, 0.3, -1.1);
  for (const double dt : {1e-3, 0.1, -0.05}) {
    Vec3 mean = omega;
    ASSERT_TRUE(try_mean_turn(0.3 * Mat3::Identity(), omega, tau, dt, mean));
    EXPECT_LT((mean_turn_of_a_ball(0.3, omega, tau, dt) - mean).norm(), 1e-14 * mean.norm());
  }
}

}  // namespace
}  // namespace polhode::mean_turn_tests
