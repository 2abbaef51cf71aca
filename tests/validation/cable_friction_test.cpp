// SPDX-License-Identifier: Apache-2.0
// Friction of cables on the points that they pass: the law of Euler and Eytelwein.
#include <cmath>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include <polhode/core/format.hpp>
#include <polhode/system/state_archive.hpp>
#include <support/run_text.hpp>

namespace polhode::test::cable_friction_tests {
namespace {

constexpr double kG = 9.81;

/// Two weights on the ends of a rope that bends by a right angle at each of two points.
std::string weights(double heavy, const std::string& rope, double duration = 0.5) {
  return format(R"(
format: 1
gravity: [0, 0, -9.81]
variables: {{h: 2 ms, rho: 1}}
bodies:
  heavy: {{mass: {:.17g}, inertia: [1, 1, 1], position: [0, 0, -2]}}
  light: {{mass: 2, inertia: [1, 1, 1], position: [1, 0, -2]}}
joints:
  left: {{type: prismatic, bodies: [ground, heavy], at: [0, 0, -2], axis: z}}
  right: {{type: prismatic, bodies: [ground, light], at: [1, 0, -2], axis: z}}
cables:
  rope: {{through: [[heavy], [ground, [0, 0, 0]], [ground, [1, 0, 0]], [light]], slides: true, stiffness: 4e4, damping: 200, {}}}
analysis: {{type: dynamics, duration: {}, step: h, rho_inf: rho}}
output: {{hdf5: false}}
)",
                heavy, rope, duration);
}

}  // namespace

// Tensions of a sliding rope: in the ratio e^{μβ}, apart from its vibrations, and the weights fall
// as M(g − a) = R m (g + a). The rope is extended by millimetres, of a displacement of 0.5 m.
// @tests{cable-capstan}
TEST(CableFriction, SlidesAtTheCapstanRatio) {
  const double mu = 0.2, R = std::exp(mu * std::numbers::pi), M = 8.0, m = 2.0;
  const double a = kG * (M - R * m) / (M + R * m);
  for (const double h : {0.02, 0.002, 0.0002}) {
    Simulation s = made(weights(M, "friction: 0.2"), {"h=" + std::to_string(h)});
    const RunSummary r = finished(s);
    const CableReport rope = s.cable(0);
    const double trembles = h > 0.01 ? 1e-6 : 1e-10;
    EXPECT_NEAR(rope.tension[0] / rope.tension[1], std::exp(0.5 * mu * std::numbers::pi), trembles);
    EXPECT_NEAR(rope.tension[0] / rope.tension[2], R, trembles) << h;
    EXPECT_NEAR(s.body(0).r[2], -2.0 - 0.125 * a, 0.01) << h;
    EXPECT_NEAR(s.body(1).v[2], 0.5 * a, 0.02 * a) << h;
    EXPECT_LT(r.energy_drift, 1e-10) << h;
    // Energy dissipated by friction: approximately the difference of tensions times the
    // displacement.
    const double way = 2.0 + s.body(1).r[2], T = m * (kG + a);
    EXPECT_NEAR(s.balance().dissipated, (R - 1.0) * T * way, 0.05 * (R - 1.0) * T * way) << h;
  }
}

// An additional turn about the first point.
TEST(CableFriction, CountsWholeTurns) {
  Simulation s = made(weights(30.0, "friction: 0.2, wraps: [1, 0]", 0.6));
  (void)finished(s);
  const CableReport rope = s.cable(0);
  EXPECT_NEAR(rope.tension[0] / rope.tension[1], std::exp(0.2 * 2.5 * std::numbers::pi), 1e-8);
  EXPECT_NEAR(rope.tension[1] / rope.tension[2], std::exp(0.1 * std::numbers::pi), 1e-8);
}

// Below the limiting ratio the weights hang on their own pieces of the rope and do not creep.
TEST(CableFriction, HoldsWithoutCreep) {
  for (const double h : {0.02, 0.002}) {
    Simulation s = made(weights(3.5, "friction: 0.2", 8.0), {"h=" + std::to_string(h)});
    const RunSummary r = finished(s);
    const double z = s.body(0).r[2];
    EXPECT_NEAR(s.cable(0).tension[0], 3.5 * kG, 1e-6) << h;
    EXPECT_NEAR(s.cable(0).tension[2], 2.0 * kG, 1e-6) << h;
    EXPECT_GT(z, -2.0 - 5.0 * 3.5 * kG / 4e4) << h;  // the whole extension of the rope
    EXPECT_LT(r.energy_drift, 1e-10) << h;
    Simulation longer = made(weights(3.5, "friction: 0.2", 16.0), {"h=" + std::to_string(h)});
    (void)finished(longer);
    EXPECT_NEAR(longer.body(0).r[2], z, 1e-10) << h;
  }
}

// A pendulum on a rope over a corner moves the weight at the other end up and down: alternating
// stick and slip, convergence with the step, and energy balance.
TEST(CableFriction, ConvergesWhileItSticksAndSlips) {
  const auto end = [](double h, const char* rho) {
    Simulation s = made(R"(
format: 1
gravity: [0, 0, -9.81]
variables: {h: 2 ms, rho: 1}
bodies:
  ball: {mass: 1, inertia: [0.01, 0.01, 0.01], position: [0.8, 0, -0.6]}
  weight: {mass: 1.2, inertia: [1, 1, 1], position: [-1, 0, -1]}
joints: {rail: {type: prismatic, bodies: [ground, weight], at: [-1, 0, -1], axis: z}}
cables: {rope: {through: [[ball], [ground, [0, 0, 0]], [ground, [-1, 0, 0]], [weight]], slides: true, stiffness: 2000, friction: 0.15, damping: 5}}
analysis: {type: dynamics, duration: 1.5 s, step: h, rho_inf: rho}
output: {hdf5: false}
)",
                        {"h=" + std::to_string(h), std::string("rho=") + rho});
    const RunSummary r = finished(s);
    EXPECT_LT(r.energy_drift, std::string(rho) == "1" ? 1e-10 : 1e-2) << h;
    return s.body(0).r;
  };
  for (const char* rho : {"1", "0.8"}) {
    const Vec3 truth = end(0.000125, rho);
    const double coarse = (end(0.002, rho) - truth).norm(),
                 fine = (end(0.0005, rho) - truth).norm();
    EXPECT_LT(coarse, 2e-3) << rho;
    EXPECT_LT(fine, 0.4 * coarse) << rho;
  }
}

TEST(CableFriction, ContinuesAfterARestartBitForBit) {
  const std::string text = weights(8.0, "friction: 0.2", 0.4);
  Simulation straight = made(text);
  (void)finished(straight);
  Simulation first = made(text);
  while (first.time() < 0.2) ASSERT_TRUE(first.step(1.0).accepted);
  const std::string bytes = state_bytes(first.system(), first.state());
  Simulation second(Model(first.model()), state_from_bytes(first.system(), bytes, "here"));
  (void)finished(second);
  EXPECT_EQ(second.state_hash(), straight.state_hash());
}

TEST(CableFriction, ReportsErrors) {
  expect_fault(weights(3.0, "friction: 0.2, tension: 3"),
               "cables.rope.friction: cannot be combined with tension.");
  expect_fault(weights(3.0, "friction: 0.2, wraps: [1]"),
               "cables.rope.wraps: has 1 numbers for 2 points between the ends.");
  expect_fault(weights(3.0, "wraps: [1, 0]"), "cables.rope.wraps: requires 'friction'.");
}

}  // namespace polhode::test::cable_friction_tests
