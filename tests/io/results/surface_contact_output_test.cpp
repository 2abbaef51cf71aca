// SPDX-License-Identifier: Apache-2.0
// Output of a run with contact of solids' surfaces, and its continuation from a checkpoint with the
// same results.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include <polhode/io/read/read_model.hpp>
#include <polhode/io/results/checkpoint.hpp>
#include <polhode/io/text/file_error.hpp>
#include <support/recorded_run.hpp>
#include <support/scratch.hpp>

namespace polhode::surface_contact_output_tests {
namespace {

using test::csv_rows, test::recorded_run;

/// A rubber block that lands on an inclined floor, below the angle of friction, and a ball that
/// lands on the block.
const char* kModel = R"(
format: 1
title: Block and ball
gravity: [1, 0, -10]
bodies:
  floor: {fixed: true, shape: {plane: z}}
  ball: {shape: {sphere: 0.06}, mass: 0.5, position: [0, 0, 0.142]}
materials:
  rubber: {type: neo_hookean, youngs_modulus: 0.2 MPa, poisson_ratio: 0.3, density: 1000, viscosity: {relaxation_time: 5 ms}}
solids:
  block:
    mesh: {block: {size: [0.1, 0.1, 0.1], cells: [2, 2, 2]}, position: [0, 0, 0.051]}
    material: rubber
contacts:
  default: {friction: 0.4}
  exclude: [[ball, floor]]
analysis: {duration: 0.3 s, step: 2.5 ms}
output:
  every: 50 ms
  paraview: true
  probes:
    foot: {contact: [block, floor], every: 1 us}
    head: {contact: [ball, block], every: 1 us}
)";

TEST(SurfaceContactOutput, HasForcesImpulsesAndLossesByNewtonsLaws) {
  const test::Scratch scratch;
  Simulation simulation(io::read_model_text(kModel, "m.yaml"));
  const RunSummary summary = recorded_run(simulation, scratch / "out");
  ASSERT_EQ(summary.end, RunEnd::finished) << summary.message;
  const auto foot = csv_rows(scratch / "out/probes/foot.csv"),
             head = csv_rows(scratch / "out/probes/head.csv");
  ASSERT_EQ(foot.front().size(), 16U);
  // The probe gives forces on its first entry: the floor carries block and ball, the block carries
  // the ball. Impulses balance the change of momentum in every direction.
  const Balance b = simulation.balance();
  const double t = simulation.time();
  Vec3 on_block = Vec3::Zero(), on_ball = Vec3::Zero();
  for (std::size_t k = 1; k < foot.size(); ++k) {
    const double dt = foot[k][0] - foot[k - 1][0];
    on_block += dt * Vec3(foot[k][3], foot[k][4], foot[k][5]);
    on_ball += dt * Vec3(head[k][3], head[k][4], head[k][5]);
  }
  const Vec3 g(1, 0, -10);
  EXPECT_LT((on_block + 1.5 * t * g - b.linear_momentum).norm(), 1e-9);
  EXPECT_LT((on_ball + 0.5 * t * g - 0.5 * simulation.body(1).v).norm(), 1e-9);
  EXPECT_GT(on_ball[2], 1.0);
  EXPECT_NEAR(foot.back()[14], on_block[2], 1e-9)
      << "on a plane the sum of pressures is the normal force";
  double most = 0.0;
  for (const std::vector<double>& row : foot)
    if (row[2] > 0.0) most = std::max(most, std::hypot(row[6], row[7]) / row[2]);
  EXPECT_LT(most, 0.4 * (1 + 1e-12));
  EXPECT_GT(most, 0.05);
  ASSERT_TRUE(summary.contacts);
  EXPECT_EQ(summary.contacts->surfaces, 2);
  EXPECT_EQ(summary.contacts->shapes, 0);
  EXPECT_NEAR(summary.contacts->lost_by_friction + summary.contacts->lost_in_impacts,
              foot.back()[15] + head.back()[15], 1e-12);
  EXPECT_GT(summary.contacts->lost_in_impacts, 0.0);
  EXPECT_GT(summary.contacts->least_gap, -5e-5) << "the tolerance: 1e-3 of an edge";
  EXPECT_LT(std::abs(summary.contacts->numerical), 1e-9);
  EXPECT_LT(summary.energy_drift, 1e-9);
  EXPECT_LT(summary.linear_momentum_drift, 1e-10);
  EXPECT_LT(summary.angular_momentum_drift, 1e-10);
  for (const char* file : {"paraview/contacts.pvd", "paraview/contacts/000003.vtp", "results.h5"})
    EXPECT_TRUE(std::filesystem::exists(scratch / (std::string("out/") + file))) << file;
}

TEST(SurfaceContactOutput, ContinuesFromACheckpointBitForBit) {
  const test::Scratch scratch;
  const Model model = io::read_model_text(kModel, "m.yaml");
  Simulation straight(model);
  const RunSummary whole = recorded_run(straight, scratch / "straight");
  Model half = model;
  half.analysis.duration = 0.1;  // the block is deformed and slides
  Simulation first(half);
  ASSERT_EQ(recorded_run(first, scratch / "cut").end, RunEnd::finished);
  io::write_checkpoint(scratch / "c.pst", first.model(), first.system(), first.state());
  const Simulation plan(model);
  Simulation second(model, io::read_checkpoint(scratch / "c.pst", model, plan.system()));
  const RunSummary rest = recorded_run(second, scratch / "cut", true);
  EXPECT_EQ(rest.result_hash, whole.result_hash);
  for (const char* file : {"foot", "head"})
    EXPECT_EQ(io::read_file(scratch / ("cut/probes/" + std::string(file) + ".csv")),
              io::read_file(scratch / ("straight/probes/" + std::string(file) + ".csv")));
  EXPECT_EQ(rest.contacts->lost_by_friction, whole.contacts->lost_by_friction);
}

}  // namespace
}  // namespace polhode::surface_contact_output_tests
