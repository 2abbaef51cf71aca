// SPDX-License-Identifier: Apache-2.0
// Long runs at ρ∞ = 1: energy and momenta are conserved to round-off with every kind of connection.
//
// The bounds are those the engine promises: 1e-11 over 1e6 steps of a free body, 1e-10 over 1e5
// steps of mechanisms. Round-off alone, a random walk of 1e-16 a step, would be 1e-13.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <polhode/joints/registry.hpp>
#include <polhode/simulation/simulation_details.hpp>
#include <support/models.hpp>

namespace polhode::test::conservation_tests {
namespace {

RunSummary run_steps(Model model, double step, std::int64_t steps) {
  model.analysis.step = step;
  model.analysis.duration = step * static_cast<double>(steps);
  model.output.every = model.analysis.duration;
  Simulation simulation(std::move(model));
  return simulation.run();
}

void expect_conserved(const RunSummary& r, double within, std::int64_t steps) {
  ASSERT_EQ(r.end, RunEnd::finished) << r.message;
  EXPECT_GE(r.steps, steps);
  EXPECT_LE(r.steps, steps + 10) << "near the mirror image of a joint a step may be cut";
  EXPECT_LE(r.energy_drift, within) << "energy";
  EXPECT_LE(r.linear_momentum_drift, within) << "linear momentum";
  EXPECT_LE(r.angular_momentum_drift, within) << "angular momentum";
  EXPECT_LE(r.constraint_residual_max, 1e-11) << "joints";
}

constexpr double kFree = 1e-11, kJointed = 1e-10;
constexpr std::int64_t kMillion = 1'000'000, kSteps = 100'000;

TEST(Conservation, OfAFreeAsymmetricBodyOverAMillionSteps) {
  Model m = free_asymmetric_top();
  m.bodies[0].angular_velocity = {1.0, -2.0, 0.7};
  m.bodies[0].velocity = {0.3, -0.1, 0.2};
  expect_conserved(run_steps(m, 0.02, kMillion), kFree, kMillion);
}

TEST(Conservation, OfTheHeavyTop) {
  expect_conserved(run_steps(heavy_top(), 1e-3, kSteps), kJointed, kSteps);
}

TEST(Conservation, OfTheClosedSpatialSliderCrank) {
  expect_conserved(run_steps(spatial_slider_crank(), 2e-3, kSteps), kJointed, kSteps);
}

TEST(Conservation, OfAChainWithSpringsOfEveryKind) {
  expect_conserved(run_steps(sprung_chain(), 2e-3, kSteps), kJointed, kSteps);
}

struct ChainCase {
  std::string type;
  std::vector<std::string> free;
  bool grounded;
};

std::vector<ChainCase> chains() {
  std::vector<ChainCase> all;
  for (const bool grounded : {false, true})
    for (const JointKind& kind : joint_kinds()) {
      if (kind.name == "fixed" && grounded) continue;  // does not move, see below
      // Rods and links keep their points apart: shafts_and_rods_test.cpp has theirs.
      if (kind.points_apart && kind.name != "distance") continue;
      if (kind.name != "generic") {
        all.push_back({kind.name, {}, grounded});
        continue;
      }
      // Freedoms that no other kind has: a translation with rotations about other axes.
      all.push_back({"generic", {"x", "ry"}, grounded});
      all.push_back({"generic", {"z", "rx", "ry"}, grounded});
      all.push_back({"generic", {"x", "z", "rx", "ry", "rz"}, grounded});
    }
  return all;
}

std::string name_of(const ChainCase& c) {
  std::string name = (c.grounded ? "grounded_" : "floating_") + c.type;
  for (const std::string& f : c.free) name += "_" + f;
  return name;
}

class Chain : public testing::TestWithParam<ChainCase> {};

TEST_P(Chain, ConservesEnergyAndMomenta) {
  const ChainCase& c = GetParam();
  ModelBuilder m;
  m.model = chain(c.type, 3, c.grounded, c.free);
  // Where joints let bodies slide they would fall for kilometres; a spring holds them near.
  if (c.grounded)
    for (int b = 0; b < 3; ++b)
      m.spring("spring" + std::to_string(b), kGround, {0.2, -0.3, 1.5}, b, m.at(b).position,
               {{"stiffness", 30.0}, {"free_length", 1.0}});
  expect_conserved(run_steps(m.model, 1e-3, kSteps), kJointed, kSteps);
}

TEST(Conservation, OfBodiesWeldedToTheGround) {
  Model model = chain("fixed", 3, true);
  model.analysis.step = 1e-3;
  model.analysis.duration = 10.0;
  Simulation s(model);
  const RunSummary r = s.run();
  ASSERT_EQ(r.end, RunEnd::finished) << r.message;
  for (int b = 0; b < 3; ++b)
    EXPECT_LE((s.body(b).r - model.bodies[static_cast<std::size_t>(b)].position).norm(), 1e-13);
}

INSTANTIATE_TEST_SUITE_P(Of, Chain, testing::ValuesIn(chains()),
                         [](const auto& p) { return name_of(p.param); });

// Dampers: the sum of stored and dissipated energy is constant, and no step creates energy.
void expect_dissipation(Model model, double step, std::int64_t steps, double least_dissipated) {
  model.analysis.step = step;
  model.analysis.duration = step * static_cast<double>(steps);
  Simulation simulation(std::move(model));
  const Balance start = simulation.balance();
  double last = start.kinetic + start.potential, scale = 0.0, rise = 0.0;
  for (std::int64_t i = 0; i < steps; ++i) {
    const StepReport report = simulation.step(simulation.model().analysis.duration);
    ASSERT_TRUE(report.accepted) << report.message;
    const Balance now = simulation.balance();
    const double energy = now.kinetic + now.potential;
    scale = std::max(scale, now.kinetic + std::abs(now.potential - start.potential));
    rise = std::max(rise, energy - last);
    last = energy;
  }
  const Balance end = simulation.balance();
  EXPECT_GT(end.dissipated, least_dissipated * scale) << "the dampers have too little effect here";
  EXPECT_LE(rise, 1e-13 * scale) << "a step created energy";
  EXPECT_LE(simulation.summary().energy_drift, kJointed);
  EXPECT_NEAR(end.kinetic + end.potential + end.dissipated, start.kinetic + start.potential,
              kJointed * scale);
}

TEST(Dampers, NeverCreateEnergyInAChain) {
  expect_dissipation(sprung_chain(2.0), 2e-3, 20'000, 0.01);
}

TEST(Dampers, NeverCreateEnergyInTheFlyballGovernor) {
  // Stiff springs hold the rods: the loss is small, but far above round-off.
  expect_dissipation(flyball_governor(), 1e-3, 20'000, 1e-6);
}

}  // namespace
}  // namespace polhode::test::conservation_tests
