// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <polhode/beams/running_cable.hpp>
#include <support/derivative.hpp>
#include <support/random_steps.hpp>

namespace polhode::test::running_cable_tests {
namespace {

class Ramp final : public TimeFunction {
 public:
  double operator()(double t) const override { return 0.3 + 0.2 * t; }
  [[nodiscard]] TimeRates rates(double t, TimeSide) const override {
    return {(*this)(t), 0.2, 0.0};
  }
};

constexpr int kPoints = 4;

/// A cable over four points that move.
struct Sample {
  RunningCable cable;
  std::vector<double> x_n, x_n1, u, v_n, v_n1;
  std::vector<double> history;  ///< With friction.
  StepContext context;
  double rate = 0.0;

  Sample(const RunningCableSpec& spec, double rho_inf, double move, unsigned seed) : cable(spec) {
    Random random(seed);
    context.ga = GeneralizedAlpha::from_spectral_radius(rho_inf);
    context.t_n = 0.4;
    context.dt = 0.01;
    context.conserving = true;
    rate = context.ga.c / context.dt;
    if (spec.friction > 0.0) {  // parts whose sum over stiffness is zero
      history = {0.3 * spec.pieces[1], -0.3 * spec.pieces[0], 0.0};
      for (double& part : history)
        part *= spec.stiffness * spec.free_length / spec.pieces[0] / spec.pieces[1] * 0.1;
    }
    for (int i = 0; i < kPoints; ++i) {
      const Vec3 at = random.vector(0.3) + 0.8 * i * Vec3::UnitX();
      const Vec3 way = random.vector(move), v = random.vector(2.0);
      for (int c = 0; c < 3; ++c) {
        x_n.push_back(at[c]);
        x_n1.push_back(at[c] + way[c]);
        u.push_back(way[c]);
        v_n.push_back(v[c]);
        v_n1.push_back(v[c] + rate * way[c]);
      }
    }
  }
  [[nodiscard]] Sample moved(const Vec& d) const {
    Sample s = *this;
    for (std::size_t k = 0; k < x_n1.size(); ++k) {
      const double by = d[static_cast<Eigen::Index>(k)];
      s.x_n1[k] += by;
      s.u[k] += by;
      s.v_n1[k] += rate * by;
    }
    return s;
  }
  [[nodiscard]] NodeStep step() const {
    return {.x_n = x_n.data(),
            .x_n1 = x_n1.data(),
            .u = u.data(),
            .v_n = v_n.data(),
            .v_n1 = v_n1.data(),
            .context = context,
            .alpha_f = context.ga.alpha_f,
            .rate = rate};
  }
  [[nodiscard]] Vec force(Mat* K = nullptr) const {
    std::vector<double> f(3 * kPoints, 0.0), k(9 * kPoints * kPoints, 0.0);
    std::vector<int> slots;
    for (int i = 0; i < kPoints * kPoints; ++i) slots.push_back(i);
    cable.evaluate(step(), history.data(), nullptr, Mat3::Identity(),
                   {f.data(), K ? k.data() : nullptr, slots.data()});
    if (K) {
      K->resize(3 * kPoints, 3 * kPoints);
      for (int i = 0; i < kPoints; ++i)
        for (int j = 0; j < kPoints; ++j)
          for (int r = 0; r < 3; ++r)
            for (int c = 0; c < 3; ++c)
              (*K)(3 * i + r, 3 * j + c) =
                  k[static_cast<std::size_t>(9 * (i * kPoints + j) + 3 * r + c)];
    }
    return Eigen::Map<const Vec>(f.data(), 3 * kPoints);
  }
};

/// Kinds of cable: taut, slack at one end of the step, with a damper, with a given tension,
/// muscles; friction that sticks, slips at some points, slips at all.
std::vector<RunningCableSpec> kinds(double length) {
  RunningCableSpec plain;
  plain.name = "rope";
  plain.nodes = {0, 1, 2, 3};
  plain.stiffness = 300.0;
  plain.free_length = 0.8 * length;
  std::vector<RunningCableSpec> list{plain};
  list.push_back(plain);
  list.back().free_length = length;
  list.push_back(plain);
  list.back().damping = 5.0;
  list.push_back(plain);
  list.back().stiffness = 0.0;
  list.back().tension = std::make_shared<Ramp>();
  list.push_back(plain);
  list.back().stiffness = 0.0;
  list.back().tension_only = false;
  list.back().muscle = HillMuscle{.max_force = 400.0,
                                  .optimal_length = 0.5 * length,
                                  .tendon_length = 0.45 * length,
                                  .pennation = 0.3,
                                  .max_velocity = 8.0,
                                  .damping = 0.1,
                                  .activation = std::make_shared<Ramp>()};
  for (const double mu : {3.0, 0.5, 0.02}) {
    list.push_back(plain);
    list.back().friction = mu;
    list.back().damping = mu == 0.5 ? 2.0 : 0.0;
    const double free = list.back().free_length;
    list.back().pieces = {0.3 * free, 0.45 * free, 0.25 * free};
  }
  return list;
}

double middle_length(const Sample& s) {
  double sum = 0.0;
  for (int i = 0; i + 1 < kPoints; ++i)
    sum += 0.5 * ((NodeStep::at(s.x_n.data(), i + 1) - NodeStep::at(s.x_n.data(), i)).norm() +
                  (NodeStep::at(s.x_n1.data(), i + 1) - NodeStep::at(s.x_n1.data(), i)).norm());
  return sum;
}

}  // namespace

TEST(RunningCable, HasTheTangentOfItsForces) {
  for (const double rho_inf : {1.0, 0.5, 0.0})
    for (const double move : {0.15, 1e-5})
      for (unsigned seed = 1; seed <= 3; ++seed) {
        const double length = middle_length(Sample(kinds(1.0)[0], rho_inf, move, seed));
        int kind = 0;
        for (const RunningCableSpec& spec : kinds(length)) {
          if (++kind == 2 && move < 1e-3) continue;  // the corner of the force law itself
          const Sample s(spec, rho_inf, move, seed);
          Mat K;
          (void)s.force(&K);
          expect_derivative(
              K, [&](const Vec& d) -> Vec { return s.moved(d).force(); },
              "kind " + std::to_string(kind),
              kind == 2 ? 1e-6 : 1e-7);  // differences of a force with a corner are rougher
        }
      }
}

// Work of the forces: the stored energy, the dissipated and the supplied one; resultant force and
// moment vanish. @tests{running-cable} @tests{cable-capstan-step}
TEST(RunningCable, ReturnsExactlyTheEnergyItStored) {
  for (const double move : {0.3, 0.02, 1e-4, 1e-7})
    for (unsigned seed = 1; seed <= 5; ++seed) {
      const double length = middle_length(Sample(kinds(1.0)[0], 1.0, move, seed));
      for (const RunningCableSpec& spec : kinds(length)) {
        const Sample s(spec, 1.0, move, seed);
        const Vec f = s.force();
        Sample before = s;
        before.x_n1 = s.x_n;
        before.context.dt = 0.0;
        const double* history = s.history.data();
        const double stored = s.cable.work(s.step(), history, nullptr).stored -
                              s.cable.work(before.step(), history, nullptr).stored;
        const Work w = s.cable.work(s.step(), history, nullptr);
        const double work = f.dot(Eigen::Map<const Vec>(s.u.data(), 3 * kPoints));
        EXPECT_NEAR(work, w.put_in - w.dissipated - stored, 2e-13 * (1.0 + f.norm())) << seed;
        EXPECT_GE(w.dissipated, 0.0);
        Vec3 sum = Vec3::Zero(), moment = Vec3::Zero();
        for (int i = 0; i < kPoints; ++i) {
          const Vec3 force = f.segment<3>(3 * i);
          sum += force;
          moment += s.step().position_alpha(i).cross(force);
        }
        EXPECT_LT(sum.norm(), 1e-12);
        EXPECT_LT(moment.norm(), 1e-12);
      }
    }
}

// Ratio of tensions at each point: at most e^{μβ}, less at points that stick; the mean weighted by
// compliance is unchanged.
// @tests{cable-capstan}
TEST(CableFriction, SticksUpToTheCapstanRatio) {
  Random random(7);
  int slipped = 0;
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<double> k;
    for (int i = 0; i < 5; ++i) k.push_back(std::exp(random.number(1.5)));
    const CableFriction friction(k);
    Vec N(5), ratio(4);
    for (int i = 0; i < 5; ++i) N[i] = 1.0 + random.number(1.5);
    for (int i = 0; i < 4; ++i) ratio[i] = std::exp(-std::abs(random.number(1.0)));
    const Vec compliance = Eigen::Map<const Vec>(k.data(), 5).cwiseInverse();
    if (compliance.dot(N) <= 0.0) continue;
    const CableFriction::Held held = friction.hold(N, ratio);
    EXPECT_NEAR(compliance.dot(held.tension - N), 0.0, 1e-12);
    double material = 0.0;
    for (int j = 0; j < 4; ++j) {
      const double a = held.tension[j], b = held.tension[j + 1];
      EXPECT_GT(a, 0.0);
      EXPECT_GE(b, ratio[j] * a * (1.0 - 1e-11));
      EXPECT_GE(a, ratio[j] * b * (1.0 - 1e-11));
      // Material that passed over the point: from the slacker side, and only at the limiting ratio.
      material += (held.tension[j] - N[j]) / k[static_cast<std::size_t>(j)];
      if (std::abs(material) < 1e-11) continue;
      ++slipped;
      EXPECT_NEAR(material > 0.0 ? ratio[j] * b / a : ratio[j] * a / b, 1.0, 1e-10);
    }
  }
  EXPECT_GT(slipped, 100);
}

// Tension of a muscle held still: a f_L + f_P along the tendon. @tests{muscle-force}
TEST(RunningCable, HasTheTensionOfItsMuscle) {
  RunningCableSpec spec = kinds(2.0)[4];
  spec.nodes = {0, 1};
  const HillMuscle& m = *spec.muscle;
  for (const double fibre : {0.7, 1.0, 1.3}) {
    // Fibres of that length; their thickness is that of the optimal fibres.
    const double along = std::sqrt(fibre * fibre - std::pow(std::sin(m.pennation), 2));
    const double length = m.tendon_length + m.optimal_length * along;
    const std::vector<double> x{0.0, 0.0, 0.0, length, 0.0, 0.0}, still(6, 0.0);
    StepContext context;
    context.t_n = 2.0;
    const NodeStep instant{.x_n = x.data(),
                           .x_n1 = x.data(),
                           .u = still.data(),
                           .v_n = still.data(),
                           .v_n1 = still.data(),
                           .context = context,
                           .alpha_f = 1.0};
    const RunningCableReport r = RunningCable(spec).report(instant, nullptr);
    EXPECT_NEAR(r.fibre_length, fibre * m.optimal_length, 1e-14);
    EXPECT_NEAR(r.activation, 0.7, 1e-15);
    const double bells =
        0.815 * std::exp(-0.5 * std::pow((fibre - 1.055) / (0.162 + 0.063 * fibre), 2)) +
        0.433 * std::exp(-0.5 * std::pow((fibre - 0.717) / (-0.030 + 0.2 * fibre), 2)) +
        0.1 * std::exp(-0.5 * std::pow((fibre - 1.0) / 0.354, 2));
    const double passive = std::expm1(4.0 * (fibre - 1.0) / 0.6) / std::expm1(4.0);
    EXPECT_NEAR(r.tension, 400.0 * (0.7 * bells + passive) * along / fibre, 0.02);
    EXPECT_NEAR(r.passive, 400.0 * passive * along / fibre, 1e-11);
  }
}

}  // namespace polhode::test::running_cable_tests
