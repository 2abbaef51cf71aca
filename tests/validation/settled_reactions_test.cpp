// SPDX-License-Identifier: Apache-2.0
// Reactions of solids with overdamped modes: those of the motion, without the oscillations of
// Newmark's velocities. @tests{settled-rate}
#include <string>

#include <gtest/gtest.h>

#include <polhode/core/format.hpp>
#include <polhode/io/read/read_model.hpp>
#include <polhode/simulation/simulation.hpp>
#include <polhode/stepping/extrapolated_velocities.hpp>

namespace polhode::settled_reactions_tests {
namespace {

/// Σw = 1, zero first and (with four) second moment, and zero response to alternating terms.
/// @tests{settled-weights}
TEST(SettledReactions, HaveWeightsExactForQuadraticsThatRemoveAlternatingTerms) {
  for (const std::vector<double>& dt :
       {std::vector<double>{0.1, 0.1, 0.1, 0.1}, {0.02, 0.03, 0.015, 0.04}, {0.01, 0.01, 0.02}}) {
    const std::vector<double> w = extrapolation_weights(dt);
    ASSERT_EQ(w.size(), dt.size());
    double one = 0.0, first = 0.0, second = 0.0, alternating = 0.0, end = 0.0;
    for (std::size_t k = 0; k < dt.size(); ++k) {
      const double start = end - dt[k];
      // Mean rates over steps: differences of t, t² and t³ at their ends.
      one += w[k];
      first += w[k] * (end * end - start * start) / dt[k];
      second += w[k] * (end * end * end - start * start * start) / dt[k];
      alternating += w[k] * (k % 2 == 0 ? 1.0 : -1.0) / dt[k];
      end = start;
    }
    EXPECT_NEAR(one, 1.0, 1e-13);
    EXPECT_NEAR(first, 0.0, 1e-14);
    if (dt.size() > 3) {
      EXPECT_NEAR(second, 0.0, 1e-15);
    }
    EXPECT_NEAR(alternating * dt[0], 0.0, 1e-12);
  }
  EXPECT_TRUE(extrapolation_weights({0.1, 0.1}).empty());
  EXPECT_TRUE(extrapolation_weights({0.1, -0.1, 0.1}).empty()) << "a stage with a negative step";
}

/// A body of 20 kg with a bar of 10 kg bonded to it, pushed by 30 N from rest, spinning or not: the
/// bar is pulled by its mass times the acceleration of its centre. Its modes decay in hundredths of
/// a second or are overdamped, at steps that resolve none of them.
TEST(SettledReactions, PullABarByItsMassTimesItsAcceleration) {
  const char* text = R"(
format: 1
variables: {spin: 0}
bodies:
  hub: {mass: 20, inertia: [1, 1, 1], angular_velocity: [0, 0, spin]}
materials: {m: {type: elastic, youngs_modulus: 1 MPa, poisson_ratio: 0.3, density: 1000, viscosity: {relaxation_time: 0.1 s}}}
solids:
  bar:
    mesh: {block: {size: [1, 0.1, 0.1], cells: [4, 1, 1]}, position: [0.5, 0, 0]}
    element: hex20
    material: m
    bonded: {hub: xmin}
loads: {push: {type: force, body: hub, force: [30, 0, 0]}}
analysis: {duration: 1.5 s, step: 20 ms}
output: {hdf5: false}
)";
  for (const char* step : {"20 ms", "10 ms", "2 ms"}) {
    Simulation s(io::read_model_text(text, "bar.yaml", {std::string("analysis.step=") + step}));
    const RunSummary summary = s.run();
    ASSERT_EQ(summary.end, RunEnd::finished) << summary.message;
    EXPECT_NEAR(s.interface_reaction(0, 0).force.x(), 10.0, 2e-3) << step;
    EXPECT_LT(summary.energy_drift, 1e-11) << step;
  }
  // Spinning freely: the hub moves around the common centre of mass, which moves as it did at the
  // start.
  for (const char* step : {"10 ms", "5 ms", "2 ms"}) {
    Simulation s(io::read_model_text(
        text, "bar.yaml",
        {std::string("analysis.step=") + step, "variables.spin=2", "loads.push.force=[0, 0, 0]"}));
    const RunSummary summary = s.run();
    ASSERT_EQ(summary.end, RunEnd::finished) << summary.message;
    const BodyMotion hub = s.body(0);
    const Vec3 centre(5.0 / 30.0, 10.0 / 30.0 * s.time(), 0.0);
    const double pull = 20.0 * hub.omega().squaredNorm() * (hub.r - centre).norm();
    const Vec3 inwards = (hub.r - centre).normalized();
    EXPECT_NEAR(s.interface_reaction(0, 0).force.dot(inwards), pull, 2e-3 * pull) << step;
    EXPECT_LT(summary.energy_drift, 1e-11) << step;
  }
}

}  // namespace
}  // namespace polhode::settled_reactions_tests
