// SPDX-License-Identifier: Apache-2.0
#include <tuple>

#include <gtest/gtest.h>

#include <dynamics/sample_step.hpp>
#include <polhode/core/error.hpp>
#include <polhode/dynamics/momentum.hpp>
#include <polhode/dynamics/momentum_step.hpp>
#include <polhode/dynamics/newmark_rotation.hpp>
#include <polhode/dynamics/newmark_translation.hpp>
#include <polhode/geometry/mass_properties.hpp>
#include <polhode/math/exp_map.hpp>
#include <support/derivative.hpp>

namespace polhode::momentum_step_tests {
namespace {

constexpr double kMass = 2.5;
const Mat3 kJ_r =
    geometry::inertia_at(exp_map(Vec3(0.2, 0.5, -0.4)), Vec3(1.0, 2.0, 2.7).asDiagonal());

class MomentumStep : public testing::TestWithParam<std::tuple<double, MomentumRate>> {
 protected:
  MomentumRates rates(const BodyStep& step) const {
    return momentum_rates(kMass, kJ_r, sample_.at_n, step, sample_.context, form_);
  }

  MomentumRate form_ = std::get<1>(GetParam());
  test::SampleStep sample_{std::get<0>(GetParam())};
  const GeneralizedAlpha& ga_ = sample_.context.ga;
  double dt_ = sample_.context.dt;
  BodyStep step_ = sample_.step();
  Mat3 J_ = geometry::inertia_at(step_.Lambda_n1, kJ_r);  // at t_{n+1}, as all below
  Vec3 omega_ = step_.Lambda_n1 * step_.W_n1;
  Vec3 h_ = J_ * omega_;
  Mat3 T_ = cayley_tangent(step_.theta);
};
INSTANTIATE_TEST_SUITE_P(Forms, MomentumStep,
                         testing::Combine(testing::Values(0.0, 0.5, 0.9, 1.0),
                                          testing::Values(MomentumRate::momentum,
                                                          MomentumRate::kinematic,
                                                          MomentumRate::kinematic_corrected)));

// @tests{ga-p-tangent} @tests{ga-h-dot-r-tangent} @tests{ga-inertia-tangent}
TEST_P(MomentumStep, HasTheInertiaTangentOfItsRates) {
  const MomentumRates at = rates(step_);
  Mat6 D = Mat6::Zero();  // neither rate depends on the other's increment
  D.topLeftCorner<3, 3>() = at.K_r * Mat3::Identity();
  D.bottomRightCorner<3, 3>() = at.K_theta;
  test::expect_derivative(
      D,
      [&](const Vec& d) -> Vec {
        const MomentumRates moved = rates(sample_.displaced(d));
        Vec6 both;
        both << moved.p_dot, moved.h_dot;
        return both;
      },
      "inertia tangent");
  EXPECT_DOUBLE_EQ(at.K_r, ga_.alpha_m * kMass / (ga_.beta * dt_ * dt_));
}

// @tests{eq:ga-momenta-interpolation} @tests{eq:ga-momenta-Newmark}
TEST_P(MomentumStep, InterpolatesRatesThatObeyNewmarksRule) {
  const MomentumRates at = rates(step_);
  const BodyMotion& n = sample_.at_n;
  const BodyMotion end = end_motion(kJ_r, n, step_, sample_.context, form_);
  // ṗ by Newmark in the momentum is m r̈ by Newmark in the velocity.
  const Vec3 p_dot_n1 =
      kMass * (step_.v_n1 - step_.v_n) / (ga_.gamma * dt_) + (1.0 - 1.0 / ga_.gamma) * kMass * n.a;
  EXPECT_LT((p_dot_n1 - kMass * end.a).norm(), 1e-12);
  EXPECT_LT((at.p_dot - (1.0 - ga_.alpha_m) * kMass * n.a - ga_.alpha_m * p_dot_n1).norm(), 1e-12);
  if (form_ != MomentumRate::momentum) return;
  const Vec3 h_n = step_.Lambda_n * (kJ_r * step_.W_n);
  const Vec3 h_dot_n1 = (h_ - h_n) / (ga_.gamma * dt_) + (1.0 - 1.0 / ga_.gamma) * n.h_dot;
  EXPECT_LT((end.h_dot - h_dot_n1).norm(), 1e-12);
  EXPECT_LT((at.h_dot - (1.0 - ga_.alpha_m) * n.h_dot - ga_.alpha_m * h_dot_n1).norm(), 1e-12);
}

// @tests{ga-h-dot}
TEST_P(MomentumStep, HasAKinematicRateAtTheEndInEitherFrame) {
  if (form_ == MomentumRate::momentum) return;
  const BodyMotion end = end_motion(kJ_r, sample_.at_n, step_, sample_.context, form_);
  const Vec3 spatial = angular_momentum_rate(J_, omega_, step_.Lambda_n1 * end.A);
  EXPECT_LT((end.h_dot - spatial).norm(), 1e-11);
}

TEST_P(MomentumStep, EndsInTheMotionOfItsStep) {
  const BodyMotion end = end_motion(kJ_r, sample_.at_n, step_, sample_.context, form_);
  EXPECT_EQ(end.r, step_.r_n1);
  EXPECT_EQ(end.v, step_.v_n1);
  EXPECT_EQ(end.W, step_.W_n1);
  EXPECT_LT((end.Lambda() - step_.Lambda_n1).norm(), 1e-15);
  EXPECT_NEAR(end.q.norm(), 1.0, 1e-15);
}

TEST(MomentumRateWord, IsReadOrRefused) {
  EXPECT_EQ(momentum_rate("kinematic_corrected"), MomentumRate::kinematic_corrected);
  try {
    (void)momentum_rate("direct");
    FAIL() << "an unknown word was accepted";
  } catch (const InputError& e) {
    EXPECT_STREQ(e.what(),
                 "analysis.momentum_rate: 'direct' is not known. Use one of: momentum, kinematic, "
                 "kinematic_corrected.");
  }
}

}  // namespace
}  // namespace polhode::momentum_step_tests
