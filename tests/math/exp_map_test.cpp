// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <math/sample_rotations.hpp>
#include <polhode/math/exp_map.hpp>
#include <polhode/math/hat.hpp>

namespace polhode::exp_map_tests {
namespace {

using std::numbers::pi;
using test::distance;

class ExpMap : public testing::TestWithParam<Vec3> {
 protected:
  Vec3 chi_ = GetParam();
  Mat3 Lambda_ = exp_map(chi_);
};
INSTANTIATE_TEST_SUITE_P(Vectors, ExpMap, testing::ValuesIn(test::sample_vectors()));

TEST_P(ExpMap, IsAProperRotationThatKeepsItsAxis) {
  EXPECT_LT(distance(Lambda_ * Lambda_.transpose(), Mat3::Identity()), 2e-15);
  EXPECT_NEAR(Lambda_.determinant(), 1.0, 2e-15);
  EXPECT_LT(distance(Lambda_ * chi_, chi_), 2e-15);
  EXPECT_NEAR(Lambda_.trace(), 1.0 + 2.0 * std::cos(chi_.norm()), 2e-15);
}

// @tests{eq:rbr-rotation-tensor-alt-2}
TEST_P(ExpMap, IsTheSeriesOfTheExponential) {
  Mat3 term = Mat3::Identity();
  Mat3 sum = term;
  for (int k = 1; k <= 40; ++k) {  // |χ|⁴⁰/40! < 1e-27 for the largest sample
    term = term * hat(chi_) / k;
    sum += term;
  }
  EXPECT_LT(distance(Lambda_, sum), 4e-15);
}

TEST_P(ExpMap, AddsAnglesAboutOneAxis) {
  EXPECT_LT(distance(exp_map(0.3 * chi_) * exp_map(0.7 * chi_), Lambda_), 2e-15);
  EXPECT_LT(distance(exp_map(-chi_), Lambda_.transpose()), 1e-15);
}

TEST_P(ExpMap, IsInvertedByTheLogarithm) {
  EXPECT_LT(distance(log_map(Lambda_), chi_), 4e-15);  // every sample is below π
}

// @tests{eq:rbr-orthogonal-transformation}
TEST_P(ExpMap, TransformsWithAnOrthogonalTensor) {
  const Mat3 Q = exp_map(Vec3(-0.6, 1.4, 0.2));
  EXPECT_LT(distance(Q * Lambda_ * Q.transpose(), exp_map(Q * chi_)), 2e-15);
  EXPECT_LT(distance(Q * hat(chi_) * Q.transpose(), hat(Q * chi_)), 2e-15);
}

TEST_P(ExpMap, ReversesTheAxisUnderAReflection) {
  // For det Q = −1 the axial vector of Q χ̂ Qᵀ is det(Q)·Q·χ.
  const Mat3 Q = -exp_map(Vec3(-0.6, 1.4, 0.2));
  EXPECT_LT(distance(Q * Lambda_ * Q.transpose(), exp_map(-Q * chi_)), 2e-15);
}

TEST(LogMap, HasAnAngleOfAtMostPi) {
  const Vec3 n = Vec3(0.6, 0.0, 0.8);
  EXPECT_NEAR(log_map(exp_map(4.0 * n)).norm(), 2.0 * pi - 4.0, 4e-15);
  const Vec3 half_turn = log_map(exp_map(pi * n));  // either direction of the axis
  EXPECT_NEAR(half_turn.norm(), pi, 4e-15);
  EXPECT_NEAR(std::abs(half_turn.dot(n)), pi, 4e-15);
}

TEST(ExpMap, IsSmoothWhereTheSeriesTakesOver) {
  const Vec3 n = Vec3(0.48, -0.6, 0.64);
  for (const double angle : {0.99999e-4, 1.00001e-4}) {
    const Mat3 direct = Mat3::Identity() + std::sin(angle) * hat(n) +
                        2.0 * std::pow(std::sin(0.5 * angle), 2) * hat(n) * hat(n);
    EXPECT_LT(distance(exp_map(angle * n), direct), 3e-16);
  }
}

}  // namespace
}  // namespace polhode::exp_map_tests
