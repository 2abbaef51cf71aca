// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <polhode/io/read/read_model.hpp>
#include <polhode/simulation/simulation_details.hpp>
#include <support/paths.hpp>

namespace polhode::read_beams_tests {
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
  const Model m = io::read_model_text(kModel, "mast.yaml");
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

TEST(ReadBeams, MakesModelsThatRun) {
  Simulation s(io::read_model_text(kModel, "mast.yaml"));
  const RunSummary r = s.run();
  EXPECT_EQ(r.end, RunEnd::finished) << r.message;
  EXPECT_LT(r.energy_drift, 1e-10);
  EXPECT_EQ(s.beam(0).forces.size(), 4u);
  EXPECT_GT(s.cable(0).tension[0], 0.0);
}

// Rigid bodies, a solid with viscosity, a beam and a cable in one model.
TEST(ReadBeams, CanBeCombinedWithSolidsAndBodies) {
  const std::string path = test::source_dir() + "/tests/corpus/good/plate_and_mast.yaml";
  Model model = io::read_model(path, {"analysis.duration=30 ms"});
  model.output.every = 30e-3;
  Simulation s(std::move(model));
  const RunSummary r = s.run();
  ASSERT_EQ(r.end, RunEnd::finished) << r.message;
  EXPECT_EQ(r.steps, 30);
  EXPECT_LT(r.energy_drift, 1e-10);
  EXPECT_LT(r.linear_momentum_drift, 1e-11);  // all fall freely
  EXPECT_EQ(s.beam(0).forces.size(), 10u);
  EXPECT_EQ(s.solids().size(), 1u);
}

// A solid whose face is bonded to the end of a beam and held by nothing else: the load on the
// beam's end is the solid's weight.
TEST(ReadBeams, BondsSolidsToBeams) {
  constexpr const char* kText = R"(
format: 1
gravity: [0, 0, -10]
materials:
  steel: {type: elastic, youngs_modulus: 1 GPa, poisson_ratio: 0.3, density: 1000, viscosity: {relaxation_time: 20 ms}}
sections:
  rod: {type: circle, diameter: 40 mm, material: steel}
beams:
  rod: {points: [[0, 0, 1], [0, 0, 0.5]], elements: 3, section: rod, bonded: {ground: start}}
solids:
  block:
    mesh: {block: {size: [0.1, 0.1, 0.2], cells: [1, 1, 2]}, position: [0, 0, 0.4]}
    element: hex8
    material: steel
    bonded: {rod.end: {plane: {axis: z, at: max}}}
analysis: {duration: 0.4, step: 4 ms, rho_inf: 0.5}
output: {every: 0.4, probes: {face: {solid: block, interface: rod.end}}}
)";
  const Model model = io::read_model_text(kText, "hanging.yaml");
  EXPECT_EQ(model.output.probes[0].reaction_of, "rod.3");
  Simulation s(model);
  const RunSummary r = s.run();
  ASSERT_EQ(r.end, RunEnd::finished) << r.message;
  const double block = 1000.0 * 0.1 * 0.1 * 0.2 * 10.0;
  const double element = 1000.0 * std::numbers::pi * 0.02 * 0.02 * 0.5 / 3.0 * 10.0;
  // The lowest element carries the block and half of itself.
  EXPECT_NEAR(s.beam(0).forces[2][0], block + 0.5 * element, 1e-3 * block);
}

TEST(ReadBeams, StartsBeamsWithTheVelocityOfTheirBody) {
  std::string text = kModel;
  text.replace(text.find("position: [0, 0, 100]"), 21,
               "position: [0, 0, 100], velocity: [7, 0, 0], angular_velocity: [0, 3, 0]");
  const Model m = io::read_model_text(text, "mast.yaml");
  for (std::size_t k = 1; k < 6; ++k) {
    const Vec3 arm = m.bodies[k].position - m.bodies[0].position;
    EXPECT_LT((m.bodies[k].angular_velocity - Vec3(0, 3, 0)).norm(), 1e-15);
    EXPECT_LT((m.bodies[k].velocity - Vec3(7e-3, 0, 0) - Vec3(0, 3, 0).cross(arm)).norm(), 1e-14);
  }
}

}  // namespace polhode::read_beams_tests
