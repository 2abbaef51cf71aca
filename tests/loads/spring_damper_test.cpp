// SPDX-License-Identifier: Apache-2.0
#include <loads/load_samples.hpp>
#include <polhode/loads/spring_damper.hpp>

namespace polhode::test::spring_damper_tests {
namespace {

LoadDescription description(Random& random, double stiffness, double damping, double free_length) {
  LoadDescription d;
  d.name = "spring";
  d.bodies = {0, 1};
  d.Z_a = random.vector();
  d.Z_b = random.vector();
  d.values = {{"stiffness", stiffness}, {"damping", damping}, {"free_length", free_length}};
  return d;
}

}  // namespace

TEST(SpringDamper, HasTheTangentOfItsWrench) {
  for (const bool conserving : {true, false})
    for (const double rho_inf : {1.0, 0.5, 0.0})
      for (const auto& [k, c, l_0] :
           {std::tuple(3.0, 0.0, 0.7), std::tuple(0.0, 2.0, 0.7), std::tuple(3.0, 2.0, 0.0)}) {
        Random random(1);
        const SpringDamper spring(description(random, k, c, l_0));
        PairMotion m(random, context_of(rho_inf));
        m.context.conserving = conserving;
        expect_wrench_tangent(spring, m, "spring_damper");
      }
}

// Steps of the size of the spring itself; round-off of k l² ~ 1e2.
// @tests{spring-gradient}
TEST(SpringDamper, ReturnsExactlyTheEnergyItStored) {
  for (unsigned seed = 1; seed <= 8; ++seed) {
    Random random(seed);
    const SpringDamper spring(description(random, 30.0, 0.0, 0.7));
    EXPECT_TRUE(spring.conservative());
    const PairMotion m(random, context_of(1.0));
    EXPECT_NEAR(work_done(m, evaluate(spring, m)),
                stored_at_start(spring, m) - work(spring, m).stored, 2e-13);
  }
}

TEST(SpringDamper, DoesNotReturnItsEnergyExactlyWithMidpointForces) {
  Random random(1);
  const SpringDamper spring(description(random, 30.0, 0.0, 0.7));
  PairMotion m(random, context_of(1.0));
  m.context.conserving = false;
  EXPECT_GT(std::abs(work_done(m, evaluate(spring, m)) - stored_at_start(spring, m) +
                     work(spring, m).stored),
            1e-3);
}

TEST(SpringDamper, DissipatesTheWorkOfItsDamper) {
  for (unsigned seed = 1; seed <= 8; ++seed) {
    Random random(seed);
    const SpringDamper damper(description(random, 0.0, 5.0, 0.7));
    EXPECT_FALSE(damper.conservative());
    for (const double rho_inf : {1.0, 0.5, 0.0}) {
      Random again(seed);
      (void)description(again, 0.0, 0.0, 0.0);
      const PairMotion m(again, context_of(rho_inf));
      const double dissipated = work(damper, m).dissipated;
      EXPECT_GE(dissipated, 0.0);
      // Rates are those of the step when the mean of v is u/Δt: exactly so at ρ∞ = 1.
      if (rho_inf == 1.0) {
        EXPECT_NEAR(-work_done(m, evaluate(damper, m)), dissipated, 1e-12);
      }
    }
  }
}

TEST(SpringDamper, KeepsLinearAndAngularMomentumOfItsPair) {
  for (const double rho_inf : {1.0, 0.5}) {
    Random random(2);
    const SpringDamper spring(description(random, 3.0, 2.0, 0.7));
    const PairMotion m(random, context_of(rho_inf));
    const PairTerms t = evaluate(spring, m);
    const Vec3 r_a = m.a().point(Vec3::Zero()).at_alpha, r_b = m.b().point(Vec3::Zero()).at_alpha;
    EXPECT_LT((t.wrench_a + t.wrench_b).head<3>().norm(), 1e-15);
    EXPECT_LT((r_a.cross(t.wrench_a.head<3>()) + t.wrench_a.tail<3>() +
               r_b.cross(t.wrench_b.head<3>()) + t.wrench_b.tail<3>())
                  .norm(),
              3e-14);
  }
}

// Points of bodies that turn and move so that the points coincide at both ends.
TEST(SpringDamper, WithoutFreeLengthPullsLinearlyThroughZeroLength) {
  Random random(3);
  LoadDescription d = description(random, 4.0, 0.0, 0.0);
  const SpringDamper spring(d);
  PairMotion m(random, context_of(1.0));
  m.b_n.r = m.a_n.r + m.a_n.q * d.Z_a - m.b_n.q * d.Z_b;
  m.u_b = m.a().point(d.Z_a).at_n1 - m.b_n.r - m.b().vector(d.Z_b).at_n1;
  EXPECT_LT(wrenches(evaluate(spring, m)).norm(), 1e-14);
  expect_derivative(
      wrench_tangent(evaluate(spring, m)).bottomRows<3>().rightCols<6>() + Mat::Zero(3, 6),
      [&](const Vec& x) -> Vec {
        Displacement e = Displacement::Zero();
        e.tail<6>() = x;
        return wrenches(evaluate(spring, m, e)).tail<3>();
      },
      "moment on b");
}

TEST(SpringDamper, WithFreeLengthIsFiniteAtZeroLength) {
  LoadDescription d;
  d.name = "spring";
  d.values = {{"stiffness", 4.0}, {"damping", 1.0}, {"free_length", 0.5}};
  const SpringDamper spring(d);
  const BodyStep a = BodyStep::ground(0.5);
  BodyStep b;
  const StepContext context = context_of(1.0);
  PairTerms t;
  t.set_zero();
  spring.evaluate({a, b, context, nullptr, nullptr}, t);
  EXPECT_TRUE(t.wrench_b.isZero(0.0));
  EXPECT_TRUE(t.D_bb.allFinite());
  EXPECT_EQ(spring.work({a, b, context, nullptr, nullptr}).stored, 0.5 * 4.0 * 0.25);
}

TEST(SpringDamper, PullsWithStiffnessTimesElongation) {
  LoadDescription d;
  d.name = "spring";
  d.values = {{"stiffness", 100.0}};
  d.start_length = 2.0;  // Default free length.
  const SpringDamper spring(d);
  const BodyStep a = BodyStep::ground(1.0);
  const BodyStep b =
      BodyStep::at_instant(Vec3(0.0, 2.5, 0.0), Mat3::Identity(), Vec3::Zero(), Vec3::Zero());
  const StepContext context;
  PairTerms t;
  t.set_zero();
  spring.evaluate({a, b, context, nullptr, nullptr}, t);
  EXPECT_LT((t.wrench_b.head<3>() - Vec3(0.0, -50.0, 0.0)).norm(), 1e-13);
}

}  // namespace polhode::test::spring_damper_tests
