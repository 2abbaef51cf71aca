// SPDX-License-Identifier: Apache-2.0
// Contact of cables: over drums and pegs, hit by balls, across beams.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/io/read/read_model.hpp>
#include <polhode/simulation/simulation_details.hpp>
#include <validation/rope_over_drum.hpp>

namespace polhode::test::cable_contact_tests {
namespace {

using std::numbers::pi;

/// A ball flies into a cable that is straight between two blocks in space.
/// @param at  x and y of the ball.
Model hit(double step, double duration, double speed, const std::string& at,
          const std::string& solver = "automatic") {
  return io::read_model_text(R"(
format: 1
bodies:
  left: {shape: {box: [0.1, 0.2, 0.2]}, density: 1000, position: [-0.55, 0, 0]}
  right: {shape: {box: [0.1, 0.2, 0.2]}, density: 1000, position: [0.55, 0, 0]}
  ball: {shape: {sphere: 60 mm}, density: 2000, position: [)" +
                                 at +
                                 format(R"(, 0.04], velocity: [0, 0, {:g}]}}
cables:
  rope: {{through: [[left, [0.05, 0, 0]], [right, [-0.05, 0, 0]]], stiffness: 20 kN, mass_per_length: 0.05,
         elements: 20, contact: {{radius: 4 mm}}}}
contacts: {{default: {{restitution: 1}}}}
analysis: {{duration: {:g}, step: {:g}, solver: {}}}
)",
                                        -speed, duration, step, solver),
                             "hit.yaml");
}

double node_z(const Simulation& s, int node) {
  return s.body(s.model().body_index("rope." + std::to_string(node))).r.z();
}

TEST(CableContact, BallThatHitsATightCableKeepsEnergyAndMomenta) {
  for (const char* at : {"0.0, 0.0", "0.113, 0.001"})
    for (const double step : {2e-4, 5e-5}) {
      Simulation s(hit(step, 0.02, 3.0, at));
      double impulse = 0.0;
      const RunSummary r = s.run();
      ASSERT_EQ(r.end, RunEnd::finished) << r.message;
      for (std::size_t k = 0; k < s.contact_map().pairs.size(); ++k)
        impulse += s.contact(static_cast<int>(k)).impulse;
      EXPECT_GT(impulse, 0.02);
      EXPECT_LT(r.energy_drift, 1e-10) << at << ", " << step;
      EXPECT_LT(r.linear_momentum_drift, 1e-12) << at << ", " << step;
      EXPECT_LT(r.angular_momentum_drift, 1e-12) << at << ", " << step;
      EXPECT_NEAR(r.contacts->lost_in_impacts, 0.0, 1e-15) << "round-off";
      EXPECT_GT(r.contacts->least_gap, -4e-6) << "the tolerance: 1e-3 of the cable's radius";
    }
}

/// At ten and at thirty times the speed the ball moves by many times the cable's thickness in a
/// step.
TEST(CableContact, AFastBallDoesNotPassThroughAThinCable) {
  for (const double speed : {30.0, 100.0}) {
    Simulation s(hit(1e-3, 3e-3, speed, "0, 0"));
    double least = 1.0;
    const RunSummary r = s.run(
        {}, [&](Simulation& now) { least = std::min(least, now.body(2).r.z() - node_z(now, 10)); });
    ASSERT_EQ(r.end, RunEnd::finished) << r.message;
    EXPECT_GT(least, 0.02) << "the ball stays above the middle of the cable";
    EXPECT_LT(s.body(2).v.z(), 0.0) << "and pulls it along";
    EXPECT_LT(r.energy_drift, 1e-9);
  }
}

TEST(CableContact, AllSolversAgree) {
  Simulation by_blocks(hit(2e-4, 0.02, 3.0, "0.113, 0.001"));
  ASSERT_EQ(by_blocks.run().end, RunEnd::finished);
  for (const char* solver : {"klu", "sparse_lu"}) {
    Simulation s(hit(2e-4, 0.02, 3.0, "0.113, 0.001", solver));
    ASSERT_EQ(s.run().end, RunEnd::finished);
    EXPECT_LT((s.body(2).r - by_blocks.body(2).r).norm(), 1e-8) << solver;
  }
  EXPECT_THROW(Simulation(hit(2e-4, 0.02, 3.0, "0, 0", "tree")), InputError);
}

/// Euler and Eytelwein: T_2/T_1 = exp(μφ). @tests{cable-gap}
TEST(CableContact, RopeOverADrumHoldsBelowTheRatioOfEytelwein) {
  const double mu = 0.2, ratio = std::exp(mu * pi);
  for (const int pieces : {8, 16}) {
    const Drum drum(pieces, 0.9 * ratio, mu, 0.2);
    Simulation s(drum.model);
    EXPECT_LT(std::abs(drum.acceleration(s)), 1e-4) << pieces;
    EXPECT_LT(std::abs(s.body(drum.heavy).v.z()), 1e-5) << pieces;
    // Friction carries the difference of the weights, the normal force the rest.
    const ContactReport c = s.contact(0);
    const double weight = (1.0 + 0.9 * ratio + drum.rope_mass) * Drum::g;
    EXPECT_NEAR(c.force.z() / weight, 1.0, 1e-3) << pieces;
  }
}

/// Above it the weights fall by a = g (m_2 − q m_1)/(m_2 + q m_1), q = exp(μφ), and the error
/// decreases with the square of the angle of a piece.
TEST(CableContact, RopeOverADrumSlipsAboveTheRatioOfEytelwein) {
  const double mu = 0.2, ratio = std::exp(mu * pi), heavy = 1.25 * ratio;
  const double a = Drum::g * (heavy - ratio) / (heavy + ratio);
  double coarse = 0.0;
  for (const int pieces : {8, 16, 32}) {
    const Drum drum(pieces, heavy, mu, 0.3);
    Simulation s(drum.model);
    const double error = std::abs(drum.acceleration(s) / a - 1.0);
    EXPECT_LT(error, 5.0 / (pieces * pieces)) << pieces;
    if (coarse > 0.0) {
      EXPECT_LT(error, 0.4 * coarse) << pieces;
    }
    EXPECT_EQ(s.contact(0).status, 2);
    EXPECT_GT(s.contact(0).energy_lost, 0.1);
    coarse = error;
  }
}

/// Without friction the drum is a pulley: Atwood's machine, with the mass of the rope.
TEST(CableContact, SmoothDrumActsAsAPulley) {
  const double heavy = 1.5;
  const Drum drum(8, heavy, 0.0, 0.3);
  Simulation s(drum.model);
  const double moved = 1.0 + heavy + drum.rope_mass;
  const double measured = drum.acceleration(s);
  // The rope hangs farther down on one side as it runs: its mean from 0.1 s to 0.3 s.
  const double a = Drum::g * (heavy - 1.0) / moved;
  const double run = 0.5 * a * (0.3 * 0.3 * 0.3 - 0.1 * 0.1 * 0.1) / (3.0 * 0.2);
  EXPECT_NEAR(measured / (a + 2.0 * Drum::kPerLength * run * Drum::g / moved), 1.0, 2e-3);
  const double tension = 2.0 * heavy * Drum::g / (1.0 + heavy);
  const CableReport rope = s.cable(0);
  // With those of the dampers, in pieces that still vibrate.
  EXPECT_NEAR(rope.tension.front() / rope.tension.back(), 1.0, 2e-2);
  EXPECT_NEAR(rope.tension.front() / tension, 1.0, 1e-2);
}

/// A rope that sags onto a thin peg, at rest: each half is a parabola between two supports, whose
/// tension follows from the length; the peg carries the part of the weight that the ends do not.
TEST(CableContact, RopeOnAPegCarriesItsWeightByTheParabola) {
  const double l = 0.5, EA = 1e4, free = 0.495, w = 1.5 * 9.81;
  Simulation s(io::read_model_text(R"(
format: 1
gravity: [0, 0, -9.81]
bodies:
  peg: {fixed: true, shape: {cylinder: [10 mm, 0.2]}, orientation: {axis: x, angle: 90 deg}, position: [0, 0, -15 mm]}
cables:
  rope: {through: [[ground, [-0.5, 0, 0]], [ground, [0.5, 0, 0]]], stiffness: 10 kN, free_length: 0.99,
         mass_per_length: )" + format("{:.17g}", 1.5 / free * l) +
                                       R"(, contact: {radius: 5 mm}, elements: 40}
contacts: {}
analysis: {type: statics}
)",
                                   "peg.yaml"));
  const RunSummary result = s.run();
  ASSERT_EQ(result.end, RunEnd::finished) << result.message;
  const double d = 5e-3;  // from the ends down to the top of the peg
  EXPECT_NEAR(s.body(s.model().body_index("rope.20")).r.z(), -d, 2e-5);
  double H = EA * (l / free - 1.0);
  for (int k = 0; k < 50; ++k) {
    const double length = l + d * d / (2.0 * l) + w * w * l * l * l / (24.0 * H * H);
    H = EA * (length / free - 1.0);
  }
  const ContactReport c = s.contact(0);
  EXPECT_NEAR(c.normal_force / (w * l - 2.0 * H * d / l), 1.0, 1e-2);
  EXPECT_NEAR(c.force.z() / c.normal_force, 1.0, 1e-3);
  EXPECT_LT(std::abs(c.force.x()), 1e-6 * c.force.z());
  EXPECT_NEAR(s.cable(0).tension[20] / H, 1.0, 1e-2);
}

/// A rope with weights at its ends falls across a beam, and they swing.
TEST(CableContact, RopeSwingsOverABeam) {
  Simulation s(io::read_model_text(R"(
format: 1
gravity: [0, 0, -9.81]
materials:
  rubber: {type: elastic, youngs_modulus: 1 GPa, poisson_ratio: 0.4, density: 1000, viscosity: {relaxation_time: 5 ms}}
sections: {bar: {type: circle, diameter: 20 mm, material: rubber}}
bodies:
  left: {mass: 0.1, inertia: [1e-4, 1e-4, 1e-4], position: [-0.2, 0, 16 mm]}
  right: {mass: 0.1, inertia: [1e-4, 1e-4, 1e-4], position: [0.2, 0, 16 mm]}
beams:
  bar: {points: [[0, -0.2, 0], [0, 0.2, 0]], elements: 8, section: bar, contact: {}, bonded: {ground: [start, end]}}
cables:
  rope: {through: [[left], [right]], stiffness: 5 kN, mass_per_length: 0.05, damping: 2, elements: 40, contact: {radius: 5 mm}}
contacts: {default: {friction: 0.4}}
analysis: {duration: 0.25 s, step: 0.5 ms}
)",
                                   "over.yaml"));
  const RunSummary r = s.run();
  ASSERT_EQ(r.end, RunEnd::finished) << r.message;
  EXPECT_LT(s.body(0).r.z(), -0.1);
  EXPECT_LT(s.body(1).r.z(), -0.1);
  EXPECT_NEAR(node_z(s, 20), 0.015, 1e-3) << "on the beam";
  EXPECT_LT(r.energy_drift, 1e-9);
}

}  // namespace
}  // namespace polhode::test::cable_contact_tests
