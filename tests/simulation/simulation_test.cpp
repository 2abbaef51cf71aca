// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <polhode/polhode.hpp>
#include <polhode/simulation/simulation_details.hpp>
#include <support/models.hpp>

namespace polhode::simulation_tests {
namespace {

TEST(Simulation, RefusesAStepThatEndsBeforeItBegins) {
  Simulation run(io::read_model_text(R"(
format: 1
bodies: {ball: {mass: 1, inertia: [1, 1, 1], velocity: [1, 0, 0]}}
analysis: {duration: 1 s, step: 0.1 s}
)",
                                     "ball.yaml"));
  while (run.time() < 1.0 - 1e-9) ASSERT_TRUE(run.step(1.0).accepted);
  for (const double end : {run.time(), 0.5, std::numeric_limits<double>::quiet_NaN()}) {
    try {
      (void)run.step(end);
      ADD_FAILURE() << end;
    } catch (const InputError& e) {
      EXPECT_THAT(e.what(), testing::HasSubstr("must be after the present time, 1."));
    }
  }
  EXPECT_TRUE(run.step(1.05).accepted);
}

/// Loops with redundant rows, a driven hinge and a damper.
Model driven_squares() {
  test::ModelBuilder m;
  m.model = test::n_four_bar(3, 0.3);
  m.spring("damper", 0, {0.0, 0.5, 0.0}, 2, {2.0, 0.5, 0.0},
           {{"stiffness", 30.0}, {"damping", 2.0}, {"free_length", 1.5}});
  m.model.analysis.step = 2e-3;
  m.model.analysis.duration = 0.4;
  return m.model;
}

/// All numbers that frames have of bodies and joints.
std::vector<double> reported(const Simulation& s) {
  std::vector<double> list;
  const auto add = [&](const Vec3& x) { list.insert(list.end(), x.begin(), x.end()); };
  for (int b = 0; b < static_cast<int>(s.model().bodies.size()); ++b) {
    const Simulation::PointMotion point = s.point(b, {0.1, 0.2, 0.3});
    for (const Vec3& x : {point.position, point.velocity, point.acceleration}) add(x);
    add(s.angular_acceleration(b));
  }
  for (int j = 0; j < static_cast<int>(s.model().joints.size()); ++j) {
    const JointReport joint = s.joint(j);
    add(joint.force);
    add(joint.moment);
    list.insert(list.end(), joint.rates.begin(), joint.rates.end());
  }
  return list;
}

TEST(Simulation, FramesChangeNeitherTheMotionNorOneAnother) {
  std::string hash;
  std::vector<double> at_end;
  for (const double every : {0.4, 0.1, 0.002}) {
    Model model = driven_squares();
    model.output.every = every;
    Simulation run(std::move(model));
    const RunSummary summary = run.run();
    ASSERT_EQ(summary.solver, "tree");
    if (hash.empty()) {
      hash = summary.result_hash;
      at_end = reported(run);
    }
    EXPECT_EQ(summary.result_hash, hash) << every;
    EXPECT_EQ(reported(run), at_end) << every;
  }
  // A restart has the same bits, at its beginning and at the end.
  Simulation first(driven_squares());
  while (first.time() < 0.2 - 1e-9) ASSERT_TRUE(first.step(0.4).accepted);
  Simulation second(driven_squares(), first.state());
  EXPECT_EQ(reported(second), reported(first));
  EXPECT_EQ(second.run().result_hash, hash);
  EXPECT_EQ(reported(second), at_end);
}

TEST(Simulation, PhasesAddUpToTheTimeOfTheRun) {
  Model model = driven_squares();
  model.output.every = 4e-3;
  Simulation run(std::move(model));
  double sum = 0.0;
  const auto work = [&](Simulation& s) {
    for (int i = 0; i < 20; ++i)
      for (const double x : reported(s)) sum += std::abs(x);
  };
  const RunSummary summary = run.run(work, work);
  EXPECT_GT(sum, 0.0);
  double phases = 0.0;
  for (const auto& [name, seconds] : summary.phases) {
    EXPECT_GE(seconds, 0.0) << name;
    if (name != "start") phases += seconds;  // before the run
  }
  // Within 3 % on a quiet machine; another program may hold this one up between two phases.
  EXPECT_LE(phases, 1.01 * summary.wall_time_s);
  EXPECT_GE(phases, 0.8 * summary.wall_time_s);
}

}  // namespace
}  // namespace polhode::simulation_tests
