// SPDX-License-Identifier: Apache-2.0
#include <loads/load_samples.hpp>
#include <polhode/beams/cable.hpp>
#include <polhode/core/error.hpp>

namespace polhode::test::cable_tests {
namespace {

/// Two bodies and a bar between points of them. In the middle of the step its length is about its
/// free length times `slackness`.
struct CableSample {
  PairMotion motion;
  CableSpec spec;

  CableSample(Random& random, double rho_inf, double slackness)
      : motion(random, context_of(rho_inf)) {
    spec.name = "stay";
    spec.bodies = {0, 1};
    spec.Z_a = random.vector();
    spec.Z_b = random.vector();
    spec.stiffness = 40.0;
    const BodyStep a = motion.a(), b = motion.b();
    const double l_n = (b.point(spec.Z_b).at_n - a.point(spec.Z_a).at_n).norm();
    const double l_n1 = (b.point(spec.Z_b).at_n1 - a.point(spec.Z_a).at_n1).norm();
    spec.free_length = 0.5 * (l_n + l_n1) / slackness;
  }
};

// Taut, slack, and the switch within the step.
constexpr double kSlacknesses[] = {1.6, 0.5, 1.0};

}  // namespace

TEST(Cable, HasTheTangentOfItsWrench) {
  for (const bool conserving : {true, false})
    for (const double rho_inf : {1.0, 0.3, 0.0})
      for (const BarStrain strain : {BarStrain::engineering, BarStrain::green})
        for (const double slackness : kSlacknesses)
          for (const bool tension_only : {true, false}) {
            Random random(1);
            CableSample sample(random, rho_inf, slackness);
            sample.spec.strain = strain;
            sample.spec.tension_only = tension_only;
            sample.spec.damping = 0.7;
            sample.motion.context.conserving = conserving;
            expect_wrench_tangent(Cable(sample.spec), sample.motion, "cable");
          }
}

TEST(Cable, HasTheTangentOfItsCoupledMass) {
  Random random(2);
  CableSample sample(random, 0.6, 1.3);
  sample.spec.Z_a = sample.spec.Z_b = Vec3::Zero();
  sample.spec.coupled_mass = 0.4;
  expect_wrench_tangent(Cable(sample.spec), sample.motion, "cable");
}

// @tests{cable-gradient}
TEST(Cable, ReturnsExactlyTheEnergyItStored) {
  for (unsigned seed = 1; seed <= 8; ++seed)
    for (const BarStrain strain : {BarStrain::engineering, BarStrain::green})
      for (const double slackness : kSlacknesses)
        for (const bool tension_only : {true, false}) {
          Random random(seed);
          CableSample sample(random, 1.0, slackness);
          sample.spec.strain = strain;
          sample.spec.tension_only = tension_only;
          const Cable cable(sample.spec);
          const PairMotion& m = sample.motion;
          EXPECT_NEAR(work_done(m, evaluate(cable, m)),
                      stored_at_start(cable, m) - work(cable, m).stored, 3e-13)
              << seed;
        }
}

TEST(Cable, DissipatesTheWorkOfItsDamper) {
  for (unsigned seed = 1; seed <= 8; ++seed)
    for (const BarStrain strain : {BarStrain::engineering, BarStrain::green})
      for (const double slackness : kSlacknesses) {
        Random random(seed);
        CableSample sample(random, 1.0, slackness);
        sample.spec.strain = strain;
        sample.spec.damping = 2.0;
        const Cable cable(sample.spec);
        const PairMotion& m = sample.motion;
        const Work w = work(cable, m);
        EXPECT_GE(w.dissipated, 0.0);
        EXPECT_NEAR(work_done(m, evaluate(cable, m)),
                    stored_at_start(cable, m) - w.stored - w.dissipated, 3e-13);
      }
}

TEST(Cable, HasNoForceWhileSlack) {
  Random random(3);
  CableSample sample(random, 1.0, 0.1);
  sample.spec.damping = 3.0;
  const Cable cable(sample.spec);
  const PairTerms t = evaluate(cable, sample.motion);
  EXPECT_TRUE(wrenches(t).isZero(0.0));
  EXPECT_TRUE(wrench_tangent(t).isZero(0.0));
  sample.motion.with(Displacement::Zero(),
                     [&](const PairStep& s) { EXPECT_EQ(cable.tension(s), 0.0); });
}

TEST(Cable, KeepsLinearAndAngularMomentumOfItsPair) {
  for (const double rho_inf : {1.0, 0.5}) {
    Random random(4);
    CableSample sample(random, rho_inf, 1.5);
    sample.spec.damping = 1.0;
    const PairMotion& m = sample.motion;
    const PairTerms t = evaluate(Cable(sample.spec), m);
    const Vec3 r_a = m.a().point(Vec3::Zero()).at_alpha, r_b = m.b().point(Vec3::Zero()).at_alpha;
    EXPECT_LT((t.wrench_a + t.wrench_b).head<3>().norm(), 1e-14);
    EXPECT_LT((r_a.cross(t.wrench_a.head<3>()) + t.wrench_a.tail<3>() +
               r_b.cross(t.wrench_b.head<3>()) + t.wrench_b.tail<3>())
                  .norm(),
              2e-13);
  }
}

TEST(Cable, PullsWithItsStiffnessTimesItsStrain) {
  CableSpec spec;
  spec.name = "rod";
  spec.bodies = {kGround, 0};
  spec.stiffness = 200.0;
  spec.free_length = 2.0;
  const BodyStep ground = BodyStep::ground(1.0);
  const BodyStep b = BodyStep::at_instant({0, 0, 3}, Mat3::Identity(), Vec3::Zero(), Vec3::Zero());
  StepContext context = context_of(0.0);
  const PairStep step{ground, b, context, nullptr, nullptr};
  EXPECT_DOUBLE_EQ(Cable(spec).tension(step), 100.0);
  spec.strain = BarStrain::green;  // EA ε l/L with ε = (9 − 4)/8
  EXPECT_DOUBLE_EQ(Cable(spec).tension(step), 200.0 * 0.625 * 1.5);
  PairTerms t;
  t.set_zero();
  Cable(spec).evaluate(step, t);
  EXPECT_NEAR(t.wrench_b[2], -187.5, 1e-12);
  EXPECT_TRUE(t.wrench_a.isZero(0.0));
}

TEST(Cable, RefusesInvalidCables) {
  const auto message = [](auto&& change) -> std::string {
    CableSpec spec;
    spec.name = "stay";
    spec.stiffness = spec.free_length = 1.0;
    change(spec);
    try {
      Cable cable(spec);
    } catch (const InputError& e) {
      return e.what();
    }
    return "no error";
  };
  EXPECT_EQ(message([](CableSpec& s) { s.stiffness = 0.0; }),
            "cable 'stay': has the stiffness 0. Give EA above zero, in N.");
  EXPECT_EQ(message([](CableSpec& s) { s.free_length = -1.0; }),
            "cable 'stay': has no length. Give a free length above zero, or distinct points.");
  EXPECT_EQ(message([](CableSpec& s) { s.damping = -1.0; }),
            "cable 'stay': has the damping -1. Give a damping that is not negative.");
  EXPECT_EQ(message([](CableSpec& s) { s.coupled_mass = 1.0, s.Z_a = Vec3::UnitX(); }),
            "cable 'stay': has a consistent mass, but its ends are not at the centres of mass. Put "
            "its ends at the centres of mass, or lump its mass.");
}

}  // namespace polhode::test::cable_tests
