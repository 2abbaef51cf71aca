// SPDX-License-Identifier: Apache-2.0
// Contact between bodies in models with deformable solids, from model files.
#include <gtest/gtest.h>

#include <cmath>

#include <polhode/io/read/read_model.hpp>
#include <polhode/simulation/simulation_details.hpp>
#include <support/paths.hpp>

namespace polhode::test::contact_solids_models_tests {
namespace {

/// Impacts of bodies, stops of joints and surfaces of solids, solved together in a step.
TEST(ContactSolidsModel, TrolleyOnlyLosesEnergyAndItsBalanceIsExact) {
  Simulation simulation(io::read_model(source_dir() + "/tests/validation/data/trolley.yaml"));
  const auto total = [&] { return simulation.balance().kinetic + simulation.balance().potential; };
  const auto probed = [&](std::size_t k) {
    const ProbeSpec& probe = simulation.model().output.probes.at(k);
    return simulation.contact_pair(probe.pair[0], probe.pair[1]);
  };
  const int ball = probed(0), wall = probed(1);
  double before = total(), rise = 0.0;
  bool buffered = false, hit = false;
  const RunSummary summary = simulation.run({}, [&](Simulation& s) {
    rise = std::max(rise, total() - before);
    before = total();
    buffered = buffered || s.contact(wall).points > 0;
    hit = hit || s.contact(ball).points > 0;
  });
  ASSERT_EQ(summary.end, RunEnd::finished) << summary.message;
  EXPECT_TRUE(buffered);
  EXPECT_TRUE(hit);
  EXPECT_LT(rise, 1e-12 * simulation.state().ledger.energy_scale);
  EXPECT_LT(summary.energy_drift, 1e-10);
  EXPECT_LT(summary.linear_momentum_drift, 1e-10);
  EXPECT_LT(summary.angular_momentum_drift, 1e-10);
  EXPECT_LT(summary.constraint_residual_max, 1e-10);
  EXPECT_GT(summary.contacts->lost_in_impacts, 0.0);
  EXPECT_GT(summary.contacts->lost_by_friction, 0.0);
  EXPECT_EQ(summary.solver, "contact + mumps + block_lu");
}

}  // namespace
}  // namespace polhode::test::contact_solids_models_tests
