// SPDX-License-Identifier: Apache-2.0
// Clamped beams under dead end loads by mixed-point iterations, against the shooting solutions of
// the beam's differential equations (tests/validation/data/static_beams.yaml).
#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>
#include <Eigen/LU>

#include <polhode/compile/beam_mesh.hpp>
#include <polhode/compile/build_system.hpp>
#include <polhode/equations/newton_system.hpp>
#include <polhode/math/quaternion.hpp>
#include <polhode/stepping/start.hpp>
#include <support/beam_models.hpp>

namespace polhode::test::beam_static_tests {
namespace {

constexpr double kPi = std::numbers::pi;

/// A beam clamped at its first node; Newton's method with a dense matrix.
class ClampedBeam {
 public:
  explicit ClampedBeam(const BeamSpec& beam)
      : system_(built(beam)), state_(system_.initial_state()) {
    initialize_histories(system_, state_);
    context_.ga = GeneralizedAlpha::from_spectral_radius(0.0);
    context_.conserving = false;
    context_.mixed_point = true;
    // The extrapolated section forces of the start are zero, as those of its shape.
  }

  /// Iterations to equilibrium with the load on the last node; −1: more than 40. Residuals are
  /// relative to the largest force or moment on a node.
  int solve(const Vec3& force, const Vec3& moment, double tolerance) {
    const int n = 6 * system_.body_count();
    for (int it = 0; it <= 40; ++it) {
      take_steps();
      Vec g = Vec::Zero(n);
      Mat K = Mat::Zero(n, n);
      g.tail<6>() << force, moment;
      double scale = std::max(force.norm(), moment.norm());
      InteractionSweep sweep(system_);
      sweep.run(steps_, context_, nullptr, state_.history.data(),
                [&](int i, const PairStep&, const PairTerms& t) {
                  const InteractionRef& ref = system_.interactions()[i];
                  const int a = 6 * ref.a, b = 6 * ref.b;
                  g.segment<6>(a) += t.wrench_a;
                  g.segment<6>(b) += t.wrench_b;
                  scale = std::max(scale, t.wrench_b.lpNorm<Eigen::Infinity>());
                  K.block<6, 6>(a, a) -= t.D_aa;
                  K.block<6, 6>(a, b) -= t.D_ab;
                  K.block<6, 6>(b, a) -= t.D_ba;
                  K.block<6, 6>(b, b) -= t.D_bb;
                });
      const int free = n - 6;
      if (g.tail(free).lpNorm<Eigen::Infinity>() < tolerance * scale) return it;
      Vec dq = Vec::Zero(n);
      dq.tail(free) = K.bottomRightCorner(free, free).partialPivLu().solve(g.tail(free));
      extrapolate(dq);
      move(dq);
    }
    return -1;
  }

  [[nodiscard]] BodyMotion tip() const { return system_.motion(state_, system_.body_count() - 1); }

 private:
  static System built(const BeamSpec& beam) {
    Model m;
    add_beam(m, beam);
    return build_system(m);
  }
  void take_steps() {
    steps_.clear();
    for (int b = 0; b < system_.body_count(); ++b) steps_.push_back(system_.instant(state_, b));
    steps_.push_back(BodyStep::ground(1.0));
  }
  void extrapolate(const Vec& dq) {
    for (const InteractionRef& ref : system_.interactions()) {
      double* const history = state_.history.data() + ref.first_history;
      const PairStep step{steps_[static_cast<std::size_t>(ref.a)],
                          steps_[static_cast<std::size_t>(ref.b)], context_, nullptr, history};
      system_.group(ref.group).extrapolate(ref.item, step, dq.segment<6>(6 * ref.a),
                                           dq.segment<6>(6 * ref.b), history);
    }
  }
  /// Newton increment, scaled so that no node turns by more than 1.9 rad.
  void move(const Vec& dq) {
    double most = 0.0;
    for (int b = 0; b < system_.body_count(); ++b)
      most = std::max(most, dq.segment<3>(6 * b + 3).lpNorm<Eigen::Infinity>());
    const double part = std::min(1.0, 1.9 / std::max(most, 1e-30));
    for (int b = 0; b < system_.body_count(); ++b) {
      BodyMotion m = system_.motion(state_, b);
      m.r += part * dq.segment<3>(6 * b);
      m.q = (quaternion_from_cayley(part * dq.segment<3>(6 * b + 3)) * m.q).normalized();
      state_.set_motion(system_.slot(b), m);
    }
  }

  System system_;
  State state_;
  StepContext context_;
  std::vector<BodyStep> steps_;
};

/// Straight beam along x; axes y and z of its section are those of the ground.
BeamSpec straight(double length, int elements, const Vec6& stiffness) {
  BeamSpec beam = beam_through({{0, 0, 0}, {length, 0, 0}}, elements, {1, 1, 1, 1, 1.0, {1, 1, 1}});
  beam.section.section.stiffness = stiffness.asDiagonal();
  beam.up = Vec3::UnitY();
  return beam;
}

}  // namespace

// A full circle in one load step; the residual stops at the round-off of EA.
TEST(BeamStatics, RollsUpToACircleInOneLoadStep) {
  const double L = 10.0, EI = 100.0;
  for (const double EA : {1e4, 1e7})
    for (const int elements : {5, 10, 40}) {
      ClampedBeam beam(straight(L, elements, (Vec6() << EA, EA, EA, EI, EI, EI).finished()));
      const int iterations = beam.solve(Vec3::Zero(), {0, 0, 2.0 * kPi * EI / L}, 1e-7);
      EXPECT_GT(iterations, 0) << EA << ' ' << elements;
      EXPECT_LE(iterations, 9) << EA << ' ' << elements;
      EXPECT_LT(beam.tip().r.norm(), 1e-8) << EA << ' ' << elements;
    }
}

// The Princeton beam: dead tip loads at angles from edge to flat, bent out of both planes.
TEST(BeamStatics, BendsAsThePrincetonBeamInOneLoadStep) {
  const double L = 0.508, h = 12.3777e-3, w = 3.2024e-3, E = 71.7e9, G = E / 2.62;
  const double A = h * w, I_y = h * w * w * w / 12, I_z = w * h * h * h / 12;
  const Vec6 C =
      (Vec6() << E * A, G * A, G * A, G * 0.198 * (I_y + I_z), E * I_y, E * I_z).finished();
  const struct {
    double force, degrees;
    Vec3 tip;
  } cases[] = {{4.448, 45, {-0.00374820836, -0.00397643378, 0.0560635007}},
               {8.896, 15, {-0.00224846384, -0.0106435814, 0.0421924486}},
               {8.896, 45, {-0.0144118248, -0.00897919672, 0.109113115}},
               {13.345, 0, {-0.000304668367, -0.0160611789, 0.0}},
               {13.345, 45, {-0.0304529347, -0.0156211499, 0.156774618}},
               {13.345, 75, {-0.0480856125, -0.0064703353, 0.196138734}},
               {13.345, 90, {-0.0504010154, 0.0, 0.200683961}}};
  // Second order: errors of 8, 16, 32 elements are at most 2.7e-5, 7.0e-6, 1.7e-6 m.
  const std::pair<int, double> meshes[] = {{8, 3e-5}, {16, 8e-6}, {32, 2e-6}};
  for (const auto& [elements, within] : meshes)
    for (const auto& [P, degrees, tip] : cases) {
      ClampedBeam beam(straight(L, elements, C));
      const double angle = degrees * kPi / 180.0;
      const int iterations =
          beam.solve({0, -P * std::cos(angle), P * std::sin(angle)}, Vec3::Zero(), 1e-7);
      EXPECT_GT(iterations, 0) << P << ' ' << degrees;
      EXPECT_LE(iterations, 6) << P << ' ' << degrees;
      EXPECT_LT((beam.tip().r - Vec3(L, 0, 0) - tip).lpNorm<Eigen::Infinity>(), within)
          << elements << ' ' << P << ' ' << degrees;
    }
}

// The bend of 45 degrees: the circular mesh, shear factor 5/6, J = 1/6, against the reference.
TEST(BeamStatics, BendsTheArcOf45Degrees) {
  const double R = 100.0, E = 1e7, G = 5e6;
  BeamSpec beam =
      straight(R, 32, (Vec6() << E, G * 5 / 6, G * 5 / 6, G / 6, E / 12, E / 12).finished());
  beam.arc = true;
  const auto at = [&](double angle) -> Vec3 {
    return {R * std::sin(angle), R * (1.0 - std::cos(angle)), 0.0};
  };
  beam.points = {at(0.0), at(0.3), at(kPi / 4.0)};
  beam.up = Vec3::UnitZ();
  ClampedBeam bend(beam);
  for (int k = 1; k <= 3; ++k) ASSERT_GT(bend.solve({0, 0, 200.0 * k}, Vec3::Zero(), 1e-8), 0);
  EXPECT_LT((bend.tip().r - Vec3(47.1500962, 15.6846895, 53.475478)).norm(), 2e-3);
}

// A short thick cantilever, shear counted: uy of 0.71 on 2.
TEST(BeamStatics, BendsTheThickCantilever) {
  const double L = 2.0, h = 0.5, w = 0.1, E = 2.07e11, G = E / 2.6, k = 13.0 / 15.3;
  const double A = h * w, I = w * h * h * h / 12;
  const Vec6 C =
      (Vec6() << E * A, k * G * A, k * G * A, G * I, E * h * w * w * w / 12, E * I).finished();
  for (const auto& [elements, within] :
       {std::pair(4, 1.5e-4), std::pair(16, 8e-6), std::pair(64, 5e-7)}) {
    ClampedBeam beam(straight(L, elements, C));
    const int iterations = beam.solve({0, 5e8 * h * h * h, 0}, Vec3::Zero(), 1e-9);
    EXPECT_GT(iterations, 0);
    EXPECT_LE(iterations, 7);
    EXPECT_NEAR(beam.tip().r.x(), L - 0.15097114423929137, within) << elements;
    EXPECT_NEAR(beam.tip().r.y(), 0.7105685978536354, within) << elements;
  }
}

}  // namespace polhode::test::beam_static_tests
