// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <support/random_steps.hpp>

namespace polhode::test::momentum_work_tests {
namespace {

constexpr double kMass = 1.7;

/// One step under a force and a moment at t_{n+αf}, by Newton to round-off.
BodyMotion solve_step(const Mat3& J_r, const BodyMotion& at_n, const Vec3& f, const Vec3& m,
                      const StepContext& context) {
  Vec3 u = context.dt * at_n.v, theta = context.dt * at_n.omega();
  for (int i = 0; i < 12; ++i) {
    const MomentumRates rates =
        momentum_rates(kMass, J_r, at_n, newmark_step(at_n, u, theta, context), context);
    u += (f - rates.p_dot) / rates.K_r;
    const Vec3 increment = rates.K_theta.inverse() * (m - rates.h_dot);
    theta = compose_cayley(increment, theta);
    if (increment.norm() < 1e-14) break;
  }
  return end_motion(J_r, at_n, newmark_step(at_n, u, theta, context), context);
}

}  // namespace

// The momentum form at ρ∞ = 1: ΔT = f·u + m·θ and Δh = m Δt for any force, moment and step, so
// only round-off of numbers of size ten remains.
TEST(MomentumStep, GainsExactlyTheWorkOfForceAndMoment) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    Random random(seed);
    const Mat3 J_r = random.inertia();
    const BodyMotion at_n = random.motion();
    const StepContext context = context_of(1.0, 0.3);
    const Vec3 f = random.vector(), m = random.vector();
    const BodyMotion end = solve_step(J_r, at_n, f, m, context);
    const auto kinetic = [&](const BodyMotion& x) {
      return 0.5 * kMass * x.v.squaredNorm() + 0.5 * x.W.dot(J_r * x.W);
    };
    const Vec3 u = end.r - at_n.r;
    const Vec3 theta = cayley_vector(end.Lambda() * at_n.Lambda().transpose());
    EXPECT_NEAR(kinetic(end) - kinetic(at_n), f.dot(u) + m.dot(theta), 3e-14);
    EXPECT_LT((end.Lambda() * J_r * end.W - at_n.Lambda() * J_r * at_n.W - 0.3 * m).norm(), 2e-14);
  }
}

}  // namespace polhode::test::momentum_work_tests
