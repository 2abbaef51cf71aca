// SPDX-License-Identifier: Apache-2.0
#include <polhode/math/exp_map.hpp>
#include <polhode/system/free_coordinate.hpp>
#include <support/derivative.hpp>
#include <support/random_steps.hpp>

namespace polhode::test::free_coordinate_tests {
namespace {

/// Angle about z on frames R_a, R_b, measured from either side.
FreeAngle angle_about_z(const Mat3& R_a, const Mat3& R_b, bool on_b) {
  if (!on_b) return {R_a.col(0), R_a.col(1), R_b.col(0), false};
  return {R_b.col(0), -R_b.col(1), R_a.col(0), true};  // e × f against the axis.
}

/// A step with the axes of both bodies aligned at its two ends, turning by `turn` in between.
PairMotion aligned(Random& random, const StepContext& context, const Mat3& R_a, const Mat3& R_b,
                   double start, double turn) {
  PairMotion m(random, context);
  const auto b_of = [&](const Mat3& Lambda_a, double angle) -> Mat3 {
    return Lambda_a * R_a * exp_map(angle * Vec3::UnitZ()) * R_b.transpose();
  };
  m.b_n.q = Quat(b_of(m.a_n.Lambda(), start)).normalized();
  m.theta_b = cayley_vector(b_of(m.a().Lambda_n1, start + turn) * m.b_n.Lambda().transpose());
  return m;
}

}  // namespace

// @tests{free-angle-gradient}
TEST(FreeAngle, HasADiscreteGradientThatGivesTheFiniteRotation) {
  for (const bool on_b : {false, true})
    for (const double turn : {1e-9, 1e-3, 0.019, 0.021, 0.3, -1.4, 2.0}) {
      Random random(3);
      const Mat3 R_a = random.frame(), R_b = random.frame();
      const FreeAngle angle = angle_about_z(R_a, R_b, on_b);
      const double start = 2.5;
      const PairMotion m = aligned(random, context_of(1.0), R_a, R_b, start, turn);
      const BodyStep a = m.a(), b = m.b();
      const AngleStep s = angle_step(angle, a, b, start, true);
      EXPECT_NEAR(s.at_n1, start + turn, 2e-14);
      EXPECT_NEAR(s.mu.dot(b.theta - a.theta), turn, 1e-14 + 2e-15 * std::abs(turn));
    }
}

// W is Newmark's, so the rate at ρ∞ = 1 is the mean one if the bodies' mean W are Θ/Δt.
TEST(FreeAngle, TurnsAtTheMeanRateOverAStepAtSpectralRadiusOne) {
  Random random(4);
  const Mat3 R_a = random.frame(), R_b = random.frame();
  const StepContext context = context_of(1.0);
  const PairMotion m = aligned(random, context, R_a, R_b, 0.2, 0.5);
  const AngleStep s = angle_step(angle_about_z(R_a, R_b, false), m.a(), m.b(), 0.2, true);
  EXPECT_NEAR(s.rate, 0.5 / context.dt, 1e-13);
}

TEST(FreeAngle, HasItsTangents) {
  for (const bool conserving : {true, false})
    for (const bool on_b : {false, true})
      for (const double rho_inf : {1.0, 0.5, 0.0}) {
        Random random(7);
        const Mat3 R_a = random.frame(), R_b = random.frame();
        const FreeAngle angle = angle_about_z(R_a, R_b, on_b);
        const PairMotion m = aligned(random, context_of(rho_inf), R_a, R_b, 0.2, 0.5);
        const auto step = [&](const Displacement& d) {
          return angle_step(angle, m.a(d), m.b(d), 0.2, conserving);
        };
        const AngleStep s = step(Displacement::Zero());
        Eigen::Matrix<double, 5, 12> D = Eigen::Matrix<double, 5, 12>::Zero();
        D.block<1, 3>(0, 3) = s.D_alpha_a.transpose();
        D.block<1, 3>(0, 9) = s.D_alpha_b.transpose();
        D.block<1, 3>(1, 3) = s.D_rate_a.transpose();
        D.block<1, 3>(1, 9) = s.D_rate_b.transpose();
        D.block<3, 3>(2, 3) = s.D_mu_a;
        D.block<3, 3>(2, 9) = s.D_mu_b;
        expect_derivative(
            D,
            [&](const Vec& d) -> Vec {
              const AngleStep x = step(d);
              Vec out(5);
              out << x.at_alpha, x.rate, x.mu;
              return out;
            },
            "angle_step");
      }
}

TEST(FreeAngle, ChoosesTheTurnNearestToAGivenAngle) {
  const FreeAngle angle;
  const BodyStep a = BodyStep::ground(1.0);
  const BodyStep b =
      BodyStep::at_instant(Vec3::Zero(), exp_map(0.5 * Vec3::UnitZ()), Vec3::Zero(), Vec3::Zero());
  const double turn = 2.0 * 3.14159265358979324;
  EXPECT_NEAR(angle.at_n1(a, b, 0.0), 0.5, 1e-15);
  EXPECT_NEAR(angle.at_n1(a, b, 3.0 * turn + 0.1), 3.0 * turn + 0.5, 1e-14);
  EXPECT_NEAR(angle.at_n1(a, b, -turn), 0.5 - turn, 1e-14);
}

}  // namespace polhode::test::free_coordinate_tests
