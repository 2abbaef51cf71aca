// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>

#include <math/sample_rotations.hpp>
#include <polhode/math/exp_map.hpp>
#include <polhode/math/hat.hpp>

namespace polhode::identities_tests {
namespace {

using test::distance;

/// Laws that hold between the spec's ways of writing a rotation. The permutation tensor times χ is
/// −χ̂ (see hat_test).
class Identities : public testing::TestWithParam<Vec3> {
 protected:
  Vec3 chi_ = GetParam();
  double angle_ = chi_.norm();
  Mat3 E_chi_ = -hat(chi_);  // ε·χ
};
INSTANTIATE_TEST_SUITE_P(Vectors, Identities, testing::ValuesIn(test::sample_vectors()));

// @tests{eq:rbr-identity-1}
TEST_P(Identities, CosineInTermsOfTheHalfAngle) {
  const double s = std::sin(0.5 * angle_);
  EXPECT_NEAR(std::cos(angle_), 1.0 - 2.0 * s * s, 4e-16);
}

// @tests{eq:rbr-identity-2}
TEST_P(Identities, SquareOfTheAntisymmetricTensor) {
  const Mat3 other = chi_ * chi_.transpose() - angle_ * angle_ * Mat3::Identity();
  EXPECT_LE(distance(E_chi_ * E_chi_, other), 1e-15 * angle_ * angle_);
}

// @tests{eq:rbr-rotation-tensor} @tests{eq:rbr-rotation-tensor-alt-1}
// @tests{eq:rbr-rotation-tensor-alt-2}
TEST_P(Identities, ThreeFormsOfTheRotationTensorAgree) {
  if (angle_ == 0.0) {
    EXPECT_EQ(exp_map(chi_), Mat3::Identity());  // the other forms divide by the angle
    return;
  }
  const Vec3 n = chi_ / angle_;
  const double c = std::cos(angle_);
  const double s = std::sin(angle_);
  const double s_half = std::sin(0.5 * angle_);
  const Mat3 E_n = -hat(n);
  const Mat3 first = c * Mat3::Identity() - s * E_n + (1.0 - c) * n * n.transpose();
  const Mat3 second = Mat3::Identity() - s / angle_ * E_chi_ +
                      2.0 / (angle_ * angle_) * s_half * s_half * E_chi_ * E_chi_;
  EXPECT_LT(distance(exp_map(chi_), first), 1e-15);
  EXPECT_LT(distance(exp_map(chi_), second), 1e-15);
}

}  // namespace
}  // namespace polhode::identities_tests
