// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <dynamics/known_motion.hpp>
#include <polhode/dynamics/energy.hpp>
#include <polhode/dynamics/momentum.hpp>
#include <polhode/geometry/mass_properties.hpp>

namespace polhode::momentum_tests {
namespace {

constexpr double kStep = 1e-5;       // central difference: truncation h² = 1e-10, rounding 1e-11
constexpr double kTolerance = 1e-8;  // third derivatives of the momenta are up to 300
constexpr double kMass = 2.5;

class Momentum : public testing::TestWithParam<double> {
 protected:
  Vec3 p(double t) const { return linear_momentum(kMass, motion_.velocities(t).r_dot); }
  Mat3 J(double t) const { return geometry::inertia_at(motion_.pose(t).Lambda, J_r_); }
  Vec3 h(double t) const { return angular_momentum(J(t), motion_.velocities(t).omega); }
  double energy(double t) const {
    return kinetic_energy(kMass, J(t), motion_.velocities(t).r_dot, motion_.velocities(t).omega);
  }

  test::KnownMotion motion_;
  Mat3 J_r_ = geometry::inertia_at(exp_map(Vec3(0.2, 0.5, -0.4)), Vec3(1.0, 2.0, 2.7).asDiagonal());
  double t_ = GetParam();
};
INSTANTIATE_TEST_SUITE_P(Times, Momentum, testing::Values(0.0, 0.37, 1.2));

// @tests{eq:rbm-linear-momentum-balance}
TEST_P(Momentum, HasALinearRateOfMassTimesAcceleration) {
  const Vec3 differenced = (p(t_ + kStep) - p(t_ - kStep)) / (2.0 * kStep);
  const Vec3 p_dot = linear_momentum_rate(kMass, motion_.accelerations(t_).r_ddot);
  EXPECT_LT((p_dot - differenced).norm(), kTolerance);
}

// @tests{eq:rbm-angular-momentum-balance} @tests{ga-h-dot}
TEST_P(Momentum, HasAnAngularRateOfGyroscopicAndAccelerationParts) {
  const Vec3 differenced = (h(t_ + kStep) - h(t_ - kStep)) / (2.0 * kStep);
  const Vec3 omega = motion_.velocities(t_).omega;
  const Vec3 alpha = motion_.accelerations(t_).alpha;
  const Vec3 h_dot = angular_momentum_rate(J(t_), omega, alpha);
  EXPECT_LT((h_dot - differenced).norm(), kTolerance);
  // The material form ḣ = Λ·(Ŵ·J_r·W + J_r·A).
  const Mat3 Lambda = motion_.pose(t_).Lambda;
  const Vec3 W = to_material(Lambda, omega);
  const Vec3 A = to_material(Lambda, alpha);
  EXPECT_LT((h_dot - Lambda * (W.cross(J_r_ * W) + J_r_ * A)).norm(), 1e-13);
}

TEST_P(Momentum, AboutTheOriginIsThatOfTheBodysPoints) {
  // A body of four equal point masses: the sum of x × m ẋ over them.
  const Vec3 corners[] = {{0.5, 0.1, -0.3}, {-0.2, 0.6, 0.4}, {0.3, -0.5, 0.2}, {-0.6, -0.2, -0.3}};
  Mat3 J = Mat3::Zero();
  Vec3 expected = Vec3::Zero();
  const Pose pose = motion_.pose(t_);
  const Velocities velocities = motion_.velocities(t_);
  for (const Vec3& Z : corners) {  // their centroid is the origin
    J += kMass / 4.0 * (Z.squaredNorm() * Mat3::Identity() - Z * Z.transpose());
    expected += kMass / 4.0 * point_position(pose, Z).cross(point_velocity(pose, velocities, Z));
  }
  const Vec3 found = angular_momentum_about_origin(
      pose.r, linear_momentum(kMass, velocities.r_dot),
      angular_momentum(geometry::inertia_at(pose.Lambda, J), velocities.omega));
  EXPECT_LT((found - expected).norm(), 1e-14);
}

TEST_P(Momentum, GivesAKineticEnergyThatIsTheSameInBodyAxes) {
  const Vec3 W = to_material(motion_.pose(t_).Lambda, motion_.velocities(t_).omega);
  EXPECT_NEAR(energy(t_), kinetic_energy(kMass, J_r_, motion_.velocities(t_).r_dot, W), 1e-13);
}

// @tests{eq:rbm-virtual-work}
TEST_P(Momentum, RatesDoWorkEqualToTheChangeOfKineticEnergy) {
  // With δr = ṙ dt and δθ = ω dt, δW = 0 states that the work of force and moment equal to the
  // momentum rates is the increase of kinetic energy.
  const auto [r_dot, omega] = motion_.velocities(t_);
  const auto [r_ddot, alpha] = motion_.accelerations(t_);
  const double differenced = (energy(t_ + kStep) - energy(t_ - kStep)) / (2.0 * kStep);
  EXPECT_NEAR(power(r_dot, omega, linear_momentum_rate(kMass, r_ddot),
                    angular_momentum_rate(J(t_), omega, alpha)),
              differenced, 4e-8);  // the energy's third derivative is up to 1200
}

}  // namespace
}  // namespace polhode::momentum_tests
