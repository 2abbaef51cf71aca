// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <math/sample_rotations.hpp>
#include <polhode/math/cayley.hpp>
#include <polhode/math/exp_map.hpp>
#include <polhode/math/quaternion.hpp>

namespace polhode::quaternion_tests {
namespace {

using test::distance;

class Quaternion : public testing::TestWithParam<Vec3> {
 protected:
  Vec3 chi_ = GetParam();
};
INSTANTIATE_TEST_SUITE_P(Vectors, Quaternion, testing::ValuesIn(test::sample_vectors()));

// @tests{ga-cay-as-exp}
TEST_P(Quaternion, OfACayleyVectorIsItsCayleyTransform) {
  const Quat q = quaternion_from_cayley(chi_);
  EXPECT_LT(distance(q.toRotationMatrix(), cay(chi_)), 1e-15);
  EXPECT_NEAR(q.norm(), 1.0, 3e-16);
  const double angle = 2.0 * std::atan(0.5 * chi_.norm());
  EXPECT_NEAR(q.w(), std::cos(0.5 * angle), 3e-16);
  const Vec3 n = chi_.normalized();  // zero for no rotation
  EXPECT_LT(distance(q.toRotationMatrix(), exp_map(angle * n)), 2e-15);
}

TEST_P(Quaternion, OfARotationVectorIsItsExponential) {
  const Quat q = quaternion_from_rotation_vector(chi_);
  EXPECT_LT(distance(q.toRotationMatrix(), exp_map(chi_)), 1e-15);
  EXPECT_LT(distance(rotation_vector(q), chi_), 1e-15);
}

TEST_P(Quaternion, MultipliesAsTheRotationsDo) {
  const Vec3 other(0.4, 1.3, -0.2);
  const Quat product = quaternion_from_cayley(other) * quaternion_from_cayley(chi_);
  EXPECT_LT(distance(product.toRotationMatrix(), cay(other) * cay(chi_)), 2e-15);
}

TEST_P(Quaternion, IsTheSameRotationWithOppositeSign) {
  const Quat q = quaternion_from_rotation_vector(chi_);
  const Quat opposite(-q.w(), -q.x(), -q.y(), -q.z());
  EXPECT_LT(distance(rotation_vector(opposite), chi_), 1e-15);
  EXPECT_GE(shown(opposite).w(), 0.0);
  EXPECT_EQ(shown(opposite).coeffs(), shown(q).coeffs());
}

TEST(Quaternion, StaysAccurateOverAMillionCompositions) {
  // One turn in a million steps and back at the start: rounding grows like a random walk at most.
  const int steps = 1'000'000;
  const Vec3 theta = 2.0 * std::tan(std::numbers::pi / steps) * Vec3(0.6, 0.0, 0.8);
  const Quat step = quaternion_from_cayley(theta);
  Quat q = Quat::Identity();
  for (int i = 0; i < steps; ++i) q = (step * q).normalized();
  EXPECT_LT(rotation_vector(q).norm(), 1e-16 * steps);
}

}  // namespace
}  // namespace polhode::quaternion_tests
