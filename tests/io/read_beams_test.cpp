// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <polhode/io/read_model.hpp>
#include <polhode/model/simulation.hpp>

namespace polhode {
namespace {

constexpr const char* kModel = R"(
format: 1
units: {length: mm}
bodies:
  plate: {mass: 2, inertia: [1e4, 1e4, 1e4], position: [0, 0, 100]}
materials:
  steel: {type: elastic, youngs_modulus: 200 GPa, poisson_ratio: 0.25, density: 7800 kg/m^3, viscosity: {relaxation_time: 2 ms}}
sections:
  bar: {type: rectangle, height: 20, width: 10, material: steel, torsion_factor: 0.5, shear_factor_y: 0.7}
beams:
  mast: {points: [[0, 0, 110], [0, 0, 1110]], elements: 4, section: bar, up: x, bonded: {plate: start}}
cables:
  stay: {through: [[plate, [100, 0, 0]], [mast, end]], stiffness: 10 kN, free_length: 1 m}
joints:
  ball: {type: spherical, bodies: [ground, mast.end], at: [0, 0, 1110]}
loads:
  push: {type: force, body: mast.2, force: [0, 5, 0]}
analysis: {duration: 2 ms, step: 1 ms}
output:
  probes:
    tip: {body: mast.end}
    foot: {joint: mast.start}
)";

}  // namespace

TEST(ReadBeams, MakesBodiesSectionsAndJoints) {
  const Model m = read_model_text(kModel, "mast.yaml");
  ASSERT_EQ(m.bodies.size(), 6u);
  EXPECT_EQ(m.bodies[1].name, "mast.0");
  EXPECT_LT((m.bodies[5].position - Vec3(0, 0, 1.11)).norm(), 1e-15);
  ASSERT_EQ(m.beams.size(), 1u);
  const BeamSection& s = m.beams[0].section.section;
  EXPECT_NEAR(s.stiffness(0, 0), 2e11 * 2e-4, 1e-3);
  EXPECT_NEAR(s.stiffness(1, 1), 0.7 * 8e10 * 2e-4, 1e-3);
  EXPECT_NEAR(s.stiffness(3, 3), 0.5 * 8e10 * 0.2287 * 2.0 * 1e-8, 1.0);
  EXPECT_NEAR(s.stiffness(5, 5), 2e11 * 0.01 * 8e-6 / 12.0, 1e-6);
  EXPECT_NEAR(s.mass_per_length, 7800.0 * 2e-4, 1e-12);
  EXPECT_NEAR(m.beams[0].section.relaxation_time, 2e-3, 1e-18);
  // y of the section along up, x along the beam.
  EXPECT_LT((m.bodies[1].orientation * Vec3::UnitY() - Vec3::UnitX()).norm(), 1e-12);
  ASSERT_EQ(m.joints.size(), 2u);
  EXPECT_EQ(m.joints[0].name, "mast.start");
  EXPECT_EQ(m.joints[1].b, 5);
  EXPECT_EQ(m.loads[0].b, 3);
  EXPECT_EQ(m.output.probes[0].target, "mast.4");
  ASSERT_EQ(m.cables.size(), 1u);
  EXPECT_LT((m.cables[0].pieces[0].a.Z - Vec3(0.1, 0, 0)).norm(), 1e-15);
  EXPECT_EQ(m.cables[0].pieces[0].b.body, 5);
  EXPECT_DOUBLE_EQ(m.cables[0].pieces[0].free_length, 1.0);
}

TEST(ReadBeams, RunsWhatItRead) {
  Simulation s(read_model_text(kModel, "mast.yaml"));
  const RunSummary r = s.run();
  EXPECT_EQ(r.end, RunEnd::finished) << r.message;
  EXPECT_LT(r.energy_drift, 1e-10);
  EXPECT_EQ(s.beam(0).size(), 4u);
  EXPECT_GT(s.cable(0)[0], 0.0);
}

TEST(ReadBeams, TellsHigherOrdersOfViscosity) {
  std::string text = kModel;
  text.replace(text.find("step: 1 ms}"), 11, "step: 1 ms, order: 4}");
  EXPECT_THROW((void)Simulation(read_model_text(text, "mast.yaml")), std::exception);
}

}  // namespace polhode
