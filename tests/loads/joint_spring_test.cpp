// SPDX-License-Identifier: Apache-2.0
#include <loads/load_samples.hpp>
#include <polhode/loads/joint_spring.hpp>

namespace polhode::test::joint_spring_tests {
namespace {

struct Sample {
  TorsionalSpring spring;
  PairMotion motion;
};

/// A hinge with aligned axes at both ends of a large step.
Sample sample(unsigned seed, const StepContext& context, double stiffness, double damping) {
  Random random(seed);
  const Mat3 R_a = random.frame(), R_b = random.frame();
  LoadDescription d;
  d.name = "spring";
  d.bodies = {0, 1};
  d.values = {{"stiffness", stiffness}, {"damping", damping}, {"free_angle", 0.4}};
  d.angle = FreeAngle{R_a.col(0), R_a.col(1), R_b.col(0), false};
  PairMotion m(random, context);
  const double start = random.number(3.0), turn = random.number(1.2);
  const auto b_of = [&](const Mat3& Lambda_a, double angle) -> Mat3 {
    return Lambda_a * R_a * exp_map(angle * Vec3::UnitZ()) * R_b.transpose();
  };
  m.b_n.q = Quat(b_of(m.a_n.Lambda(), start)).normalized();
  m.theta_b = cayley_vector(b_of(m.a().Lambda_n1, start + turn) * m.b_n.Lambda().transpose());
  m.history[0] = start + 2.0 * 3.14159265358979324;  // One turn was made before.
  return {TorsionalSpring(d), m};
}

double stored(double stiffness, double angle) {
  return 0.5 * stiffness * (angle - 0.4) * (angle - 0.4);
}

}  // namespace

TEST(TorsionalSpring, HasTheTangentOfItsWrench) {
  for (const bool conserving : {true, false})
    for (const double rho_inf : {1.0, 0.5, 0.0}) {
      StepContext context = context_of(rho_inf);
      context.conserving = conserving;
      const auto sampled = sample(1, context, 3.0, 2.0);
      const auto& spring = sampled.spring;
      const auto& m = sampled.motion;
      expect_derivative(
          wrench_tangent(evaluate(spring, m)),
          [&](const Vec& d) -> Vec { return wrenches(evaluate(spring, m, d)); },
          "torsional_spring");
    }
}

// @tests{torsion-gradient}
TEST(TorsionalSpring, ReturnsExactlyTheEnergyItStoredOverFullTurns) {
  for (unsigned seed = 1; seed <= 8; ++seed) {
    const auto [spring, m] = sample(seed, context_of(1.0), 10.0, 0.0);
    EXPECT_TRUE(spring.conservative());
    EXPECT_NEAR(work_done(m, evaluate(spring, m)),
                stored(10.0, m.history[0]) - work(spring, m).stored, 2e-12);
  }
}

TEST(TorsionalSpring, DissipatesTheWorkOfItsDamper) {
  for (unsigned seed = 1; seed <= 8; ++seed) {
    const auto [spring, m] = sample(seed, context_of(1.0), 0.0, 2.0);
    EXPECT_FALSE(spring.conservative());
    EXPECT_GT(work(spring, m).dissipated, 0.0);
    EXPECT_NEAR(-work_done(m, evaluate(spring, m)), work(spring, m).dissipated, 1e-13);
  }
}

TEST(TorsionalSpring, ActsOnBothBodiesWithOppositeMoments) {
  const auto [spring, m] = sample(3, context_of(0.5), 3.0, 2.0);
  const PairTerms t = evaluate(spring, m);
  EXPECT_EQ(t.wrench_a, Vec6(-t.wrench_b));
}

TEST(TorsionalSpring, RemembersTheAngle) {
  const auto [spring, m] = sample(4, context_of(1.0), 3.0, 0.0);
  double history = 0.0;
  const TorsionalSpring& s = spring;
  m.with(Displacement::Zero(), [&](const PairStep& step) { s.commit(step, &history); });
  EXPECT_NEAR(stored(3.0, history), work(spring, m).stored, 1e-13);
  EXPECT_LT(std::abs(history - m.history[0]), 1.21);
  m.at_start([&](const PairStep& step) { s.initialize(step, &history); });
  EXPECT_NEAR(history, m.history[0] - 2.0 * 3.14159265358979324, 1e-14);
}

}  // namespace polhode::test::joint_spring_tests
