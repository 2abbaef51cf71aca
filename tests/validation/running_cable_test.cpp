// SPDX-License-Identifier: Apache-2.0
// Running cables over points of several bodies, and muscles on them: closed forms, conservation,
// order, an independent integration.
#include <array>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include <polhode/beams/muscle_curves.hpp>
#include <polhode/core/error.hpp>
#include <polhode/simulation/simulation_details.hpp>
#include <support/run_text.hpp>

namespace polhode::test::running_cable_motion_tests {
namespace {

constexpr double kG = 9.81;

/// Two weights of 3 kg and 2 kg on the ends of a rope over two points 1 m apart.
std::string weights(const std::string& rope) {
  return R"(
format: 1
gravity: [0, 0, -9.81]
variables: {h: 5 ms}
bodies:
  heavy: {mass: 3, inertia: [1, 1, 1], position: [0, 0, -2]}
  light: {mass: 2, inertia: [1, 1, 1], position: [1, 0, -2]}
joints:
  left: {type: prismatic, bodies: [ground, heavy], at: [0, 0, -2], axis: z}
  right: {type: prismatic, bodies: [ground, light], at: [1, 0, -2], axis: z}
cables:
  rope: {through: [[heavy], [ground, [0, 0, 0]], [ground, [1, 0, 0]], [light]], )" +
         rope + R"(}
analysis: {type: dynamics, duration: 0.5 s, step: h}
output: {hdf5: false}
)";
}

// Atwood's machine: a = (m1 − m2) g/(m1 + m2), exactly if the initial extension is that of the
// motion; parabolas are exact at any step. @tests{running-cable}
TEST(RunningCable, MovesAtwoodsMachineByTheClosedForm) {
  const double T = 2.0 * 3.0 * 2.0 * kG / 5.0, a = kG / 5.0;
  const double stiffness = 4e4, free = 5.0 / (1.0 + T / stiffness);
  for (const double h : {0.05, 0.005, 0.0005}) {
    Simulation s =
        made(weights("slides: true, stiffness: 4e4, free_length: " + std::to_string(free)),
             {"h=" + std::to_string(h)});
    const RunSummary r = finished(s);
    // std::to_string cuts at 1e-6 m: a vibration of 4e4/5 · 5e-7 N is left.
    EXPECT_NEAR(s.body(0).r[2], -2.0 - 0.5 * a * 0.25, 2e-6) << h;
    EXPECT_NEAR(s.body(1).r[2], -2.0 + 0.5 * a * 0.25, 2e-6) << h;
    EXPECT_NEAR(s.cable(0).tension[1], T, 0.02) << h;
    EXPECT_LT(r.energy_drift, 1e-12) << h;
  }
}

// A given tension: each weight has its own parabola; its work is supplied energy.
TEST(RunningCable, ActsWithItsTension) {
  for (const double h : {0.05, 0.0005}) {
    Simulation s = made(weights("tension: 25 N"), {"h=" + std::to_string(h)});
    const RunSummary r = finished(s);
    EXPECT_NEAR(s.body(0).r[2], -2.0 + 0.125 * (25.0 / 3.0 - kG), 1e-12) << h;
    EXPECT_NEAR(s.body(1).r[2], -2.0 + 0.125 * (25.0 / 2.0 - kG), 1e-12) << h;
    const double pulled = 0.125 * (25.0 / 3.0 + 25.0 / 2.0 - 2.0 * kG);
    EXPECT_NEAR(s.balance().put_in, 25.0 * pulled, 1e-11) << h;
    EXPECT_LT(r.energy_drift, 1e-12) << h;
  }
}

// A tackle: a block on two falls, with a weight at the end of the rope. T = 3 g/(4/M + 1/m) in the
// mean; the stiff rope vibrates about it.
TEST(RunningCable, MovesATackleByTheClosedForm) {
  Simulation s = made(R"(
format: 1
gravity: [0, 0, -9.81]
bodies:
  block: {mass: 8, inertia: [1, 1, 1], position: [0.1, 0, -1]}
  weight: {mass: 3, inertia: [1, 1, 1], position: [1, 0, -1]}
joints:
  left: {type: prismatic, bodies: [ground, block], at: [0.1, 0, -1], axis: z}
  right: {type: prismatic, bodies: [ground, weight], at: [1, 0, -1], axis: z}
cables:
  rope: {through: [[ground, [0, 0, 0]], [block, [-0.1, 0, 0]], [block, [0.1, 0, 0]], [ground, [0.2, 0, 0]], [ground, [1, 0, 0]], [weight]], slides: true, stiffness: 5e6, damping: 200}
analysis: {type: dynamics, duration: 1 s, step: 1 ms}
output: {hdf5: false}
)");
  const RunSummary r = finished(s);
  const double T = 3.0 * kG / (4.0 / 8.0 + 1.0 / 3.0), a = 2.0 * T / 8.0 - kG;
  EXPECT_NEAR(s.body(0).r[2], -1.0 + 0.5 * a, 2e-4);
  EXPECT_NEAR(s.body(1).r[2], -1.0 - a, 4e-4);
  EXPECT_NEAR(s.cable(0).tension[0], T, 0.05 * T);
  EXPECT_LT(r.energy_drift, 1e-11);
}

/// Three free bodies coupled by a rope at eccentric points.
const char* const kTied = R"(
format: 1
variables: {h: 5 ms, rho: 1}
bodies:
  one: {mass: 3, inertia: [0.1, 0.2, 0.25], position: [0, 0, 0], velocity: [0, 1, 0], angular_velocity: [1, 2, 0.5]}
  two: {mass: 2, inertia: [0.1, 0.05, 0.12], position: [1, 0.3, 0], angular_velocity: [0, -3, 1]}
  three: {mass: 4, inertia: [0.2, 0.2, 0.3], position: [0.4, 1, 0.5], velocity: [0.3, 0, -0.4]}
cables:
  rope: {through: [[one, [0.2, 0.1, 0]], [two, [-0.1, 0, 0.1]], [three, [0, -0.2, 0]], [one, [0, 0.1, 0.2]]], slides: true, stiffness: 400, free_length: 2.5, tension_only: true}
analysis: {type: dynamics, duration: 1 s, step: h, rho_inf: rho}
output: {hdf5: false}
)";

TEST(RunningCable, KeepsEnergyAndBothMomenta) {
  for (const double h : {0.02, 0.005, 0.0005}) {
    Simulation s = made(kTied, {"h=" + std::to_string(h)});
    const RunSummary r = finished(s);
    EXPECT_LT(r.energy_drift, 2e-12) << h;
    EXPECT_LT(r.linear_momentum_drift, 1e-12) << h;
    EXPECT_LT(r.angular_momentum_drift, 1e-12) << h;
  }
}

TEST(RunningCable, HasTheOrderOfTheMethod) {
  const auto end = [](double h, int order, const char* rho) {
    // Where a cable becomes slack its force has a corner: here the force is compressive.
    Simulation s = made(kTied, {"h=" + std::to_string(h), "analysis.order=" + std::to_string(order),
                                std::string("rho=") + rho, "cables.rope.tension_only=false"});
    (void)finished(s);
    return std::array{s.body(0).r, s.body(1).r, s.body(2).r};
  };
  const auto truth = end(0.002, 6, "1");
  const auto error = [&](double h, int order, const char* rho) {
    const auto e = end(h, order, rho);
    return (e[0] - truth[0]).norm() + (e[1] - truth[1]).norm() + (e[2] - truth[2]).norm();
  };
  EXPECT_NEAR(std::log2(error(0.005, 2, "1") / error(0.0025, 2, "1")), 2.0, 0.15);
  EXPECT_NEAR(std::log2(error(0.005, 2, "0.5") / error(0.0025, 2, "0.5")), 2.0, 0.25);
  EXPECT_GT(std::log2(error(0.02, 4, "1") / error(0.01, 4, "1")), 3.5);
  EXPECT_GT(std::log2(error(0.02, 6, "1") / error(0.01, 6, "1")), 5.5);
}

// Energy of a cable that becomes slack and taut again is conserved.
TEST(RunningCable, MayBeSlack) {
  Simulation s = made(kTied, {"cables.rope.free_length=3.4", "analysis.duration=3"});
  bool slack = false, taut = false;
  const RunSummary r = s.run([&](Simulation& now) {
    (now.cable(0).tension[0] > 0.0 ? taut : slack) = true;
    EXPECT_GE(now.cable(0).tension[0], 0.0);
  });
  EXPECT_EQ(r.end, RunEnd::finished) << r.message;
  EXPECT_TRUE(slack && taut);
  EXPECT_LT(r.energy_drift, 1e-11);
}

// m ẍ + 4 c ẋ + 4 k x = 0 of a mass between two falls: e^{−δt} cos ωt.
TEST(RunningCable, IsViscous) {
  const std::string text = R"(
format: 1
variables: {h: 2 ms}
bodies: {cart: {mass: 2, inertia: [1, 1, 1], position: [1.2, 0, 0]}}
joints: {rail: {type: prismatic, bodies: [ground, cart], at: [1.2, 0, 0], axis: x}}
cables: {rope: {through: [[ground, [0, 0, 0]], [cart], [ground, [0, 0, 0]]], slides: true, tension_only: false, stiffness: 40, free_length: 2, damping: 1.5}}
analysis: {type: dynamics, duration: 1 s, step: h}
output: {hdf5: false}
)";
  const double k = 4.0 * 20.0 / 2.0, d = 0.5 * 4.0 * 1.5 / 2.0, w = std::sqrt(k - d * d);
  const double x = 0.2 * std::exp(-d) * (std::cos(w) + d / w * std::sin(w));
  for (const double h : {0.02, 0.002, 0.0002}) {
    Simulation s = made(text, {"h=" + std::to_string(h)});
    const RunSummary r = finished(s);
    EXPECT_NEAR(s.body(0).r[0] - 1.0, x, 4.0 * h * h + 1e-10) << h;
    EXPECT_LT(r.energy_drift, 1e-12) << h;
    EXPECT_GT(s.balance().dissipated, 0.5);
  }
}

/// A muscle that lifts 8 kg.
std::string lift(const std::string& more = "") {
  return R"(
format: 1
gravity: [0, 0, -9.81]
variables: {h: 2 ms}
bodies: {load: {mass: 8, inertia: [1, 1, 1], position: [0, 0, -0.33]}}
joints: {rail: {type: prismatic, bodies: [ground, load], at: [0, 0, -0.33], axis: z}}
cables:
  biceps: {through: [[ground, [0, 0, 0]], [load]], muscle: {max_force: 300, optimal_length: 0.12, tendon_length: 0.2, pennation: 10 deg, damping: 0.05, activation: "0.2 + 0.5*t"}}
analysis: {type: dynamics, duration: 0.6 s, step: h}
output: {hdf5: false}
)" + more;
}

// Against Runge-Kutta's rule on m z̈ = T − m g with the curves. @tests{muscle-force}
TEST(RunningCable, LiftsAWeightByItsMuscle) {
  const auto tension = [](double length, double rate, double t) {
    const double width = std::sin(10.0 * 3.14159265358979323846 / 180.0);
    const double along = (length - 0.2) / 0.12, fibre = std::hypot(along, width);
    const double cosine = along / fibre, v = cosine * rate / (0.12 * 10.0);
    return 300.0 * cosine *
           ((0.2 + 0.5 * t) * active_force_length(fibre).value * force_velocity(v).value +
            passive_force_length(fibre).value + 0.05 * v);
  };
  // The length is −z.
  const auto rates = [&](double t, const std::array<double, 2>& y) {
    return std::array{y[1], kG - tension(y[0], y[1], t) / 8.0};
  };
  std::array<double, 2> y{0.33, 0.0};
  const int steps = 60000;
  const double dt = 0.6 / steps;
  for (int i = 0; i < steps; ++i) {
    const double t = i * dt;
    const auto k1 = rates(t, y);
    const auto k2 = rates(t + 0.5 * dt, {y[0] + 0.5 * dt * k1[0], y[1] + 0.5 * dt * k1[1]});
    const auto k3 = rates(t + 0.5 * dt, {y[0] + 0.5 * dt * k2[0], y[1] + 0.5 * dt * k2[1]});
    const auto k4 = rates(t + dt, {y[0] + dt * k3[0], y[1] + dt * k3[1]});
    for (std::size_t c = 0; c < 2; ++c)
      y[c] += dt / 6.0 * (k1[c] + 2.0 * k2[c] + 2.0 * k3[c] + k4[c]);
  }
  double last = 0.0;
  for (const double h : {0.02, 0.01, 0.0004}) {
    Simulation s = made(lift(), {"h=" + std::to_string(h)});
    const RunSummary r = finished(s);
    const double off = std::abs(-s.body(0).r[2] - y[0]);
    EXPECT_LT(off, 20.0 * h * h) << h;
    if (last > 0.0 && h > 1e-3) {
      EXPECT_NEAR(last / off, 4.0, 1.0) << h;
    }
    last = off;
    EXPECT_LT(r.energy_drift, 1e-11) << h;
  }
}

TEST(RunningCable, ReportsErrors) {
  const auto has = [](const std::string& rope, const std::string& wanted) {
    expect_fault(weights(rope), wanted);
  };
  has("slides: true",
      "cables.rope: 'stiffness' is missing. Give EA or, for a sliding cable, a tension.");
  has("tension: 3, slides: false", "cables.rope.slides: cannot be combined with 'tension'");
  has("stiffness: 1e3, slides: true, mass_per_length: 1",
      "cables.rope.slides: cannot be combined with mass_per_length");
  has("stiffness: 1e3, slides: true, strain: green",
      "cables.rope.strain: cannot be combined with 'slides'");
  has("muscle: {max_force: 3, optimal_length: 1}", "cables.rope.muscle");
}

}  // namespace
}  // namespace polhode::test::running_cable_motion_tests
