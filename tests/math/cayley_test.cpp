// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <math/sample_rotations.hpp>
#include <polhode/core/error.hpp>
#include <polhode/math/cayley.hpp>
#include <polhode/math/exp_map.hpp>
#include <support/derivative.hpp>

namespace polhode::cayley_tests {
namespace {

using test::distance;

class Cayley : public testing::TestWithParam<Vec3> {
 protected:
  Vec3 chi_ = GetParam();
};
INSTANTIATE_TEST_SUITE_P(Vectors, Cayley, testing::ValuesIn(test::sample_vectors()));

// @tests{eq:rbr-Cayley-transform}
TEST_P(Cayley, IsTheFractionOfTwoLinearForms) {
  // cay[χ] = (I − χ̂/2)⁻¹ (I + χ̂/2), the classical Cayley transform.
  const Mat3 I = Mat3::Identity();
  const Mat3 half = 0.5 * hat(chi_);
  EXPECT_LT(distance((I - half) * cay(chi_), I + half), 4e-15);
  EXPECT_LT(distance(cay(chi_) * cay(chi_).transpose(), I), 2e-15);
  EXPECT_NEAR(cay(chi_).determinant(), 1.0, 2e-15);
}

// @tests{eq:exponential-Cayley-relation}
TEST_P(Cayley, TurnsByTwiceTheArctangentOfHalfTheLength) {
  const double length = chi_.norm();
  if (length == 0.0) {
    EXPECT_EQ(cay(chi_), Mat3::Identity());
    return;
  }
  const Vec3 n = chi_ / length;
  const double angle = 2.0 * std::atan(0.5 * length);
  EXPECT_LT(distance(cay(chi_), exp_map(angle * n)), 2e-15);
  EXPECT_LT(distance(cay(2.0 * std::tan(0.5 * angle) * n), exp_map(angle * n)), 2e-15);
}

TEST_P(Cayley, IsInvertedByTheCayleyVector) {
  EXPECT_LT(distance(cayley_vector(cay(chi_)), chi_), 1e-15 * (4.0 + chi_.squaredNorm()));
}

TEST_P(Cayley, HasTheInverseOfItsOppositeVector) {
  EXPECT_LT(distance(cay(-chi_), cay(chi_).transpose()), 1e-16);
}

// @tests{eq:ga-Newton-iterations}
TEST_P(Cayley, ComposesWithoutLeavingItsVectors) {
  for (const Vec3& other : test::sample_vectors()) {
    const Vec3 product = compose_cayley(other, chi_);
    if (product.norm() > 1e3) continue;  // within 0.1 degrees of a half turn
    EXPECT_LT(distance(cay(product), cay(other) * cay(chi_)), 4e-15);
  }
  EXPECT_EQ(compose_cayley(Vec3::Zero(), chi_), chi_);
  EXPECT_EQ(compose_cayley(chi_, Vec3::Zero()), chi_);
  EXPECT_LT(compose_cayley(-chi_, chi_).norm(), 1e-15);
}

// @tests{td-Theta-linearization} @tests{eq:td-T-Theta-relation}
TEST_P(Cayley, HasTheTangentOfARightIncrement) {
  test::expect_derivative(
      cayley_tangent(chi_),
      [&](const Vec& d) -> Vec { return cayley_vector(cay(chi_) * cay(Vec3(d))); }, "T");
}

TEST_P(Cayley, HasTheTransposedTangentOfALeftIncrement) {
  test::expect_derivative(
      cayley_tangent(chi_).transpose(),
      [&](const Vec& d) -> Vec { return cayley_vector(cay(Vec3(d)) * cay(chi_)); }, "T transposed");
}

TEST_P(Cayley, HasATangentWithAClosedInverseAndDeterminant) {
  const double size = 1.0 + 0.25 * chi_.squaredNorm();
  EXPECT_LT(distance(cayley_tangent(chi_) * cayley_tangent_inverse(chi_), Mat3::Identity()), 1e-15);
  EXPECT_NEAR(cayley_tangent(chi_).determinant(), size * size, 4e-15 * size * size);
  // T = cay·Tᵀ turns the right increment into the left one.
  EXPECT_LT(distance(cayley_tangent(chi_), cay(chi_) * cayley_tangent(chi_).transpose()), 4e-15);
}

TEST(Cayley, ApproximatesTheExponentialToSecondOrder) {
  // The angle of cay[s n] is s − s³/12 + …: halving s divides the difference by eight.
  const Vec3 n(0.48, -0.6, 0.64);
  const auto difference = [&](double s) { return (cay(s * n) - exp_map(s * n)).norm(); };
  EXPECT_NEAR(std::log2(difference(0.02) / difference(0.01)), 3.0, 1e-3);
}

TEST(CayleyVector, OfAHalfTurnDoesNotExist) {
  const Mat3 half_turn = Vec3(-1.0, -1.0, 1.0).asDiagonal();
  EXPECT_FALSE(try_cayley_vector(half_turn).has_value());
  try {
    (void)cayley_vector(half_turn);
    FAIL() << "a half turn has no Cayley vector";
  } catch (const InputError& e) {
    EXPECT_STREQ(e.what(),
                 "cayley_vector: the rotation angle is π, which no Cayley vector represents. Take "
                 "a smaller time step, so that a body turns by less than π in it.");
  }
}

TEST(CayleyVector, ReachesCloseToAHalfTurn) {
  const double angle = std::numbers::pi - 1e-4;
  const Vec3 n(0.6, 0.0, 0.8);
  const Vec3 chi = cayley_vector(exp_map(angle * n));
  // The entries of the rotation are known to 1e-16; near π the vector is 1e4 times as sensitive,
  // squared.
  EXPECT_LT(distance(chi, 2.0 * std::tan(0.5 * angle) * n) / chi.norm(), 1e-7);
}

}  // namespace
}  // namespace polhode::cayley_tests
