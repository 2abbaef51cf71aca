// SPDX-License-Identifier: Apache-2.0
// Output of a run with contact, and its continuation from a checkpoint with the same results.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <string>
#include <utility>

#include <polhode/core/error.hpp>
#include <polhode/io/read/read_model.hpp>
#include <polhode/io/results/checkpoint.hpp>
#include <polhode/io/text/file_error.hpp>
#include <support/recorded_run.hpp>
#include <support/scratch.hpp>

namespace polhode::contact_output_tests {
namespace {

using test::csv_rows, test::recorded_run;

using testing::HasSubstr;

/// A ball falls through a gate onto the floor, next to a block that stands there and slides.
const char* kModel = R"(
format: 1
title: Ball and block
gravity: [0, 0, -10]
bodies:
  floor: {fixed: true, shape: {plane: z}}
  gate: {fixed: true, position: [0, 0, 0.5], shape: {box: [1, 1, 0.1]}}
  ball: {shape: {sphere: 0.2}, mass: 2, position: [0, 0, 1]}
  block: {shape: {box: [0.2, 0.2, 0.2]}, mass: 1, position: [1, 0, 0.1], velocity: [1, 0, 0]}
contacts:
  default: {friction: 0.25}
  pairs: {bounce: {between: [ball, floor], restitution: 0.5}}
  sensors: {passing: {between: [ball, gate]}}
analysis: {duration: 1.5 s, step: 5 ms}
output:
  every: 50 ms
  paraview: true
  probes:
    feet: {contact: [block, floor], every: 5 ms}
    turned: {contact: [floor, block], every: 5 ms}
    ball: {body: ball}
)";

TEST(ContactOutput, HasForcesImpulsesAndLossesByNewtonsLaws) {
  const test::Scratch scratch;
  Simulation simulation(io::read_model_text(kModel, "m.yaml"));
  const RunSummary summary = recorded_run(simulation, (scratch / "out"));
  ASSERT_EQ(summary.end, RunEnd::finished) << summary.message;
  // Columns: t, gap, normal, f (3), ft (3), p (3), points, status, impulse, lost.
  const auto feet = csv_rows((scratch / "out/probes/feet.csv"));
  const auto turned = csv_rows((scratch / "out/probes/turned.csv"));
  ASSERT_EQ(feet.front().size(), 16U);
  // It slides to a halt in 0.4 s: v²/(2 µ g) = 0.2 m; meanwhile friction is 0.25 of the weight.
  const std::vector<double>& sliding = feet[40];
  EXPECT_NEAR(sliding[2], 10.0, 0.05);
  EXPECT_NEAR(sliding[6], -0.25 * sliding[2], 1e-9);
  EXPECT_EQ(sliding[13], 2.0);
  EXPECT_EQ(sliding[12], 4.0);
  EXPECT_NEAR(turned[40][6], 0.25 * sliding[2], 1e-9) << "sign: on the first body of the probe";
  const std::vector<double>& end = feet.back();
  EXPECT_NEAR(end[2], 10.0, 1e-6);
  EXPECT_EQ(end[13], 1.0);
  // Impulse of the floor: weight times time, as nothing moves vertically before or after.
  EXPECT_NEAR(end[14], 10.0 * 1.5, 1e-3);
  EXPECT_NEAR(end[15], 0.5 * 1.0 * 1.0, 1e-3);
  ASSERT_TRUE(summary.contacts);
  EXPECT_NEAR(summary.contacts->lost_by_friction, 0.5, 2e-3);
  EXPECT_GT(summary.contacts->lost_in_impacts, 0.0);
  EXPECT_LT(std::abs(summary.contacts->numerical), 1e-6);
  EXPECT_LT(summary.energy_drift, 1e-7);
  EXPECT_EQ(summary.contacts->shapes, 4);
  EXPECT_GE(summary.contacts->least_gap, -1e-4);
  for (const char* file : {"paraview/contacts.pvd", "paraview/contacts/000003.vtp", "results.h5"})
    EXPECT_TRUE(std::filesystem::exists(scratch / (std::string("out/") + file))) << file;
}

TEST(ContactOutput, RecordsWhenASensorBeginsAndEnds) {
  const test::Scratch scratch;
  Simulation simulation(io::read_model_text(kModel, "m.yaml"));
  recorded_run(simulation, (scratch / "out"));
  const std::string events = io::read_file((scratch / "out/events.csv"));
  EXPECT_THAT(events, HasSubstr("passing,began"));
  EXPECT_THAT(events, HasSubstr("passing,ended"));
  ASSERT_EQ(simulation.sensor_events().size(), 2U);
  // The ball's lower end falls from 0.9 m to 0.55 m, its upper end from 1.1 m to 0.45 m.
  EXPECT_NEAR(simulation.sensor_events()[0].t, std::sqrt(2 * 0.35 / 10), 6e-3);
  EXPECT_NEAR(simulation.sensor_events()[1].t, std::sqrt(2 * 0.65 / 10), 6e-3);
}

TEST(ContactOutput, ContinuesFromACheckpointBitForBit) {
  const test::Scratch scratch;
  Model model = io::read_model_text(kModel, "m.yaml");
  Simulation straight(model);
  const RunSummary whole = recorded_run(straight, (scratch / "straight"));
  // Stop where the block slides and the ball is on its way up again.
  model.analysis.duration = 0.35;
  Simulation first(model);
  recorded_run(first, (scratch / "parts"));
  io::write_checkpoint((scratch / "c.pst"), first.model(), first.system(), first.state());
  model.analysis.duration = 1.5;
  const Simulation plan(model);
  Simulation second(model, io::read_checkpoint((scratch / "c.pst"), model, plan.system()));
  const RunSummary rest = recorded_run(second, (scratch / "parts"), true);
  EXPECT_EQ(rest.result_hash, whole.result_hash);
  EXPECT_EQ(rest.contacts->lost_by_friction, whole.contacts->lost_by_friction);
  EXPECT_EQ(rest.contacts->lost_in_impacts, whole.contacts->lost_in_impacts);
  EXPECT_EQ(io::read_file((scratch / "parts/probes/feet.csv")),
            io::read_file((scratch / "straight/probes/feet.csv")));
  EXPECT_EQ(io::read_file((scratch / "parts/events.csv")),
            io::read_file((scratch / "straight/events.csv")));
}

TEST(ContactOutput, IncludesContactForcesInReactionsAndAccelerations) {
  // Creep of the block by its bristles, half a second after it stopped; it decreases with the step.
  for (const auto& [step, bound] : {std::pair{"5 ms", 1e-5}, {"0.5 ms", 1e-9}}) {
    Simulation simulation(
        io::read_model_text(kModel, "m.yaml", {std::string("analysis.step=") + step}));
    simulation.run();
    const int block = simulation.model().body_index("block");
    EXPECT_LT(simulation.point(block, Vec3::Zero()).acceleration.norm(), bound) << step;
  }
}

TEST(ContactOutput, NumericalDampingIsAcceptedWithAWarning) {
  const Simulation simulation(io::read_model_text(kModel, "m.yaml", {"analysis.rho_inf=0.9"}));
  EXPECT_THAT(simulation.summary().narration, HasSubstr("rho_inf is 0.9"));
}

}  // namespace
}  // namespace polhode::contact_output_tests
