// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <loads/load_samples.hpp>
#include <polhode/loads/point_force.hpp>

namespace polhode::test::point_force_tests {
namespace {

LoadDescription description(Random& random, bool body_fixed) {
  LoadDescription d;
  d.name = "push";
  d.bodies = {kGround, 0};
  d.Z_b = random.vector();
  d.body_fixed = body_fixed;
  d.vector = constant(random.vector(3.0));
  return d;
}

}  // namespace

// @tests{ga-moment-arm} @tests{ga-moment-tangent}
TEST(PointForce, HasTheTangentOfItsWrench) {
  for (const bool body_fixed : {false, true})
    for (const double rho_inf : {1.0, 0.5, 0.0}) {
      Random random(1);
      const PointForce force(description(random, body_fixed));
      PairMotion m(random, context_of(rho_inf));
      m.a_moves = false;
      expect_wrench_tangent(force, m, "force");
    }
}

TEST(PointForce, IsEvaluatedAtTheTimeOfTheForces) {
  for (const double rho_inf : {1.0, 0.5, 0.0}) {
    Random random(2);
    LoadDescription d = description(random, false);
    d.Z_b.setZero();
    d.vector = {std::make_shared<Function>([](double t) { return std::sin(t); }), nullptr, nullptr};
    const PairMotion m(random, context_of(rho_inf));
    const double t_alpha = m.context.t_n + m.context.dt / (1.0 + rho_inf);
    const PairTerms t = evaluate(PointForce(d), m);
    EXPECT_NEAR(t.wrench_b[0], std::sin(t_alpha), 1e-15);
    EXPECT_TRUE(t.wrench_b.tail<5>().isZero(0.0));
    EXPECT_TRUE(t.wrench_a.isZero(0.0));
  }
}

TEST(PointForce, TurnsWithTheBodyIfItIsFixedToIt) {
  Random random(3);
  LoadDescription d = description(random, true);
  const Vec3 F(1.0, -2.0, 0.5);
  d.vector = constant(F);
  PairMotion m(random, context_of(1.0));
  m.theta_b.setZero();
  EXPECT_LT((evaluate(PointForce(d), m).wrench_b.head<3>() - m.b().Lambda_n1 * F).norm(), 1e-15);
}

// f·Δx for turns of a radian; exact at ρ∞ = 1, so round-off remains.
TEST(PointForce, ReturnsTheEnergyStoredByAConstantForce) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    Random random(seed);
    const PointForce force(description(random, false));
    EXPECT_TRUE(force.conservative());
    const PairMotion m(random, context_of(1.0));
    const double done = work_done(m, evaluate(force, m));
    EXPECT_NEAR(done, stored_at_start(force, m) - work(force, m).stored, 1e-14);
    EXPECT_EQ(work(force, m).put_in, 0.0);
  }
}

TEST(PointForce, ReportsItsWorkAsSuppliedIfItVaries) {
  for (const bool body_fixed : {false, true}) {
    Random random(4);
    LoadDescription d = description(random, body_fixed);
    d.vector[1] = std::make_shared<Function>([](double t) { return 3.0 * t; });
    const PointForce force(d);
    EXPECT_FALSE(force.conservative());
    const PairMotion m(random, context_of(1.0));
    EXPECT_NEAR(work(force, m).put_in, work_done(m, evaluate(force, m)), 1e-14);
    EXPECT_EQ(work(force, m).stored, 0.0);
  }
}

}  // namespace polhode::test::point_force_tests
