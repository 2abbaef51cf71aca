// SPDX-License-Identifier: Apache-2.0
// Contact of beams: on two pegs, and with each other in free flight.
#include <cmath>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include <polhode/io/read/read_model.hpp>
#include <polhode/simulation/simulation_details.hpp>

namespace polhode::beam_contact_tests {
namespace {

// A viscous bar falls from a small height on two pegs, 1 m apart and 0.1 m from its ends, and comes
// to rest.
constexpr const char* kOnPegs = R"(
format: 1
gravity: [0, 0, -9.81]
materials:
  plastic: {type: elastic, youngs_modulus: 2 GPa, poisson_ratio: 0.3, density: 1000,
            viscosity: {relaxation_time: 20 ms}}
sections:
  bar: {type: circle, diameter: 20 mm, material: plastic}
bodies:
  left: {fixed: true, shape: {cylinder: [20 mm, 0.2]}, orientation: {axis: x, angle: 90 deg},
         position: [-0.5, 0, -20.02 mm]}
  right: {fixed: true, shape: {cylinder: [20 mm, 0.2]}, orientation: {axis: x, angle: 90 deg},
          position: [0.5, 0, -20.02 mm]}
beams:
  bar: {points: [[-0.6, 0, 0], [0.6, 0, 0]], elements: 24, section: bar, contact: {}}
contacts: {default: {friction: 0}}
analysis: {duration: 3 s, step: 2 ms}
)";

// Two rods of rubber, one of which spins, cross at 1 m/s.
constexpr const char* kCrossing = R"(
format: 1
gravity: [0, 0, 0]
materials:
  rubber: {type: elastic, youngs_modulus: 50 MPa, poisson_ratio: 0.4, density: 1000}
sections:
  bar: {type: circle, diameter: 20 mm, material: rubber}
beams:
  upper: {points: [[-0.3, 0, 0.05], [0.3, 0, 0.05]], elements: 10, section: bar, contact: {},
          velocity: [0, 0, -1], angular_velocity: [0, 0, 2]}
  lower: {points: [[0.07, -0.3, 0], [0.07, 0.3, 0]], elements: 10, section: bar, contact: {}}
contacts: {default: {friction: 0, restitution: 1}}
analysis: {duration: 0.1 s, step: 0.1 ms}
)";

TEST(BeamContact, BarOnTwoPegsDeflectsByTheClosedForm) {
  Simulation s(io::read_model_text(kOnPegs, "pegs.yaml"));
  const RunSummary r = s.run();
  ASSERT_EQ(r.end, RunEnd::finished) << r.message;
  // Span L with overhangs c under its weight w, and the shear of the span.
  const double L = 1.0, c = 0.1, radius = 0.01, E = 2e9, nu = 0.3;
  const double A = std::numbers::pi * radius * radius, I = 0.25 * A * radius * radius;
  const double w = 1000.0 * A * 9.81, shear_area = 6.0 * (1.0 + nu) / (7.0 + 6.0 * nu) * A;
  const double bending = w * L * L * (5.0 * L * L - 24.0 * c * c) / (384.0 * E * I);
  const double shear = w * L * L / (8.0 * shear_area * E / (2.0 * (1.0 + nu)));
  const std::vector<Vec3> x = s.beam(0).position;
  EXPECT_NEAR(x[2].x(), -0.5, 1e-4);  // the node above the left peg
  EXPECT_NEAR(x[2].z() - x[12].z(), bending + shear, 5e-3 * bending);
  EXPECT_NEAR(x[0].z(), x[24].z(), 1e-6 * L);
  EXPECT_LT(s.body(2 + 12).v.norm(), 1e-5);
}

TEST(BeamContact, CrossingRodsKeepEnergyAndMomenta) {
  Simulation s(io::read_model_text(kCrossing, "crossing.yaml"));
  const RunSummary r = s.run();
  ASSERT_EQ(r.end, RunEnd::finished) << r.message;
  EXPECT_LT(r.energy_drift, 1e-10);
  EXPECT_LT(r.linear_momentum_drift, 1e-12);
  EXPECT_LT(r.angular_momentum_drift, 1e-12);
  // After contact: the lower one moves, and neither has passed through the other.
  const std::vector<Vec3> upper = s.beam(0).position, lower = s.beam(1).position;
  EXPECT_LT(s.body(11 + 5).v.z(), -0.1);
  EXPECT_GT(upper[6].z() - lower[5].z(), 0.0);
}

/// The same with a smaller restitution and a partly consistent mass: an impulse on one node moves
/// its neighbours, too.
// @tests{turn-law}
TEST(BeamContact, RodsOfConsistentMassReboundWithoutGainingEnergyOrMomentum) {
  std::string text = kCrossing;
  const auto set = [&](const std::string& from, const std::string& to) {
    for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
      text.replace(at, from.size(), to);
  };
  set("contact: {}", "consistent_mass: 0.5, contact: {}");
  set("restitution: 1", "restitution: 0.4");
  set("duration: 0.1 s, step: 0.1 ms", "duration: 60 ms, step: 0.2 ms");
  Simulation s(io::read_model_text(text, "crossing.yaml"));
  const Balance start = s.balance();
  double energy = start.kinetic + start.potential;
  const RunSummary r = s.run({}, [&](Simulation& now) {
    const Balance b = now.balance();
    EXPECT_LT(b.kinetic + b.potential, energy + 1e-12 * start.kinetic);
    energy = b.kinetic + b.potential;
  });
  ASSERT_EQ(r.end, RunEnd::finished) << r.message;
  const Balance end = s.balance();
  EXPECT_LT(energy, 0.995 * start.kinetic) << "no loss: there was no impact";
  EXPECT_LT((end.linear_momentum - start.linear_momentum).norm(), 1e-12 * s.state().ledger.p_scale);
  EXPECT_LT((end.angular_momentum - start.angular_momentum).norm(),
            1e-12 * s.state().ledger.l_scale);
  EXPECT_LT(r.energy_drift, 1e-10);
  EXPECT_GT(r.contacts->lost_in_impacts, 0.0);
}

}  // namespace
}  // namespace polhode::beam_contact_tests
