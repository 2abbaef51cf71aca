// SPDX-License-Identifier: Apache-2.0
//
// The torque-free symmetric top, whose motion is known in closed form (Goldstein, Classical
// Mechanics, section 5.6): about the axis of symmetry the material angular velocity turns at a
// constant rate, and in space the body precesses about its angular momentum.
#include <gtest/gtest.h>

#include <polhode/dynamics/momentum_step.hpp>
#include <polhode/math/exp_map.hpp>
#include <polhode/math/quaternion.hpp>
#include <support/convergence.hpp>

namespace polhode::free_top_tests {
namespace {

constexpr double kAcross = 2.0;  // principal moments [kg m²]
constexpr double kAlong = 1.0;
const Mat3 kJ_r = Vec3(kAcross, kAcross, kAlong).asDiagonal();
const Vec3 kW_0(0.6, 0.0, 3.0);
const Mat3 kLambda_0 = exp_map(Vec3(0.2, -0.4, 0.1));
constexpr double kEnd = 2.0;

Mat3 exact_Lambda(double t) {
  // ω = h/J₁ + (1 − J₃/J₁) W₃ z, z the axis of symmetry.
  const Vec3 precession = kLambda_0 * (kJ_r * kW_0) / kAcross;
  const double spin = (1.0 - kAlong / kAcross) * kW_0.z();
  return exp_map(t * precession) * kLambda_0 * exp_map(Vec3(0.0, 0.0, t * spin));
}

Vec3 exact_W(double t) { return exact_Lambda(t).transpose() * (kLambda_0 * (kJ_r * kW_0)); }

/// One step without forces: Newton on the body's residual, which is minus its rates of momentum.
BodyMotion stepped(const BodyMotion& at_n, const StepContext& context, MomentumRate form) {
  const double mass = 1.0;
  Vec3 u = context.dt * at_n.v;
  Vec3 theta = context.dt * at_n.omega();
  for (int iteration = 0; iteration < 12; ++iteration) {
    const BodyStep step = newmark_step(at_n, u, theta, context);
    const MomentumRates rates = momentum_rates(mass, kJ_r, at_n, step, context, form);
    const Vec3 Delta_r = -rates.p_dot / rates.K_r;
    const Vec3 Delta_theta = -rates.K_theta.inverse() * rates.h_dot;
    u += Delta_r;
    theta = compose_cayley(Delta_theta, theta);
    if (Delta_theta.norm() < 1e-14) break;
  }
  return end_motion(kJ_r, at_n, newmark_step(at_n, u, theta, context), context, form);
}

BodyMotion solved(double rho_inf, MomentumRate form, int steps) {
  BodyMotion motion;
  motion.q = Quat(kLambda_0);
  motion.W = kW_0;
  motion.A = kJ_r.inverse() * (kJ_r * kW_0).cross(kW_0);  // no moment acts
  StepContext context;
  context.ga = GeneralizedAlpha::from_spectral_radius(rho_inf);
  context.dt = kEnd / steps;
  for (int n = 0; n < steps; ++n) motion = stepped(motion, context, form);
  return motion;
}

double error(double rho_inf, MomentumRate form, int steps) {
  return (solved(rho_inf, form, steps).Lambda() - exact_Lambda(kEnd)).norm();
}

Vec3 spatial_momentum(const BodyMotion& motion) { return motion.Lambda() * (kJ_r * motion.W); }

class FreeTopAt : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(SpectralRadius, FreeTopAt, testing::Values(0.0, 0.5, 0.9, 1.0));

// @tests{eq:ga-Newton-scheme} @tests{eq:ga-Newton-iterations} @tests{eq:ga-residual-vector}
TEST_P(FreeTopAt, IsFollowedToSecondOrderByTheMomentumForm) {
  test::expect_order([&](int n) { return error(GetParam(), MomentumRate::momentum, n); },
                     {100, 200, 400}, 2.0, 0.1, "rotation");
}

// @tests{ga-K-kinematic-corrected}
TEST_P(FreeTopAt, IsFollowedToSecondOrderByTheCorrectedKinematicForm) {
  test::expect_order([&](int n) { return error(GetParam(), MomentumRate::kinematic_corrected, n); },
                     {100, 200, 400}, 2.0, 0.1, "rotation");
}

TEST_P(FreeTopAt, KeepsItsAngularMomentumInTheMomentumForm) {
  const BodyMotion end = solved(GetParam(), MomentumRate::momentum, 400);
  const Vec3 h_0 = kLambda_0 * (kJ_r * kW_0);
  EXPECT_LT((spatial_momentum(end) - h_0).norm() / h_0.norm(), 400 * 1e-15);
}

TEST(FreeTop, IsFollowedToFirstOrderOnlyByTheKinematicFormAsPrinted) {
  // Kept for comparison: A_n belongs to t_n + δΔt, W_n to t_n.
  for (const double rho_inf : {0.0, 0.5})
    test::expect_order([&](int n) { return error(rho_inf, MomentumRate::kinematic, n); },
                       {400, 800}, 1.0, 0.1, "rotation");
}

TEST(FreeTop, KeepsItsEnergyWithoutDamping) {
  const BodyMotion end = solved(1.0, MomentumRate::momentum, 400);
  const double energy_0 = 0.5 * kW_0.dot(kJ_r * kW_0);
  EXPECT_NEAR(0.5 * end.W.dot(kJ_r * end.W) / energy_0, 1.0, 400 * 1e-15);
}

TEST(FreeTop, HasAClosedFormThatObeysItsEquations) {
  const double step = 1e-5;  // truncation 1e-10 times third derivatives up to 40
  const double t = 0.7;
  const Mat3 rate = (exact_Lambda(t + step) - exact_Lambda(t - step)) / (2.0 * step);
  const Mat3 Lambda = exact_Lambda(t);
  const Vec3 W = vee(Lambda.transpose() * rate);
  EXPECT_LT((kJ_r * W - exact_W(t)).norm(), 1e-8);
}

}  // namespace
}  // namespace polhode::free_top_tests
