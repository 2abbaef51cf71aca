// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <dynamics/known_motion.hpp>
#include <polhode/dynamics/point_motion.hpp>

namespace polhode::point_motion_tests {
namespace {

constexpr double kStep = 1e-5;       // central difference: truncation h² = 1e-10, rounding 1e-11
constexpr double kTolerance = 3e-9;  // third derivatives of the motion are up to 30
constexpr double kTimes[] = {0.0, 0.37, 1.2};
const Vec3 kZ(0.3, -1.1, 0.7);

class PointMotion : public testing::TestWithParam<double> {
 protected:
  test::KnownMotion motion_;
  double t_ = GetParam();
  Pose pose_ = motion_.pose(t_);
  Velocities velocities_ = motion_.velocities(t_);
  Accelerations accelerations_ = motion_.accelerations(t_);
};
INSTANTIATE_TEST_SUITE_P(Times, PointMotion, testing::ValuesIn(kTimes));

// @tests{eq:rbm-position}
TEST_P(PointMotion, KeepsTheBodyRigid) {
  const Vec3 other(-0.2, 0.4, 0.9);
  EXPECT_EQ(point_position(pose_, Vec3::Zero()), pose_.r);
  EXPECT_NEAR((point_position(pose_, kZ) - point_position(pose_, other)).norm(),
              (kZ - other).norm(), 1e-14);
}

// @tests{eq:rbm-velocity} @tests{eq:rbm-rigid-point-velocity}
TEST_P(PointMotion, HasTheVelocityOfItsPosition) {
  const Vec3 differenced = (point_position(motion_.pose(t_ + kStep), kZ) -
                            point_position(motion_.pose(t_ - kStep), kZ)) /
                           (2.0 * kStep);
  const Vec3 x_dot = point_velocity(pose_, velocities_, kZ);
  EXPECT_LT((x_dot - differenced).norm(), kTolerance);
  // ẋ = ṙ + Λ̇·Z, and the material form ẋ = ṙ + Λ·Ŵ·Z.
  const Vec3 W = to_material(pose_.Lambda, velocities_.omega);
  EXPECT_LT(
      (x_dot - velocities_.r_dot - rotation_rate(pose_.Lambda, velocities_.omega) * kZ).norm(),
      1e-14);
  EXPECT_LT((x_dot - velocities_.r_dot - pose_.Lambda * hat(W) * kZ).norm(), 1e-14);
}

// @tests{eq:rbm-rigid-point-acceleration}
TEST_P(PointMotion, HasTheAccelerationOfItsVelocity) {
  const Vec3 differenced =
      (point_velocity(motion_.pose(t_ + kStep), motion_.velocities(t_ + kStep), kZ) -
       point_velocity(motion_.pose(t_ - kStep), motion_.velocities(t_ - kStep), kZ)) /
      (2.0 * kStep);
  const Vec3 x_ddot = point_acceleration(pose_, velocities_, accelerations_, kZ);
  EXPECT_LT((x_ddot - differenced).norm(), kTolerance);
  const Mat3& Lambda = pose_.Lambda;
  const Vec3 W = to_material(Lambda, velocities_.omega);
  const Vec3 A = to_material(Lambda, accelerations_.alpha);
  const Vec3 material = accelerations_.r_ddot + Lambda * (hat(A) + hat(W) * hat(W)) * kZ;
  EXPECT_LT((x_ddot - material).norm(), 1e-13);
}

// @tests{eq:rbm-lambda-dot}
TEST_P(PointMotion, TurnsTheRotationAtTheRateOfItsAngularVelocity) {
  const Mat3 differenced =
      (motion_.pose(t_ + kStep).Lambda - motion_.pose(t_ - kStep).Lambda) / (2.0 * kStep);
  const Mat3 rate = rotation_rate(pose_.Lambda, velocities_.omega);
  EXPECT_LT((rate - differenced).norm(), kTolerance);
  const Vec3 W = to_material(pose_.Lambda, velocities_.omega);
  EXPECT_LT((rate - pose_.Lambda * hat(W)).norm(), 1e-14);
}

// @tests{eq:rbm-material-spatial-angular-velocity}
TEST_P(PointMotion, CarriesTheAngularVelocityAsVectorAndAsTensor) {
  const Mat3& Lambda = pose_.Lambda;
  const Vec3 W = to_material(Lambda, velocities_.omega);
  EXPECT_LT((to_spatial(Lambda, W) - velocities_.omega).norm(), 1e-15);
  EXPECT_LT((hat(velocities_.omega) - Lambda * hat(W) * Lambda.transpose()).norm(), 1e-14);
}

TEST_P(PointMotion, HasTheMaterialAngularAccelerationThatIsTheRateOfTheMaterialVelocity) {
  const auto W = [&](double t) {
    return to_material(motion_.pose(t).Lambda, motion_.velocities(t).omega);
  };
  const Vec3 differenced = (W(t_ + kStep) - W(t_ - kStep)) / (2.0 * kStep);
  EXPECT_LT((to_material(pose_.Lambda, accelerations_.alpha) - differenced).norm(), kTolerance);
}

}  // namespace
}  // namespace polhode::point_motion_tests
