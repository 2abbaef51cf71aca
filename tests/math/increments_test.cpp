// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <math/sample_rotations.hpp>
#include <polhode/math/cayley.hpp>
#include <polhode/math/exp_map.hpp>

namespace polhode::increments_tests {
namespace {

using test::distance;

/// The rotation from t to t', by a spatial increment θ and by a material one Θ.
class Increments : public testing::TestWithParam<Vec3> {
 protected:
  Vec3 Z_ = Vec3(0.3, -1.1, 0.7);
  Mat3 Lambda_ = exp_map(Vec3(0.9, -0.2, 0.5));  // Λ(t)
  Vec3 Theta_ = GetParam();
  Vec3 theta_ = Lambda_ * Theta_;
};
INSTANTIATE_TEST_SUITE_P(Vectors, Increments, testing::ValuesIn(test::sample_vectors()));

// @tests{eq:rbr-rotation-t} @tests{eq:rbr-orthogonal-rotation-t-prime}
// @tests{eq:rbr-incremental-finite-rotation}
TEST_P(Increments, CarryAVectorTheSameWayInEitherFrame) {
  const Vec3 z = Lambda_ * Z_;
  EXPECT_NEAR(z.norm(), Z_.norm(), 1e-15);
  const Vec3 spatial = exp_map(theta_) * z;
  const Vec3 material = Lambda_ * (exp_map(Theta_) * Z_);
  EXPECT_LT(distance(spatial, material), 2e-15);
}

// @tests{eq:rbr-material-spatial-increments} @tests{eq:rbr-material-spatial-redux}
TEST_P(Increments, AreTheSameVectorInTwoFrames) {
  EXPECT_LT(distance(exp_map(theta_) * Lambda_, Lambda_ * exp_map(Theta_)), 2e-15);
  EXPECT_LT(distance(exp_map(theta_), Lambda_ * exp_map(Theta_) * Lambda_.transpose()), 2e-15);
  EXPECT_LT(distance(hat(theta_), Lambda_ * hat(Theta_) * Lambda_.transpose()), 2e-15);
  EXPECT_NEAR(theta_.norm(), Theta_.norm(), 1e-15);
  // The increment is along the axis of its own rotation, so the frame at t' gives the same θ.
  EXPECT_LT(distance(Lambda_ * exp_map(Theta_) * Theta_, theta_), 2e-15);
}

// @tests{eq:td-incremental-rotation}
TEST_P(Increments, OfTheCayleyTransformObeyTheSameRule) {
  EXPECT_LT(distance(cay(theta_) * Lambda_, Lambda_ * cay(Theta_)), 2e-15);
}

// @tests{eq:ga-rotation-iterations} @tests{eq:ga-Newton-iterations}
TEST_P(Increments, OfNewtonAreComposedFromTheLeft) {
  const Vec3 Delta_theta(0.02, -0.05, 0.01);
  const Mat3 Lambda_n1 = cay(theta_) * Lambda_;
  const Mat3 updated = cay(compose_cayley(Delta_theta, theta_)) * Lambda_;
  EXPECT_LT(distance(updated, cay(Delta_theta) * Lambda_n1), 4e-15);
}

}  // namespace
}  // namespace polhode::increments_tests
