// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <dynamics/sample_step.hpp>
#include <polhode/dynamics/body_step.hpp>
#include <support/derivative.hpp>

namespace polhode::body_step_tests {
namespace {

const Vec3 kZ(0.3, -1.1, 0.7);

class BodyStepAt : public testing::TestWithParam<double> {
 protected:
  test::SampleStep sample_{GetParam()};
  BodyStep step_ = sample_.step();
  double af_ = step_.alpha_f;

  /// Derivative by (Δr, Δθ) from the parts that the theory gives.
  static Mat tangent(const Mat3& D_r, const Mat3& D_theta) {
    Mat D(3, 6);
    D << D_r, D_theta;
    return D;
  }
};
INSTANTIATE_TEST_SUITE_P(SpectralRadius, BodyStepAt, testing::Values(0.0, 0.5, 0.9, 1.0));

// @tests{ga-z-interpolation}
TEST_P(BodyStepAt, AveragesVectorsFixedInTheBody) {
  const Carried z = step_.vector(kZ);
  EXPECT_LT((z.at_n - step_.Lambda_n * kZ).norm(), 1e-15);
  EXPECT_LT((z.at_n1 - step_.Lambda_n1 * kZ).norm(), 1e-15);
  EXPECT_LT((z.at_alpha - ((1.0 - af_) * step_.Lambda_n + af_ * step_.Lambda_n1) * kZ).norm(),
            1e-15);
  // Λ_{n+αf} is no rotation: z_{n+αf} is shorter than Z unless α_f = 1.
  EXPECT_EQ(z.at_alpha.norm() < kZ.norm() - 1e-6, af_ < 1.0);
}

// @tests{eq:rbm-position}
TEST_P(BodyStepAt, PutsAPointAtItsArmFromTheCentreOfMass) {
  const Carried x = step_.point(kZ);
  const Carried z = step_.vector(kZ);
  EXPECT_LT((x.at_n - step_.r_n - z.at_n).norm(), 1e-15);
  EXPECT_LT((x.at_n1 - step_.r_n1 - z.at_n1).norm(), 1e-15);
  EXPECT_LT((x.at_alpha - ((1.0 - af_) * x.at_n + af_ * x.at_n1)).norm(), 1e-15);
}

// @tests{ga-z-tangent}
TEST_P(BodyStepAt, HasTheTangentOfAnAveragedVectorAndPoint) {
  const Mat3 D_theta = -af_ * hat(step_.vector(kZ).at_n1);
  test::expect_derivative(
      tangent(Mat3::Zero(), D_theta),
      [&](const Vec& d) -> Vec { return sample_.displaced(d).vector(kZ).at_alpha; }, "z_alpha");
  test::expect_derivative(
      tangent(af_ * Mat3::Identity(), D_theta),
      [&](const Vec& d) -> Vec { return sample_.displaced(d).point(kZ).at_alpha; }, "x_alpha");
}

// @tests{joint-carried-difference}
TEST_P(BodyStepAt, ChangesABodyFixedVectorByThetaTimesItsMean) {
  const Carried z = step_.vector(kZ);
  EXPECT_LT((z.at_n1 - z.at_n - step_.theta.cross(0.5 * (z.at_n + z.at_n1))).norm(), 1e-15);
}

TEST_P(BodyStepAt, HasTheTangentOfItsAngularVelocity) {
  test::expect_derivative(
      tangent(Mat3::Zero(), step_.omega_alpha_tangent()),
      [&](const Vec& d) -> Vec { return sample_.displaced(d).omega_alpha(); }, "omega_alpha");
}

TEST_P(BodyStepAt, HasTheTangentOfItsVelocity) {
  test::expect_derivative(
      tangent(af_ * step_.rate * Mat3::Identity(), Mat3::Zero()),
      [&](const Vec& d) -> Vec { return sample_.displaced(d).velocity_alpha(); }, "velocity_alpha");
}

TEST(BodyStep, HasMeanRatesThatMakeTheStepWithoutDamping) {
  const test::SampleStep sample(1.0);
  const BodyStep step = sample.step();
  EXPECT_LT((sample.context.dt * step.velocity_alpha() - step.u).norm(), 1e-15);
  EXPECT_LT((sample.context.dt * step.omega_alpha() - step.theta).norm(), 1e-15);
}

TEST(BodyStep, OfTheGroundDoesNotMove) {
  const BodyStep ground = BodyStep::ground(0.6);
  EXPECT_FALSE(ground.moves);
  EXPECT_EQ(ground.point(kZ).at_n1, kZ);
  EXPECT_LT((ground.point(kZ).at_alpha - kZ).norm(), 1e-15);
  EXPECT_EQ(ground.omega_alpha(), Vec3::Zero());
}

TEST(BodyStep, AtAnInstantHasOneConfigurationThroughout) {
  const test::SampleStep sample(0.5);
  const BodyStep s =
      BodyStep::at_instant(sample.at_n.r, sample.at_n.Lambda(), sample.at_n.v, sample.at_n.W);
  EXPECT_EQ(s.point(kZ).at_n, s.point(kZ).at_n1);
  EXPECT_EQ(s.velocity_alpha(), sample.at_n.v);
  EXPECT_LT((s.omega_alpha() - sample.at_n.omega()).norm(), 1e-15);
}

}  // namespace
}  // namespace polhode::body_step_tests
