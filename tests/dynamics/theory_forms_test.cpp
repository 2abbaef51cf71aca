// SPDX-License-Identifier: Apache-2.0
//
// The code's tangents against the formulas as the theory prints them, each factor by itself.
#include <gtest/gtest.h>

#include <dynamics/sample_step.hpp>
#include <polhode/dynamics/momentum.hpp>
#include <polhode/dynamics/newmark_rotation.hpp>
#include <polhode/geometry/mass_properties.hpp>
#include <polhode/math/exp_map.hpp>
#include <support/derivative.hpp>

namespace polhode::theory_forms_tests {
namespace {

const Vec3 kZ(0.3, -1.1, 0.7);
const Mat3 kJ_r =
    geometry::inertia_at(exp_map(Vec3(0.2, 0.5, -0.4)), Vec3(1.0, 2.0, 2.7).asDiagonal());

class TheoryForms : public testing::TestWithParam<double> {
 protected:
  Mat3 K_theta(MomentumRate form) const {
    return momentum_rates(1.0, kJ_r, sample_.at_n, step_, sample_.context, form).K_theta;
  }

  test::SampleStep sample_{GetParam()};
  const GeneralizedAlpha& ga_ = sample_.context.ga;
  double beta_ = ga_.beta;
  double gamma_ = ga_.gamma;
  double dt_ = sample_.context.dt;
  BodyStep step_ = sample_.step();
  Mat3 J_ = geometry::inertia_at(step_.Lambda_n1, kJ_r);  // at t_{n+1}, as all below
  Vec3 omega_ = step_.Lambda_n1 * step_.W_n1;
  Vec3 h_ = J_ * omega_;
  Mat3 T_ = cayley_tangent(step_.theta);
};
INSTANTIATE_TEST_SUITE_P(SpectralRadius, TheoryForms, testing::Values(0.0, 0.5, 0.9, 1.0));

// @tests{ga-moment-arm} @tests{ga-wrench-r-tangent} @tests{ga-moment-tangent}
TEST_P(TheoryForms, OfTheWrenchTangentOfAForceAtAPoint) {
  // An arbitrary force that depends on the position of its point: f = f_0 + B·x_{n+αf}.
  const Vec3 f_0(1.0, -2.0, 0.5);
  Mat3 B;
  B << -3.0, 0.4, 0.1, 0.2, -2.0, 0.6, -0.5, 0.3, -1.0;
  const auto force = [&](const BodyStep& s) -> Vec3 { return f_0 + B * s.point(kZ).at_alpha; };
  const auto wrench = [&](const Vec& d) -> Vec {
    const BodyStep s = sample_.displaced(d);
    Vec6 w;
    w << force(s), s.vector(kZ).at_alpha.cross(force(s));
    return w;
  };
  const Vec3 f = force(step_);
  const Vec3 z_alpha = step_.vector(kZ).at_alpha;
  const Vec3 z_n1 = step_.vector(kZ).at_n1;
  const Mat3 D_f_r = step_.alpha_f * B;
  const Mat3 D_f_theta = -step_.alpha_f * B * hat(z_n1);
  Mat6 D;
  D << D_f_r, D_f_theta,  //
      hat(z_alpha) * D_f_r, hat(z_alpha) * D_f_theta + step_.alpha_f * hat_hat(f, z_n1);
  test::expect_derivative(D, wrench, "wrench");
}

// @tests{ga-K-momentum-chain} @tests{ga-h-tangent} @tests{ga-K-momentum}
TEST_P(TheoryForms, OfTheTangentOfTheMomentum) {
  const Mat3 D_h = gamma_ / (beta_ * dt_) * J_ * T_ - hat(h_);
  test::expect_derivative(
      D_h,
      [&](const Vec& d) -> Vec {
        Vec whole = Vec::Zero(6);
        whole.tail(3) = d;
        const BodyStep s = sample_.displaced(whole);
        return s.Lambda_n1 * (kJ_r * s.W_n1);
      },
      "D_h");
  const Mat3 K = 1.0 / dt_ * (1.0 / (beta_ * dt_) * J_ * T_ - 1.0 / gamma_ * hat(h_));
  const Mat3 found = K_theta(MomentumRate::momentum);
  EXPECT_LT((found - ga_.alpha_m / (gamma_ * dt_) * D_h).norm() / found.norm(), 1e-14);
  EXPECT_LT((found - ga_.alpha_m * K).norm() / found.norm(), 1e-14);
}

// @tests{ga-K-kinematic}
TEST_P(TheoryForms, OfTheTangentOfTheKinematicRate) {
  const Vec3 A = newmark_rotation(step_.Lambda_n.transpose() * step_.theta,
                                  {sample_.at_n.W, sample_.at_n.A}, ga_, dt_)
                     .A;
  const Vec3 h_dot = angular_momentum_rate(J_, omega_, step_.Lambda_n1 * A);
  const Mat3 K =
      1.0 / (beta_ * dt_) *
          ((gamma_ * hat(omega_) + 1.0 / dt_ * Mat3::Identity()) * J_ - gamma_ * hat(h_)) * T_ -
      hat(h_dot);
  const Mat3 found = K_theta(MomentumRate::kinematic);
  EXPECT_LT((found - ga_.alpha_m * K).norm() / found.norm(), 1e-14);
}

}  // namespace
}  // namespace polhode::theory_forms_tests
