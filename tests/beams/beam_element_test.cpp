// SPDX-License-Identifier: Apache-2.0
#include <numbers>

#include <beams/beam_samples.hpp>
#include <polhode/core/error.hpp>

namespace polhode::test::beam_element_tests {
namespace {

/// Largest stored energy in these tests [J]: round-off is some 1e-15 of it.
constexpr double kEnergy = 40.0;

BodyStep at_rest(const Vec3& r) {
  return BodyStep::at_instant(r, Mat3::Identity(), Vec3::Zero(), Vec3::Zero());
}

}  // namespace

TEST(BeamElement, HasTheTangentOfItsWrench) {
  for (const bool conserving : {true, false})
    for (const double rho_inf : {1.0, 0.25, 0.0})
      for (const double tau : {0.0, 0.05})
        for (const bool off_centre : {true, false}) {
          Random random(1);
          BeamSample sample(random, context_of(rho_inf), off_centre);
          sample.motion.context.conserving = conserving;
          sample.spec.relaxation_time = tau;
          if (!off_centre) sample.spec.coupled_mass = 0.3;
          expect_wrench_tangent(sample.element(), sample.motion, "beam");
        }
}

// @tests{beam-gradient}
TEST(BeamElement, ReturnsExactlyTheEnergyItStored) {
  for (unsigned seed = 1; seed <= 12; ++seed) {
    Random random(seed);
    BeamSample sample(random, context_of(1.0));
    const BeamElement beam = sample.element();
    const PairMotion& m = sample.motion;
    EXPECT_TRUE(beam.conservative());
    EXPECT_NEAR(work_done(m, evaluate(beam, m)), stored_at_start(beam, m) - work(beam, m).stored,
                1e-14 * kEnergy)
        << seed;
  }
}

// Steps on both sides of the size at which Gauss's rule replaces the correction along the step.
TEST(BeamElement, ReturnsItsEnergyExactlyInVerySmallSteps) {
  for (const double size : {1e-2, 1e-3, 3e-4, 1e-4, 3e-5, 1e-6, 1e-8, 1e-10, 0.0}) {
    Random random(3);
    BeamSample sample(random, context_of(1.0));
    for (Vec3* x :
         {&sample.motion.u_a, &sample.motion.theta_a, &sample.motion.u_b, &sample.motion.theta_b})
      *x *= size;
    const BeamElement beam = sample.element();
    const PairMotion& m = sample.motion;
    const PairTerms t = evaluate(beam, m);
    EXPECT_TRUE(wrench_tangent(t).allFinite());
    EXPECT_NEAR(work_done(m, t), stored_at_start(beam, m) - work(beam, m).stored, 1e-14 * kEnergy);
    PairMotion still = m;
    still.context.conserving = false;
    EXPECT_LT((wrenches(t) - wrenches(evaluate(beam, still))).norm(),
              100.0 * size * kEnergy + 1e-12)
        << size;
    EXPECT_LT((wrench_tangent(t) - wrench_tangent(evaluate(beam, still))).norm(),
              1e2 * size * kEnergy + 1e-5)
        << size;
  }
}

TEST(BeamElement, DoesNotReturnItsEnergyExactlyWithMidpointForces) {
  Random random(2);
  BeamSample sample(random, context_of(1.0));
  sample.motion.context.conserving = false;
  const BeamElement beam = sample.element();
  const PairMotion& m = sample.motion;
  EXPECT_GT(
      std::abs(work_done(m, evaluate(beam, m)) - stored_at_start(beam, m) + work(beam, m).stored),
      1e-3);
}

// @tests{beam-strain-rate}
TEST(BeamElement, DissipatesTheWorkOfItsViscosity) {
  for (unsigned seed = 1; seed <= 8; ++seed)
    for (const double rho_inf : {1.0, 0.5}) {
      Random random(seed);
      BeamSample sample(random, context_of(rho_inf));
      sample.spec.relaxation_time = 0.2;
      const BeamElement beam = sample.element();
      const PairMotion& m = sample.motion;
      EXPECT_TRUE(beam.dissipates());
      const Work w = work(beam, m);
      EXPECT_GT(w.dissipated, 0.0);
      if (rho_inf == 1.0) {
        EXPECT_NEAR(work_done(m, evaluate(beam, m)),
                    stored_at_start(beam, m) - w.stored - w.dissipated, 3e-14 * kEnergy);
      }
    }
}

// @tests{beam-wrench}
TEST(BeamElement, KeepsLinearAndAngularMomentumOfItsPair) {
  for (const bool conserving : {true, false})
    for (const double rho_inf : {1.0, 0.25}) {
      Random random(4);
      BeamSample sample(random, context_of(rho_inf));
      sample.motion.context.conserving = conserving;
      sample.spec.relaxation_time = 0.1;
      const PairMotion& m = sample.motion;
      const PairTerms t = evaluate(sample.element(), m);
      const Vec3 r_a = m.a().point(Vec3::Zero()).at_alpha, r_b = m.b().point(Vec3::Zero()).at_alpha;
      EXPECT_LT((t.wrench_a + t.wrench_b).head<3>().norm(), 1e-14);
      EXPECT_LT((r_a.cross(t.wrench_a.head<3>()) + t.wrench_a.tail<3>() +
                 r_b.cross(t.wrench_b.head<3>()) + t.wrench_b.tail<3>())
                    .norm(),
                1e-15 * 4.0 * kEnergy);
    }
}

// A rigid motion superposed on everything: the forces turn with it.
TEST(BeamElement, IsIndependentOfTheFrameOfReference) {
  Random random(5);
  BeamSample sample(random, context_of(1.0));
  const BeamElement beam = sample.element();
  const PairMotion& m = sample.motion;
  const Quat Q = random.orientation();
  const Vec3 shift = random.vector(3.0);
  PairMotion turned = m;
  for (BodyMotion* body : {&turned.a_n, &turned.b_n}) {
    body->r = Q * body->r + shift;
    body->q = Q * body->q;
    body->v = Q * body->v;
    body->a = Q * body->a;
  }
  for (Vec3* x : {&turned.u_a, &turned.theta_a, &turned.u_b, &turned.theta_b}) *x = Q * *x;
  const Displacement w = wrenches(evaluate(beam, m)), v = wrenches(evaluate(beam, turned));
  for (int i = 0; i < 12; i += 3)
    EXPECT_LT((v.segment<3>(i) - Q * w.segment<3>(i)).norm(), 1e-14 * kEnergy) << i;
}

TEST(BeamElement, IsTheSameFromItsOtherEnd) {
  Random random(6);
  const Mat3 about_z = Vec3(-1, -1, 1).asDiagonal();
  const Vec6 signs = (Vec6() << 1, 1, -1, 1, 1, -1).finished();
  BeamSample sample(random, context_of(1.0));
  const PairTerms t = evaluate(sample.element(), sample.motion);
  BeamSample other = sample;
  std::swap(other.motion.a_n, other.motion.b_n);
  std::swap(other.motion.u_a, other.motion.u_b);
  std::swap(other.motion.theta_a, other.motion.theta_b);
  std::swap(other.spec.end_1, other.spec.end_2);
  other.spec.end_1.Q *= about_z;
  other.spec.end_2.Q *= about_z;
  other.spec.stiffness = signs.asDiagonal() * sample.spec.stiffness * signs.asDiagonal();
  other.spec.reference_strain = signs.asDiagonal() * sample.spec.reference_strain;
  const PairTerms r = evaluate(other.element(), other.motion);
  EXPECT_LT((r.wrench_a - t.wrench_b).norm(), 1e-14 * kEnergy);
  EXPECT_LT((r.wrench_b - t.wrench_a).norm(), 1e-14 * kEnergy);
}

TEST(BeamElement, HasNoForceInItsReferenceConfiguration) {
  Random random(7);
  BeamSample sample(random, context_of(0.0));
  sample.motion.context.conserving = false;
  const PairMotion& m = sample.motion;
  set_reference(sample.spec, PairMotion::instant(m.a_n), PairMotion::instant(m.b_n));
  const BeamElement beam(sample.spec);
  m.at_start([&](const PairStep& s) {
    PairTerms t;
    t.set_zero();
    beam.evaluate(s, t);
    EXPECT_LT(wrenches(t).norm(), 1e-13);
    EXPECT_LT(beam.work(s).stored, 1e-28);
  });
}

// A quarter of a circle of radius 2 between two frames: length and curvature of the arc.
TEST(BeamElement, TakesItsLengthFromTheArcBetweenItsEnds) {
  BeamElementSpec spec;
  spec.name = "arc";
  spec.end_2.Q = exp_map(Vec3(0, 0, 0.5 * std::numbers::pi));
  set_reference(spec, at_rest({0, 0, 0}), at_rest({2, 2, 0}));
  EXPECT_NEAR(spec.length, std::numbers::pi, 1e-14);
  EXPECT_LT((spec.reference_strain - (Vec6() << 1, 0, 0, 0, 0, 0.5).finished()).norm(), 1e-14);
}

// Small end loads on a clamped straight element: with the residual bending flexibility its tip has
// the displacement of a Timoshenko cantilever of any length.
// @tests{beam-residual-flexibility}
TEST(BeamElement, BendsAsTheExactCantileverUnderEndLoads) {
  const double EI_y = 3.0, EI_z = 5.0, GA = 40.0, L = 2.5;
  BeamElementSpec spec;
  spec.name = "cantilever";
  spec.bodies = {kGround, 0};
  spec.stiffness.diagonal() << 100.0, GA, 0.5 * GA, 2.0, EI_y, EI_z;
  const BodyStep tip = at_rest({L, 0, 0});
  const BodyStep ground = BodyStep::ground(1.0);
  set_reference(spec, ground, tip);
  StepContext context = context_of(0.0);
  context.conserving = false;
  PairTerms t;
  t.set_zero();
  const BeamElement beam(spec);
  double history[6];
  beam.initialize({ground, tip, context, nullptr, history}, history);
  beam.evaluate({ground, tip, context, nullptr, history}, t);
  const Mat6 flexibility = (-t.D_bb).inverse();
  EXPECT_NEAR(flexibility(1, 1), L * L * L / (3 * EI_z) + L / GA, 1e-13);
  EXPECT_NEAR(flexibility(2, 2), L * L * L / (3 * EI_y) + L / (0.5 * GA), 1e-13);
  EXPECT_NEAR(flexibility(5, 1), L * L / (2 * EI_z), 1e-13);
  EXPECT_NEAR(flexibility(4, 2), -L * L / (2 * EI_y), 1e-13);
  EXPECT_NEAR(flexibility(3, 3), L / 2.0, 1e-13);
}

TEST(BeamElement, ExtrapolatesItsSectionForcesLinearly) {
  Random random(8);
  BeamSample sample(random, context_of(0.0));
  const BeamElement beam = sample.element();
  const Vec6 of_1 = 1e-6 * (Vec6() << random.vector(), random.vector()).finished();
  const Vec6 of_2 = 1e-6 * (Vec6() << random.vector(), random.vector()).finished();
  Vec6 expected;
  sample.motion.with((Displacement() << of_1, of_2).finished(),
                     [&](const PairStep& s) { expected = beam.section_forces(s); });
  sample.motion.with(Displacement::Zero(), [&](const PairStep& s) {
    beam.extrapolate(s, of_1, of_2, sample.motion.history.data());
  });
  EXPECT_LT((Eigen::Map<Vec6>(sample.motion.history.data()) - expected).norm(), 1e-9);
}

TEST(BeamElement, RefusesInvalidBeams) {
  Random random(9);
  const auto refused = [&](auto&& change) {
    BeamSample sample(random, context_of(1.0));
    change(sample.spec);
    EXPECT_THROW(BeamElement{sample.spec}, InputError);
  };
  refused([](BeamElementSpec& s) { s.length = 0.0; });
  refused([](BeamElementSpec& s) { s.stiffness(3, 3) = -1.0; });
  refused([](BeamElementSpec& s) { s.stiffness(0, 5) = s.stiffness(5, 0) = 1e3; });
  refused([](BeamElementSpec& s) { s.coupled_mass = 1.0; });
  BeamElementSpec spec;
  spec.end_2.Q = exp_map(Vec3(0, 2.6, 0));
  const BodyStep here = at_rest({0, 0, 0});
  const BodyStep there = at_rest({1, 0, 0});
  EXPECT_THROW(set_reference(spec, here, there), InputError);
  spec.end_2.Q = Mat3::Identity();
  EXPECT_THROW(set_reference(spec, here, here), InputError);
}

TEST(BeamElement, RefusesTooMuchBendingAndSuggestsMoreElements) {
  Random random(10);
  BeamSample sample(random, context_of(1.0));
  const BeamElement beam = sample.element();
  EXPECT_TRUE(beam.always_queried());
  sample.motion.with(Displacement::Zero(),
                     [&](const PairStep& s) { EXPECT_TRUE(beam.acceptable(s)); });
  sample.spec.end_2.Q = sample.spec.end_2.Q * exp_map(Vec3(0, 3.0, 0));
  const BeamElement bent(sample.spec);
  sample.motion.with(Displacement::Zero(),
                     [&](const PairStep& s) { EXPECT_FALSE(bent.acceptable(s)); });
  EXPECT_NE(std::string(beam.refusal()).find("more elements"), std::string::npos);
}

}  // namespace polhode::test::beam_element_tests
