// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>

#include <polhode/dynamics/newmark_rotation.hpp>
#include <polhode/dynamics/newmark_translation.hpp>
#include <polhode/math/exp_map.hpp>
#include <support/derivative.hpp>

namespace polhode::newmark_tests {
namespace {

constexpr double kDt = 0.1;

class Newmark : public testing::TestWithParam<double> {
 protected:
  GeneralizedAlpha ga_ = GeneralizedAlpha::from_spectral_radius(GetParam());
  double beta_ = ga_.beta;
  double gamma_ = ga_.gamma;
  Vec3 x_n_ = Vec3(0.4, -0.2, 1.1);     // velocity, linear or angular
  Vec3 y_n_ = Vec3(-2.0, 3.0, 0.7);     // acceleration
  Vec3 step_ = Vec3(0.06, 0.03, 0.09);  // displacement, or material Cayley vector
};
INSTANTIATE_TEST_SUITE_P(SpectralRadius, Newmark, testing::Values(0.0, 0.5, 0.9, 1.0));

// @tests{eq:td-Newmark-COM}
TEST_P(Newmark, MovesTheCentreOfMassByTheRuleAsPrinted) {
  const auto [v, a] = newmark_translation(step_, {x_n_, y_n_}, ga_, kDt);
  const Vec3 printed_a =
      1.0 / (beta_ * kDt) * (step_ / kDt - x_n_) + (1.0 - 1.0 / (2.0 * beta_)) * y_n_;
  EXPECT_LT((a - printed_a).norm(), 1e-13);
  EXPECT_LT((v - (x_n_ + kDt * ((1.0 - gamma_) * y_n_ + gamma_ * a))).norm(), 1e-14);
}

TEST_P(Newmark, IsExactForAConstantAcceleration) {
  const Vec3 u = kDt * x_n_ + 0.5 * kDt * kDt * y_n_;
  const auto [v, a] = newmark_translation(u, {x_n_, y_n_}, ga_, kDt);
  EXPECT_LT((v - (x_n_ + kDt * y_n_)).norm(), 1e-15);
  EXPECT_LT((a - y_n_).norm(), 1e-13);
}

// @tests{eq:td-Newmark-mrot}
TEST_P(Newmark, TurnsABodyByTheRuleAsPrinted) {
  const auto [W, A] = newmark_rotation(step_, {x_n_, y_n_}, ga_, kDt);
  const Vec3 printed_W =
      gamma_ / (beta_ * kDt) * step_ - x_n_ + (2.0 - gamma_ / beta_) * (x_n_ + 0.5 * kDt * y_n_);
  EXPECT_LT((W - printed_W).norm(), 1e-14);
  EXPECT_LT((A - ((W - x_n_) / (gamma_ * kDt) + (1.0 - 1.0 / gamma_) * y_n_)).norm(), 1e-13);
  EXPECT_LT((A - (1.0 / (beta_ * kDt) * (step_ / kDt - x_n_) + (1.0 - 0.5 / beta_) * y_n_)).norm(),
            1e-13);
}

// @tests{eq:td-Newmark-srot}
TEST_P(Newmark, IsTheSameRuleInSpace) {
  const Mat3 Lambda_n = exp_map(Vec3(0.3, 0.8, -0.5));
  const auto [W, A] = newmark_rotation(step_, {x_n_, y_n_}, ga_, kDt);
  const Vec3 theta = Lambda_n * step_;
  const Vec3 omega_n = Lambda_n * x_n_;
  const Vec3 alpha_n = Lambda_n * y_n_;
  const Mat3 Lambda_n1 = cay(theta) * Lambda_n;
  const Vec3 omega = cay(theta) * (gamma_ / (beta_ * kDt) * theta - omega_n +
                                   (2.0 - gamma_ / beta_) * (omega_n + 0.5 * kDt * alpha_n));
  const Vec3 alpha =
      cay(theta) * (1.0 / (beta_ * kDt) * (theta / kDt - omega_n) + (1.0 - 0.5 / beta_) * alpha_n);
  EXPECT_LT((Lambda_n1 * W - omega).norm(), 1e-14);
  EXPECT_LT((Lambda_n1 * A - alpha).norm(), 1e-13);
}

// @tests{eq:tf-W-A-linearizations} @tests{td-Theta-linearization}
TEST_P(Newmark, HasTheTangentsOfItsRates) {
  const auto rates = [&](const Vec& d) {
    const Vec3 Theta = cayley_vector(cay(step_) * cay(Vec3(d)));
    return newmark_rotation(Theta, {x_n_, y_n_}, ga_, kDt);
  };
  const RatesTangent tangent = rates_tangent(step_, ga_, kDt);
  test::expect_derivative(
      tangent.D_W, [&](const Vec& d) -> Vec { return rates(d).W; }, "D_W");
  test::expect_derivative(
      tangent.D_A, [&](const Vec& d) -> Vec { return rates(d).A; }, "D_A");
}

TEST(NewmarkWithoutDamping, DoesNotUseTheStoredAcceleration) {
  const GeneralizedAlpha ga = GeneralizedAlpha::from_spectral_radius(1.0);
  const Vec3 u(0.06, 0.03, 0.09);
  const Vec3 v_n(0.4, -0.2, 1.1);
  const Vec3 noise(1e12, -1e12, 1e12);
  EXPECT_EQ(newmark_translation(u, {v_n, noise}, ga, kDt).v,
            newmark_translation(u, {v_n, Vec3::Zero()}, ga, kDt).v);
  EXPECT_EQ(newmark_rotation(u, {v_n, noise}, ga, kDt).W,
            newmark_rotation(u, {v_n, Vec3::Zero()}, ga, kDt).W);
}

}  // namespace
}  // namespace polhode::newmark_tests
