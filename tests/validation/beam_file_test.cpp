// SPDX-License-Identifier: Apache-2.0
// Published beams in model files with arcs, sections and loads: statics and frequencies.
#include <cmath>

#include <gtest/gtest.h>

#include <polhode/io/read/read_model.hpp>
#include <polhode/simulation/modal.hpp>
#include <polhode/simulation/simulation_details.hpp>

namespace polhode::beam_file_tests {
namespace {

Vec3 tip_of(const std::string& text, const io::Overrides& overrides = {}) {
  Simulation s(io::read_model_text(text, "beam.yaml", overrides));
  const RunSummary r = s.run();
  EXPECT_EQ(r.end, RunEnd::finished) << r.message;
  return s.beam(0).position.back();
}

// Bathe and Bolourchi (1979): an arc of 45 degrees bent out of its plane; shear factor 5/6, torsion
// constant 1/6. Reference: the differential equations (tests/validation/data/static_beams.csv).
// The bounds are those of the meshes in static_beams_test.cpp.
constexpr const char* kArc = R"(
format: 1
variables: {R: 100, P: 600, n: 16}
materials:
  unit: {type: elastic, youngs_modulus: 1e7, poisson_ratio: 0, density: 1}
sections:
  square: {type: rectangle, height: 1, width: 1, material: unit, torsion_factor: 1/6 / 0.140577014955154,
           shear_factor_y: 5/6, shear_factor_z: 5/6}
beams:
  bend:
    arc: [[0, 0, 0], [R*sin(pi/8), R*(1 - cos(pi/8)), 0], [R*sin(pi/4), R*(1 - cos(pi/4)), 0]]
    elements: n
    section: square
    bonded: {ground: start}
loads:
  pull: {type: force, body: bend.end, force: [0, 0, P]}
analysis: {type: statics}
)";

// A cantilever of Nachbagauer, Pechstein, Irschik, Gerstmayr (2011), large load.
constexpr const char* kCantilever = R"(
format: 1
units: {length: mm, mass: kg}
materials:
  steel: {type: elastic, youngs_modulus: 207 GPa, poisson_ratio: 0.3, density: 7850 kg/m^3}
sections:
  bar: {type: rectangle, height: 500, width: 100, material: steel}
beams:
  bar: {points: [[0, 0, 0], [2000, 0, 0]], elements: 16, section: bar, up: y, bonded: {ground: start}}
loads:
  push: {type: force, body: bar.end, force: [0, 62.5 MN, 0]}
analysis: {type: statics}
)";

// A free bar of steel, shear factor 5/6: three pairs of bending frequencies.
constexpr const char* kFreeBar = R"(
format: 1
materials:
  steel: {type: elastic, youngs_modulus: 200 GPa, poisson_ratio: 0.3, density: 7800}
sections:
  square: {type: rectangle, height: 0.1, width: 0.1, material: steel, shear_factor_y: 5/6,
           shear_factor_z: 5/6}
beams:
  bar: {points: [[0, 0, 0], [2, 0, 0]], elements: 32, section: square}
analysis: {type: modes, count: 12, about: start}
)";

}  // namespace

TEST(BeamFile, TheArcOf45DegreesBendsOutOfItsPlane) {
  EXPECT_LT((tip_of(kArc) - Vec3(47.1500962, 15.6846895, 53.475478)).lpNorm<Eigen::Infinity>(),
            3e-3);
  EXPECT_LT((tip_of(kArc, {"P=300", "n=8"}) - Vec3(58.7789, 22.24468, 40.19239))
                .lpNorm<Eigen::Infinity>(),
            6.5e-3);
}

TEST(BeamFile, ACantileverBendsByTheDifferentialEquations) {
  const Vec3 tip = tip_of(kCantilever);
  EXPECT_NEAR(tip.x(), 2.0 - 0.15097114423929137, 8e-6);
  EXPECT_NEAR(tip.y(), 0.7105685978536354, 8e-6);
  EXPECT_NEAR(tip.z(), 0.0, 1e-12);
}

// Timoshenko's, exact. Errors of the averaged mass are a quarter of those of 16 elements, which are
// −0.40, −0.29, 0.07 % (tests/beams/beam_dynamics_test.cpp).
TEST(BeamFile, AFreeBarHasTimoshenkosFrequencies) {
  const ModalAnalysis bar(io::read_model_text(kFreeBar, "bar.yaml"));
  ASSERT_TRUE(bar.converged()) << bar.message();
  const std::vector<Mode>& modes = bar.report().modes;
  ASSERT_EQ(modes.size(), 12u);
  for (std::size_t k = 0; k < 6; ++k) EXPECT_TRUE(modes[k].rigid) << k;
  const double exact[] = {128.957, 349.698, 670.034}, percent[] = {-0.10, -0.07, 0.03};
  for (std::size_t k = 0; k < 6; ++k)
    EXPECT_NEAR(100.0 * (modes[6 + k].frequency / exact[k / 2] - 1.0), percent[k / 2], 0.015) << k;
}

}  // namespace polhode::beam_file_tests
