// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include <polhode/core/format.hpp>

#include "support/paths.hpp"
#include "support/run_text.hpp"

namespace polhode::contact_spin_tests {
namespace {

using namespace test;

Simulation example(const std::string& name, const io::Overrides& overrides = {}) {
  return Simulation(io::read_model(source_dir() + "/examples/" + name + "/model.yaml", overrides));
}

double energy_of(const Simulation& run) { return run.balance().kinetic + run.balance().potential; }

/// A ball whose centre of mass lies below its middle, spinning fast: it turns over. The component
/// of the angular momentum along the arm to the point of contact (Jellett) is conserved.
TEST(ContactSpin, TippeTopTurnsOver) {
  const double m = 6e-3, R = 1.5e-2, a = 0.3 * R, J = 131.0 / 350.0 * m * R * R;
  Simulation run = example("tippe_top");
  const auto jellett = [&] {
    const BodyMotion now = run.body("top");
    const Vec3 L = now.q * (Vec3(J, J, 0.4 * m * R * R).cwiseProduct(now.W));
    return -L.dot(now.q * Vec3(0.0, 0.0, a) - Vec3(0.0, 0.0, R));
  };
  const double first = jellett();
  double drift = 0.0, energy = energy_of(run), rise = 0.0;
  while (run.time() < 2.5 - 1e-9) {
    run.step(2.5);
    drift = std::max(drift, std::abs(jellett() / first - 1.0));
    rise = std::max(rise, energy_of(run) - energy);
    energy = energy_of(run);
  }
  const double tilt = std::acos((run.body("top").q * Vec3::UnitZ()).z()) * 180.0 / std::numbers::pi;
  EXPECT_GT(tilt, 90.0);
  EXPECT_LT(drift, 0.01);
  EXPECT_LT(rise, 1e-12 * run.state().ledger.energy_scale);
  EXPECT_LT(run.summary().newton_iterations, 5 * run.summary().steps);
}

/// An ellipsoid whose principal axes of inertia are rotated relative to its shape: in one direction
/// it continues to spin, in the other one it rattles and reverses.
TEST(ContactSpin, RattlebackReversesOneWayOnly) {
  for (const double sign : {-1.0, 1.0}) {
    Simulation run = example("rattleback", {format("spin={:g}", 5.0 * sign)});
    double least = 5.0, largest = -5.0;
    while (run.time() < 10.0 - 1e-9) {
      run.step(10.0);
      const double spin = run.body("stone").omega().z();
      least = std::min(least, spin);
      largest = std::max(largest, spin);
    }
    if (sign < 0.0) {
      EXPECT_GT(largest, 1.0) << "did not reverse";
    } else {
      EXPECT_GT(least, 4.0) << "lost its spin in the direction in which it should continue";
    }
  }
}

/// A rod pushed along a rough floor under an angle at which no finite friction force solves the
/// rigid equations: the step is accepted, the tip stops, and no energy is gained.
TEST(ContactSpin, PainleveRodIsArrested) {
  for (const double v : {-1.0, 1.0})
    for (const double dt : {2e-3, 5e-4}) {
      const double half = 1.0, angle = 1.0;
      Simulation run = made(format(
          "format: 1\ngravity: [0, 0, -9.81]\nbodies:\n  floor: {{fixed: true, shape: {{plane: "
          "z}}}}\n  rod: {{mass: 1, inertia: [1e-3, {0:.17g}, {0:.17g}], "
          "shape: {{capsule: [1e-4, {1:.17g}], orientation: {{axis: y, angle: 90 deg}}}}, "
          "position: [0, 0, {2:.17g}], orientation: {{axis: y, angle: {3:.17g}}}, "
          "velocity: [{4:g}, 0, 0]}}\n"
          "contacts: {{default: {{friction: 2, gap_tolerance: 0.5 mm, stiffness: 1e6 N/m, "
          "friction_stiffness: 1e6 N/m, friction_damping: 500 N s/m}}}}\n"
          "analysis: {{type: dynamics, duration: 0.15 s, step: {5:.17g} s}}\n",
          1.0 / 3.0, 2.0 * half + 1e-4, half * std::sin(angle) + 4.9e-4, -angle, v, dt));
      const double energy = energy_of(run);
      double slowest = 10.0;
      while (run.time() < 0.15 - 1e-9) {
        run.step(0.15);
        const BodyMotion m = run.body("rod");
        const Vec3 tip = m.v + m.omega().cross(m.q * Vec3(-half, 0.0, 0.0));
        slowest = std::min(slowest, std::abs(tip.x()));
        ASSERT_LE(energy_of(run), energy * (1.0 + 1e-12));
      }
      EXPECT_LT(slowest, 0.05) << v << " " << dt;
    }
}

}  // namespace
}  // namespace polhode::contact_spin_tests
