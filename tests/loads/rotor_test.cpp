// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <loads/load_samples.hpp>
#include <polhode/loads/rotor.hpp>

namespace polhode::test::rotor_tests {
namespace {

constexpr double kInertia = 0.4;

/// 2 + sin 3t, whose derivatives are known.
class Swing final : public TimeFunction {
 public:
  double operator()(double t) const override { return 2.0 + std::sin(3.0 * t); }
  [[nodiscard]] TimeRates rates(double t, TimeSide) const override {
    return {(*this)(t), 3.0 * std::cos(3.0 * t), -9.0 * std::sin(3.0 * t)};
  }
};

struct Sample {
  Rotor rotor;
  PairMotion motion;
};

Sample sample(unsigned seed, const StepContext& context, const std::string& drive) {
  Random random(seed);
  LoadDescription d;
  d.name = "wheel";
  d.bodies = {kGround, 0};
  d.R_b = random.frame();
  d.values = {{"inertia", kInertia}};
  d.function = std::make_shared<Swing>();
  d.drive = drive;
  PairMotion m(random, context);
  m.a_moves = false;
  m.history[0] = drive == "speed" ? kInertia * Swing()(context.t_n) : 5.0;
  return {Rotor(d), m};
}

/// Its momentum or energy at the end of the step, in addition to those of the body.
template <class Of>
auto at_end(const Sample& s, Of&& of) {
  return s.motion.with(Displacement::Zero(), [&](const PairStep& step) {
    std::array<double, 24> history = s.motion.history;
    s.rotor.commit(step, history.data());
    return of(step.b, history.data());
  });
}
template <class Of>
auto at_start(const Sample& s, Of&& of) {
  return s.motion.at_start(
      [&](const PairStep& step) { return of(step.b, s.motion.history.data()); });
}

}  // namespace

TEST(Rotor, HasTheTangentOfItsWrench) {
  for (const char* drive : {"moment", "speed"})
    for (const double rho_inf : {1.0, 0.5, 0.0}) {
      const Sample s = sample(1, context_of(rho_inf), drive);
      expect_wrench_tangent(s.rotor, s.motion, drive);
    }
}

// Body and rotor together lose nothing, however far the step turns. @tests{rotor-moment}
TEST(Rotor, GivesTheBodyWhatItsMomentumLoses) {
  for (const char* drive : {"moment", "speed"})
    for (unsigned seed = 1; seed <= 8; ++seed) {
      const Sample s = sample(seed, context_of(1.0), drive);
      const auto momentum = [&](const BodyStep& b, const double* history) {
        return s.rotor.added_momentum(b, history);
      };
      const Vec3 change = at_end(s, momentum) - at_start(s, momentum);
      const Vec3 moment = evaluate(s.rotor, s.motion).wrench_b.tail<3>();
      EXPECT_LT((s.motion.context.dt * moment + change).norm(), 2e-14) << drive << seed;
      EXPECT_GT(change.norm(), 0.1);
    }
}

// What the body receives and the rotor's energy gains is the work of the drive: with a moment M it
// is M Δt times the mean speed. @tests{rotor-work}
TEST(Rotor, StoresTheWorkOfItsDriveOrGivesItToTheBody) {
  for (const char* drive : {"moment", "speed"})
    for (unsigned seed = 1; seed <= 8; ++seed) {
      const Sample s = sample(seed, context_of(1.0), drive);
      EXPECT_FALSE(s.rotor.conservative());
      const auto energy = [&](const BodyStep& b, const double* history) {
        return s.rotor.added_energy(b, history);
      };
      const double gained = at_end(s, energy) - at_start(s, energy);
      const double to_body = work_done(s.motion, evaluate(s.rotor, s.motion));
      EXPECT_NEAR(work(s.rotor, s.motion).put_in, gained + to_body, 5e-14) << drive << seed;
    }
}

TEST(Rotor, WithoutAMomentConservesItsEnergy) {
  Random random(5);
  LoadDescription d;
  d.bodies = {kGround, 0};
  d.R_b = random.frame();
  d.values = {{"inertia", kInertia}};
  d.function = std::make_shared<Constant>(0.0);
  d.drive = "moment";
  const Rotor rotor(d);
  EXPECT_TRUE(rotor.conservative());
  PairMotion m(random, context_of(1.0));
  m.a_moves = false;
  m.history[0] = 5.0;
  EXPECT_EQ(work(rotor, m).put_in, 0.0);
  EXPECT_NEAR(work_done(m, evaluate(rotor, m)), 0.0, 1e-14);  // θ is normal to θ × a
}

TEST(Rotor, ReportsItsSpeedRelativeToTheBody) {
  for (const char* drive : {"moment", "speed"}) {
    Sample s = sample(2, context_of(1.0, 0.0), drive);
    const auto [speed, momentum, whole] = s.motion.at_start([&](const PairStep& step) {
      const std::vector<double> r = s.rotor.report(step);
      return std::tuple(r[3], r[4], Vec3(r[5], r[6], r[7]));
    });
    Random random(2);
    const Vec3 axis = random.frame().col(2);
    const double carried = axis.dot(s.motion.b_n.W);
    EXPECT_NEAR(momentum, kInertia * (speed + carried), 1e-14);
    EXPECT_LT((whole - momentum * (s.motion.b_n.Lambda() * axis)).norm(), 1e-14);
    EXPECT_NEAR(speed, std::string(drive) == "speed" ? Swing()(0.7) : 5.0 / kInertia - carried,
                1e-14);
  }
}

}  // namespace polhode::test::rotor_tests
