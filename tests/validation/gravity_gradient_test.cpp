// SPDX-License-Identifier: Apache-2.0
// Orbits and librations in a central field against closed forms.
#include <cmath>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include <polhode/core/format.hpp>
#include <support/run_text.hpp>

namespace polhode::gravity_gradient_tests {

using test::finished, test::made;

constexpr double kPi = std::numbers::pi, kMu = 3.986004418e14, kRounding = 1e-11;

// Kepler's orbit with e = 0.3 from the perigee: after half a period it is at the apogee, after the
// whole at the start. @tests{gravity-gradient}
TEST(GravityGradientRuns, FollowKeplersOrbit) {
  const double r = 7e6, e = 0.3, a = r / (1.0 - e), v = std::sqrt(kMu * (1.0 + e) / r);
  const double T = 2.0 * kPi * std::sqrt(a * a * a / kMu);
  for (const int n : {50, 500, 5000}) {
    Simulation s = made(format(R"(
format: 1
bodies: {{probe: {{mass: 200, point_mass: true, position: [{}, 0, 0], velocity: [0, {:.17g}, 0]}}}}
loads: {{earth: {{type: gravity_gradient, bodies: [ground, probe], mu: 3.986004418e14}}}}
analysis: {{duration: {:.17g}, step: {:.17g}, order: 6}}
output: {{hdf5: false}}
)",
                               r, v, T, T / n));
    const RunSummary summary = finished(s);
    EXPECT_LT(summary.energy_drift, kRounding) << n;
    EXPECT_LT(summary.angular_momentum_drift, kRounding) << n;
    const double within = n == 50 ? 0.2 : n == 500 ? 1e-6 : 1e-8;
    EXPECT_LT((s.body(0).r - Vec3(r, 0, 0)).norm() / r, within) << n;
    EXPECT_LT((s.body(0).v - Vec3(0, v, 0)).norm() / v, within) << n;
    EXPECT_NEAR(s.load(0)[7], -kMu * 200.0 / s.body(0).r.norm(), 1.0);
  }
}

// A dumbbell in a circular orbit, upright: it librates in pitch at √(3 (J_x − J_z)/J_y) n, x along
// the orbit, y across it, z upright (P. C. Hughes, Spacecraft Attitude Dynamics, 1986).
// @tests{gravity-gradient-step}
TEST(GravityGradientRuns, LibrateInPitchAtTheKnownFrequency) {
  const double r = 7e6, n = std::sqrt(kMu / (r * r * r)), v = n * r;
  const double Jx = 110.0, Jy = 100.0, Jz = 12.0, nudge = 1e-3;
  const double rate = std::sqrt(3.0 * (Jx - Jz) / Jy) * n;
  for (const double h : {100.0, 10.0, 1.0}) {
    const double T = 5000.0;
    Simulation s = made(format(R"(
format: 1
bodies:
  earth: {{mass: 1, point_mass: true, fixed: true}}
  boom: {{mass: 50, inertia: [{}, {}, {}], position: [0, 0, {}], velocity: [{:.17g}, 0, 0], orientation: {{axis: y, angle: {}}}, angular_velocity: [0, {:.17g}, 0]}}
loads: {{gravity: {{type: gravity_gradient, bodies: [earth, boom], mu: 3.986004418e14}}}}
analysis: {{duration: {}, step: {}}}
output: {{hdf5: false}}
)",
                               Jx, Jy, Jz, r, v, nudge, n, T, h));
    const RunSummary summary = finished(s);
    EXPECT_LT(summary.energy_drift, kRounding) << h;
    EXPECT_LT(summary.angular_momentum_drift, kRounding) << h;
    const Vec3 up = s.body(1).q * Vec3(Vec3::UnitZ()), out = s.body(1).r.normalized();
    const double pitch = std::atan2(out.cross(up).y(), out.dot(up));
    // Second order in the step; cubic in the amplitude.
    EXPECT_NEAR(pitch / nudge, std::cos(rate * T), 20.0 * std::pow(h * n, 2) + 1e-5) << h;
  }
}

// Two bodies of like masses about each other: linear and angular momentum are those of both.
TEST(GravityGradientRuns, ConserveTheMomentaOfTwoBodies) {
  for (const double h : {0.05, 0.005, 0.0005}) {
    Simulation s = made(format(R"(
format: 1
bodies:
  one: {{mass: 3, inertia: [1, 1, 1], position: [0, 0, 0], velocity: [0, -0.4, 0]}}
  two: {{mass: 2, inertia: [0.2, 0.5, 0.6], position: [3, 0, 0], velocity: [0, 0.6, 0.2], angular_velocity: [0.3, 1, -0.4]}}
loads: {{gravity: {{type: gravity_gradient, bodies: [one, two], mu: 5}}}}
analysis: {{duration: 10, step: {}}}
output: {{hdf5: false}}
)",
                               h));
    const RunSummary r = finished(s);
    EXPECT_LT(r.energy_drift, kRounding) << h;
    EXPECT_LT(r.linear_momentum_drift, kRounding) << h;
    EXPECT_LT(r.angular_momentum_drift, kRounding) << h;
  }
}

}  // namespace polhode::gravity_gradient_tests
