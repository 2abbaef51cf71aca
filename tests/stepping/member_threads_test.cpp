// SPDX-License-Identifier: Apache-2.0
#include <polhode/stepping/member_threads.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <polhode/core/format.hpp>
#include <polhode/io/read/read_model.hpp>
#include <polhode/simulation/simulation.hpp>
#include <support/paths.hpp>

namespace polhode::member_threads_tests {
namespace {

/// Runs with a number of threads, which is one again after it.
RunSummary run_with(int threads, const std::string& example, const io::Overrides& overrides) {
  set_threads_of_runs(threads);
  Simulation simulation(
      io::read_model(test::source_dir() + "/examples/" + example + "/model.yaml", overrides));
  set_threads_of_runs(0);
  return simulation.run();
}

void expect_same_bits(const std::string& example, const io::Overrides& overrides) {
  const RunSummary one = run_with(1, example, overrides);
  EXPECT_THAT(one.scheme, testing::HasSubstr("extrapolation")) << example;
  for (const int threads : {2, 3, 4, 8}) {
    const RunSummary more = run_with(threads, example, overrides);
    EXPECT_EQ(more.result_hash, one.result_hash) << example << threads;
    EXPECT_EQ(more.steps, one.steps);
    EXPECT_EQ(more.rejected_steps, one.rejected_steps);
    EXPECT_EQ(more.newton_iterations, one.newton_iterations);
    EXPECT_EQ(more.energy_drift, one.energy_drift);
    EXPECT_EQ(more.message, one.message);
  }
}

TEST(MemberThreads, HaveTheBitsOfOneThreadAtEveryTolerance) {
  for (const char* tolerance : {"1e-4", "1e-7", "1e-10"})
    for (const char* example : {"flyball_governor", "delta_robot", "planetary_gearbox"})
      expect_same_bits(example, {"analysis.step=auto", format("analysis.tolerance={}", tolerance),
                                 "analysis.duration=0.3 s", "output.every=0.1 s"});
}

TEST(MemberThreads, HaveTheBitsOfOneThreadWithFixedSteps) {
  for (const int order : {4, 6, 8, 12})
    expect_same_bits("flyball_governor",
                     {"analysis.step=20 ms", format("analysis.order={}", order),
                      "analysis.method=extrapolation", "analysis.duration=0.4 s"});
}

// Bushings and gears, which the block LU solves.
TEST(MemberThreads, HaveTheBitsOfOneThreadByTheBlockLu) {
  for (const char* solver : {"block_lu", "klu", "sparse_lu"})
    expect_same_bits("planetary_gearbox",
                     {"analysis.step=auto", "analysis.tolerance=1e-6", "analysis.duration=0.2 s",
                      format("analysis.solver={}", solver)});
}

// Kinks, where steps are rejected.
TEST(MemberThreads, HaveTheBitsOfOneThreadWhereStepsAreRejected) {
  expect_same_bits("suspension_corner", {"analysis.step=auto", "analysis.tolerance=1e-6",
                                         "analysis.duration=0.4 s", "output.every=0.2 s"});
  expect_same_bits("arm_with_muscles", {"analysis.step=auto", "analysis.tolerance=1e-8",
                                        "analysis.duration=0.5 s", "output.every=0.1 s"});
}

/// A pendulum with a damper that meets a stop.
Model stopped(const std::string& load) {
  return io::read_model_text(
      "format: 1\ngravity: [0, 0, -9.81]\nbodies:\n"
      "  bar: {shape: {box: [1, 0.05, 0.05]}, density: 1000, position: [0.5, 0, 0]}\n"
      "joints:\n  A: {type: revolute, bodies: [ground, bar], at: [0, 0, 0], axis: y, "
      "limits: {upper: 1.2, restitution: 0.5}}\n"
      "loads:\n  damper: {type: torsional_spring, joint: A, damping: 0.5}\n" +
          load + "analysis: {duration: 1 s, tolerance: 1e-6, method: extrapolation}\n",
      "stopped.yaml");
}

TEST(MemberThreads, MeetAStopAlike) {
  std::string hash;
  for (const int threads : {1, 2, 4}) {
    set_threads_of_runs(threads);
    Simulation simulation(stopped(""));
    set_threads_of_runs(0);
    const RunSummary run = simulation.run();
    EXPECT_EQ(run.end, RunEnd::finished) << run.message;
    if (threads == 1) hash = run.result_hash;
    EXPECT_EQ(run.result_hash, hash);
  }
}

TEST(MemberThreads, FailAlike) {
  std::string message;
  for (const int threads : {1, 2, 4}) {
    set_threads_of_runs(threads);
    Simulation simulation(
        stopped("  push: {type: moment, body: bar, moment: [0, \"sqrt(0.2 - t)\", 0]}\n"));
    set_threads_of_runs(0);
    const RunSummary run = simulation.run();
    EXPECT_EQ(run.end, RunEnd::not_converged);
    if (threads == 1) message = run.message;
    EXPECT_EQ(run.message, message);
  }
  EXPECT_THAT(message, testing::HasSubstr("push"));
}

/// Five steps with one thread and five more, against the same by three and two threads.
void expect_same_continued(const std::string& example, const io::Overrides& overrides) {
  const Model model =
      io::read_model(test::source_dir() + "/examples/" + example + "/model.yaml", overrides);
  const double end = model.analysis.duration;
  Simulation whole(model);
  set_threads_of_runs(3);
  Simulation half(model);
  for (int k = 0; k < 5; ++k) {
    ASSERT_TRUE(whole.step(end).accepted);
    ASSERT_TRUE(half.step(end).accepted);
  }
  set_threads_of_runs(2);
  Simulation rest(model, half.state());
  set_threads_of_runs(0);
  for (int k = 0; k < 5; ++k) {
    ASSERT_TRUE(whole.step(end).accepted);
    ASSERT_TRUE(rest.step(end).accepted);
  }
  EXPECT_EQ(rest.state_hash(), whole.state_hash()) << example;
}

TEST(MemberThreads, ContinueARunOfAnotherNumber) {
  expect_same_continued("flyball_governor",
                        {"analysis.step=auto", "analysis.tolerance=1e-6", "analysis.duration=4 s"});
  // No solver may know more of earlier steps than their state.
  for (const char* solver : {"block_lu", "klu", "sparse_lu"})
    for (const char* settings : {"analysis.method=extrapolation", "analysis.method=automatic"})
      expect_same_continued("planetary_gearbox",
                            {settings, "analysis.step=2 ms", format("analysis.solver={}", solver)});
}

}  // namespace
}  // namespace polhode::member_threads_tests
