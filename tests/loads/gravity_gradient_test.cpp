// SPDX-License-Identifier: Apache-2.0
#include <loads/load_samples.hpp>
#include <polhode/loads/gravity_gradient.hpp>

namespace polhode::test::gravity_gradient_tests {
namespace {

GravityGradient sample(Random& random) {
  LoadDescription d;
  d.name = "gravity";
  d.bodies = {0, 1};
  d.values = {{"mu", 7.0}};
  d.mass_b = 2.0;
  d.inertia_b = random.inertia();
  return GravityGradient(d);
}

/// A motion whose bodies stay apart.
PairMotion apart(Random& random, double rho_inf) {
  PairMotion m(random, context_of(rho_inf));
  m.a_n.r = Vec3(0.2, 0.1, -0.3);
  m.b_n.r = Vec3(2.1, 0.4, 0.6);
  return m;
}

}  // namespace

TEST(GravityGradient, HasTheTangentOfItsWrench) {
  for (const double rho_inf : {1.0, 0.5, 0.0}) {
    Random random(1);
    const GravityGradient gravity = sample(random);
    expect_wrench_tangent(gravity, apart(random, rho_inf), "gravity_gradient");
  }
}

// Steps that turn and move the body by a good part of its distance. @tests{gravity-gradient-step}
TEST(GravityGradient, ReturnsExactlyTheEnergyItStored) {
  for (unsigned seed = 1; seed <= 8; ++seed) {
    Random random(seed);
    const GravityGradient gravity = sample(random);
    EXPECT_TRUE(gravity.conservative());
    const PairMotion m = apart(random, 1.0);
    const double lost = stored_at_start(gravity, m) - work(gravity, m).stored;
    EXPECT_NEAR(work_done(m, evaluate(gravity, m)), lost, 2e-14) << seed;
    EXPECT_GT(std::abs(lost), 1e-3);
  }
}

TEST(GravityGradient, ConservesBothMomentaOfThePair) {
  Random random(3);
  const GravityGradient gravity = sample(random);
  for (const double rho_inf : {1.0, 0.5}) {
    const PairMotion m = apart(random, rho_inf);
    const PairTerms t = evaluate(gravity, m);
    const double af = m.context.ga.alpha_f;
    const auto about_origin = [&](const BodyStep& s, const Vec6& w) -> Vec3 {
      return Vec3(s.r_n + af * s.u).cross(w.head<3>()) + w.tail<3>();
    };
    EXPECT_EQ((t.wrench_a.head<3>() + t.wrench_b.head<3>()).norm(), 0.0);
    EXPECT_LT((about_origin(m.a(), t.wrench_a) + about_origin(m.b(), t.wrench_b)).norm(), 1e-14);
  }
}

// The textbook moment 3 μ/l³ e × J e and force of a point mass, and the quadrupole's force by
// differences of the potential. @tests{gravity-gradient}
TEST(GravityGradient, IsTheKnownMomentAtAnInstant) {
  Random random(4);
  const GravityGradient gravity = sample(random);
  PairMotion m = apart(random, 0.0);
  Random again(4);
  const Mat3 J_r = again.inertia(), Lambda = m.b_n.Lambda(), J = Lambda * J_r * Lambda.transpose();
  const std::vector<double> r =
      m.at_start([&](const PairStep& step) { return gravity.report(step); });
  const Vec3 d = m.b_n.r - m.a_n.r, e = d.normalized();
  const double l = d.norm();
  EXPECT_LT((Vec3(r[3], r[4], r[5]) - 3.0 * 7.0 / (l * l * l) * e.cross(J * e)).norm(), 1e-13);
  EXPECT_NEAR(r[6], l, 1e-14);
  EXPECT_NEAR(r[7], -7.0 * 2.0 / l - 7.0 / (2.0 * l * l * l) * (J.trace() - 3.0 * e.dot(J * e)),
              1e-13);
  for (int k = 0; k < 3; ++k) {
    double V[2];
    for (const int side : {0, 1}) {
      PairMotion moved = m;
      moved.b_n.r[k] += side == 0 ? -1e-5 : 1e-5;
      V[side] = stored_at_start(gravity, moved);
    }
    EXPECT_NEAR(r[static_cast<std::size_t>(k)], -(V[1] - V[0]) / 2e-5, 1e-8);
  }
}

}  // namespace polhode::test::gravity_gradient_tests
