// SPDX-License-Identifier: Apache-2.0
// Conservation of energy and momenta of beams with bodies and joints over 1e4 steps
// (docs/validation.md).
#include <gtest/gtest.h>

#include <polhode/simulation/simulation_details.hpp>
#include <support/beam_models.hpp>

namespace polhode::test::beam_conservation_tests {
namespace {

struct Scene {
  bool floating = true;
  double relaxation_time = 0.0;
};

/// A beam between two bodies, a third on the second by a ball joint, a fourth on the first by a
/// hinge: all turn about their common centre. Not floating: the first also on a hinge to the
/// ground, under gravity.
Model two_bodies_and_a_beam(const Scene& scene) {
  const Vec3 omega(0.7, -1.1, 2.95);
  ModelBuilder m;
  const Vec3 inertia(0.3, 0.4, 0.55);
  const int hub = m.body("hub", {0, 0, 0}, 2.0, inertia);
  const int tip = m.body("tip", {7, 0, 0}, 2.0, inertia);
  const int link = m.body("link", {8, 0, 0}, 1.0, inertia);
  const int flap = m.body("flap", {0, 1, 0}, 1.0, inertia);
  BeamSpec beam = beam_through({{0.5, 0, 0}, {6.5, 0, 0}}, 8,
                               {1e4, 4e3, 160.0, 200.0, 0.125, {5e-3, 2.5e-3, 2.5e-3}});
  beam.section.relaxation_time = scene.relaxation_time;
  beam.bonds = {{hub, false}, {tip, true}};
  // No total momentum, since a growing distance would only add round-off.
  const Vec3 moment = 2.0 * Vec3(7, 0, 0) + Vec3(8, 0, 0) + Vec3(0, 1, 0) + 0.75 * Vec3(3.5, 0, 0);
  const Vec3 pivot = scene.floating ? Vec3(moment / 6.75) : Vec3(0, -0.4, 0);
  const Vec3 rate = scene.floating ? omega : Vec3(0, 0, 1.5);
  for (const int b : {hub, tip, link, flap}) m.turning(b, rate, pivot);
  beam.angular_velocity = rate;
  beam.velocity = rate.cross(beam.points[0] - pivot);
  add_beam(m.model, beam);
  m.joint("elbow", "spherical", tip, link, {7.5, 0, 0});
  m.joint("hinge", "revolute", hub, flap, {0, 0.5, 0}, Vec3::UnitX());
  if (!scene.floating) {
    m.joint("pin", "revolute", kGround, hub, pivot, Vec3::UnitZ());
    m.model.gravity = {0.03, -0.9, -0.2};
  }
  return m.model;
}

Simulation simulate(const Scene& scene, double step, double duration) {
  Model model = two_bodies_and_a_beam(scene);
  model.analysis.step = step;
  model.analysis.duration = duration;
  model.output.every = duration;
  return Simulation(std::move(model));
}

double energy(const Simulation& s) { return s.balance().kinetic + s.balance().potential; }

}  // namespace

TEST(BeamConservation, FloatingBodiesOnABeamKeepEnergyAndMomenta) {
  Simulation s = simulate({}, 0.02, 200.0);
  const RunSummary r = s.run();
  ASSERT_EQ(r.end, RunEnd::finished) << r.message;
  EXPECT_EQ(r.steps, 10'000);
  EXPECT_EQ(r.rejected_steps, 0);
  RecordProperty("energy_drift", std::to_string(r.energy_drift * 1e15) + "e-15");
  RecordProperty("angular_drift", std::to_string(r.angular_momentum_drift * 1e15) + "e-15");
  EXPECT_LE(r.energy_drift, 1e-11);
  EXPECT_LE(r.linear_momentum_drift, 1e-11);
  EXPECT_LE(r.angular_momentum_drift, 1e-11);
  EXPECT_LE(r.constraint_residual_max, 1e-12);
}

TEST(BeamConservation, SwingingUnderGravityKeepsEnergy) {
  Simulation s = simulate({.floating = false}, 0.01, 100.0);
  const RunSummary r = s.run();
  ASSERT_EQ(r.end, RunEnd::finished) << r.message;
  EXPECT_EQ(r.steps, 10'000);
  RecordProperty("energy_drift", std::to_string(r.energy_drift * 1e15) + "e-15");
  EXPECT_LE(r.energy_drift, 1e-11);
  EXPECT_LE(r.angular_momentum_drift, 1e-11);
}

TEST(BeamConservation, ViscosityDissipatesTheEnergyInTheLedger) {
  Simulation s = simulate({.relaxation_time = 2e-3}, 0.02, 200.0);
  const double start = energy(s);
  double before = start;
  while (s.time() < 200.0 - 1e-9) {
    const StepReport report = s.step(200.0);
    ASSERT_TRUE(report.accepted) << report.message;
    const double now = energy(s);
    ASSERT_LE(now, before + 1e-13 * start) << s.time();
    before = now;
  }
  const RunSummary r = s.summary();
  EXPECT_EQ(r.steps, 10'000);
  RecordProperty("energy_drift", std::to_string(r.energy_drift * 1e15) + "e-15");
  EXPECT_LT(before, (1.0 - 1e-3) * start);
  EXPECT_LE(r.energy_drift, 1e-11);  // of energy and what was dissipated together
  EXPECT_LE(r.angular_momentum_drift, 1e-11);
}

}  // namespace polhode::test::beam_conservation_tests
