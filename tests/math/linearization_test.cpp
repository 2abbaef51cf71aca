// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <math/sample_rotations.hpp>
#include <polhode/math/cayley.hpp>
#include <polhode/math/exp_map.hpp>

namespace polhode::linearization_tests {
namespace {

using test::distance;

/// Derivative of a rotation along an increment at ε = 0. A step of 1e-5 leaves 1e-10 of
/// truncation, 1e-11 of rounding.
template <class Rotation>
Mat3 derivative(const Rotation& rotation) {
  const double step = 1e-5;
  return (rotation(step) - rotation(-step)) / (2.0 * step);
}
constexpr double kTolerance = 1e-9;

class Linearization : public testing::TestWithParam<Vec3> {
 protected:
  Mat3 Lambda_ = exp_map(GetParam());
  Vec3 increment_ = Vec3(0.7, -0.3, 0.4);
};
INSTANTIATE_TEST_SUITE_P(Vectors, Linearization, testing::ValuesIn(test::sample_vectors()));

// @tests{eq:rbr-spatial-rotation-increment} @tests{eq:rbr-spatial-rotation-linearization}
TEST_P(Linearization, AlongASpatialIncrementIsAHatFromTheLeft) {
  const Mat3 expected = hat(increment_) * Lambda_;
  const auto by_cay = [&](double e) -> Mat3 { return cay(e * increment_) * Lambda_; };
  const auto by_exp = [&](double e) -> Mat3 { return exp_map(e * increment_) * Lambda_; };
  EXPECT_LT(distance(derivative(by_cay), expected), kTolerance);
  EXPECT_LT(distance(derivative(by_exp), expected), kTolerance);
}

// @tests{eq:rbr-material-rotation-increment} @tests{eq:td-linearization-Lambda}
TEST_P(Linearization, AlongAMaterialIncrementIsAHatFromTheRight) {
  const auto turned = [&](double e) -> Mat3 { return Lambda_ * cay(e * increment_); };
  EXPECT_LT(distance(derivative(turned), Lambda_ * hat(increment_)), kTolerance);
}

// @tests{eq:td-linearization-rot} @tests{td-Theta-linearization}
TEST_P(Linearization, OfTheStepsRotationMovesItsCayleyVectorByT) {
  const Vec3 Theta = GetParam();
  const auto turned = [&](double e) -> Mat3 {
    return cay(Theta + cayley_tangent(Theta) * (e * increment_));
  };
  EXPECT_LT(distance(derivative(turned), cay(Theta) * hat(increment_)), kTolerance);
}

}  // namespace
}  // namespace polhode::linearization_tests
