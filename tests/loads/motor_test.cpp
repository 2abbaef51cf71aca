// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <loads/load_samples.hpp>
#include <polhode/loads/motor.hpp>

namespace polhode::test::motor_tests {
namespace {

/// 2 + sin 3t, whose derivatives are known.
class Swing final : public TimeFunction {
 public:
  double operator()(double t) const override { return 2.0 + std::sin(3.0 * t); }
  [[nodiscard]] TimeRates rates(double t, TimeSide) const override {
    return {(*this)(t), 3.0 * std::cos(3.0 * t), -9.0 * std::sin(3.0 * t)};
  }
};

struct Sample {
  Motor motor;
  PairMotion motion;
};

Sample sample(unsigned seed, const StepContext& context, bool turns, const std::string& drive) {
  Random random(seed);
  const Mat3 R_a = random.frame(), R_b = random.frame();
  LoadDescription d;
  d.name = "motor";
  d.bodies = {0, 1};
  d.function = std::make_shared<Swing>();
  d.drive = drive;
  if (turns)
    d.angle = FreeAngle{R_a.col(0), R_a.col(1), R_b.col(0), false};
  else
    d.displacement = FreeDisplacement{random.vector(0.5), random.vector(0.5), R_a.col(2)};
  PairMotion m(random, context);
  if (turns) {  // aligned axes at both ends
    const auto b_of = [&](const Mat3& Lambda_a, double angle) -> Mat3 {
      return Lambda_a * R_a * exp_map(angle * Vec3::UnitZ()) * R_b.transpose();
    };
    m.b_n.q = Quat(b_of(m.a_n.Lambda(), 0.3)).normalized();
    m.theta_b = cayley_vector(b_of(m.a().Lambda_n1, 0.9) * m.b_n.Lambda().transpose());
  }
  Motor motor(d);
  m.at_start([&](const PairStep& s) {
    motor.initialize(s, m.history.data());
    return 0;
  });
  m.lambda[0] = 1.7;
  return {motor, m};
}

}  // namespace

TEST(Motor, HasTheTangentsOfItsWrenchAndItsRow) {
  for (const bool turns : {true, false})
    for (const char* drive : {"angle", "speed", "moment"})
      for (const double rho_inf : {1.0, 0.5, 0.0}) {
        const auto sampled = sample(1, context_of(rho_inf), turns, drive);
        const auto& motor = sampled.motor;
        const auto& m = sampled.motion;
        expect_derivative(
            wrench_tangent(evaluate(motor, m)),
            [&](const Vec& d) -> Vec { return wrenches(evaluate(motor, m, d)); }, drive);
        if (motor.rows() == 0) continue;
        const PairTerms t = evaluate(motor, m);
        Mat G(1, 12);
        G << t.G_a.row(0), t.G_b.row(0);
        expect_derivative(
            G, [&](const Vec& d) -> Vec { return evaluate(motor, m, d).g.head<1>(); }, drive);
      }
}

// λ times the change of the coordinate, to the last digit. @tests{drive-work}
TEST(Motor, DoesTheWorkOfItsForceAlongTheCoordinate) {
  for (unsigned seed = 1; seed <= 8; ++seed)
    for (const bool turns : {true, false}) {
      const auto sampled = sample(seed, context_of(1.0), turns, "angle");
      const auto& motor = sampled.motor;
      const auto& m = sampled.motion;
      const PairTerms t = evaluate(motor, m);
      const double now = m.at_start([&](const PairStep& s) { return motor.report(s)[3]; });
      const double then = t.g[0] + 2.0 + std::sin(3.0 * m.context.t_n1());
      EXPECT_NEAR(work_done(m, t), m.lambda[0] * (then - now), 1e-12) << seed << ' ' << turns;
    }
}

// A speed integrates to its angle. @tests{drive-row}
TEST(Motor, FollowsTheIntegralOfItsSpeed) {
  for (const bool turns : {true, false}) {
    const auto sampled = sample(3, context_of(1.0), turns, "speed");
    const auto& motor = sampled.motor;
    const auto& m = sampled.motion;
    const StepContext& c = m.context;
    PrescribedRows rows;
    m.with(Displacement::Zero(), [&](const PairStep& s) {
      motor.prescribed(s, TimeSide::kBefore, rows);
      return 0;
    });
    const double whole = 2.0 * c.dt - (std::cos(3.0 * c.t_n1()) - std::cos(3.0 * c.t_n)) / 3.0;
    EXPECT_NEAR(rows.increment[0], whole, 1e-13);
    EXPECT_NEAR(rows.rate[0], 2.0 + std::sin(3.0 * c.t_n1()), 1e-14);
    EXPECT_NEAR(rows.second[0], 3.0 * std::cos(3.0 * c.t_n1()), 1e-14);
  }
}

}  // namespace polhode::test::motor_tests
