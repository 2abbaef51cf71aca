// SPDX-License-Identifier: Apache-2.0
#include <loads/load_samples.hpp>
#include <polhode/loads/moment.hpp>

namespace polhode::test::moment_tests {
namespace {

LoadDescription description(Random& random, bool body_fixed) {
  LoadDescription d;
  d.name = "twist";
  d.bodies = {kGround, 0};
  d.body_fixed = body_fixed;
  d.vector = constant(random.vector(3.0));
  return d;
}

}  // namespace

TEST(Moment, HasTheTangentOfItsWrench) {
  for (const bool body_fixed : {false, true})
    for (const double rho_inf : {1.0, 0.5, 0.0}) {
      Random random(1);
      const Moment moment(description(random, body_fixed));
      PairMotion m(random, context_of(rho_inf));
      m.a_moves = false;
      expect_wrench_tangent(moment, m, "moment");
    }
}

TEST(Moment, ReportsItsWorkAsSupplied) {
  for (const bool body_fixed : {false, true}) {
    Random random(2);
    const Moment moment(description(random, body_fixed));
    EXPECT_FALSE(moment.conservative());
    const PairMotion m(random, context_of(1.0));
    EXPECT_NEAR(work(moment, m).put_in, work_done(m, evaluate(moment, m)), 1e-15);
  }
}

// The axis of rotation is mapped to itself, so the average of the rotated moment is the moment.
TEST(Moment, IsTheSameInGroundAndBodyAxesIfTheBodyTurnsAboutIt) {
  Random random(3);
  PairMotion m(random, context_of(1.0));
  m.b_n.q.setIdentity();
  m.theta_b = Vec3(0.0, 0.0, 0.8);
  LoadDescription d = description(random, false);
  d.vector = constant(Vec3(0.0, 0.0, 2.0));
  const PairTerms world = evaluate(Moment(d), m);
  d.body_fixed = true;
  EXPECT_LT((world.wrench_b - evaluate(Moment(d), m).wrench_b).norm(), 1e-15);
}

}  // namespace polhode::test::moment_tests
