// SPDX-License-Identifier: Apache-2.0
// Statics along a history: functions of time as they stand, events, outputs at given times.
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <support/run_text.hpp>

namespace polhode::static_history_tests {
namespace {

using test::made;

/// A slider of 2 kg on a spring of 100 N/m, pressed against its guide by 30 N and pushed along it.
std::string slider(const std::string& joint, const std::string& push, const std::string& more,
                   const std::string& steps) {
  return R"(
format: 1
bodies: {s: {mass: 2, inertia: [0.01, 0.01, 0.01]}}
joints: {j: {type: prismatic, bodies: [ground, s], at: [0, 0, 0], axis: z)" +
         joint + R"(}}
loads:
  k: {type: translational_spring, joint: j, stiffness: 100}
  f: {type: force, body: s, force: [30, 0, )" +
         push + "]}\n" + more + R"(
output: {hdf5: false, every: 0.5 s}
analysis: {type: statics, history: 3 s)" +
         steps + "}\n";
}

/// Displacements at the output times.
std::vector<std::vector<double>> outputs(const std::string& text, RunSummary* summary = nullptr) {
  Simulation s = made(text);
  std::vector<std::vector<double>> list;
  const RunSummary r = s.run([&](Simulation& now) {
    list.push_back({now.time(), now.body(0).r.z()});
  });
  EXPECT_EQ(r.end, RunEnd::finished) << r.message;
  if (summary) *summary = r;
  return list;
}

const std::string kSteps[] = {"", ", load_steps: 6", ", load_steps: 600"};

}  // namespace

// Coulomb's law of 6 N and a spring: x = (F − 6 N)/k under growing load, held when it is held, and
// back only where the spring exceeds the load by 6 N. F: 0, 10, 20, 20, 20, 10, 0 N.
TEST(StaticHistory, FrictionHasItsHysteresisOverLoadingHoldingAndUnloading) {
  const double expected[] = {0.0, 0.04, 0.14, 0.14, 0.14, 0.14, 0.06};
  for (const std::string& steps : kSteps) {
    RunSummary summary;
    const auto seen = outputs(
        slider(", friction: {mu: 0.2}",
               "{table: [[0, 0], [1, 20], [2, 20], [3, 0]], interpolation: linear}", "", steps),
        &summary);
    ASSERT_EQ(seen.size(), 7u) << steps;
    for (std::size_t i = 0; i < 7; ++i) {
      EXPECT_NEAR(seen[i][0], 0.5 * static_cast<double>(i), 1e-12) << steps;
      EXPECT_NEAR(seen[i][1], expected[i], 1e-5) << steps << " at " << seen[i][0];
    }
    EXPECT_EQ(summary.t, 3.0);
    EXPECT_TRUE(summary.statics->converged);
  }
}

// The loads at the start act from the start, and are not multiplied by the time.
TEST(StaticHistory, StartsInTheEquilibriumOfTheLoadsAtItsStart) {
  for (const std::string& steps : kSteps) {
    const auto seen = outputs(slider("", "\"5 + 2*t\"", "", steps));
    ASSERT_EQ(seen.size(), 7u);
    for (const auto& now : seen) EXPECT_NEAR(now[1], (5.0 + 2.0 * now[0]) / 100.0, 1e-12) << steps;
  }
}

// A second spring of 100 N/m is cut at 1 s; at 2 s a latch holds the slider where it is.
TEST(StaticHistory, EventsSwitchLoadsAndJoints) {
  const std::string more =
      R"(  k2: {type: spring_damper, bodies: [ground, s], at: [[0, 0, -1], [0, 0, 0]], stiffness: 100}
events:
  open: {at: 0, off: [latch]}
  cut: {at: 1 s, off: [k2]}
  hold: {at: 2 s, on: [latch]}
)";
  for (const std::string& steps : kSteps) {
    std::string text = slider("", "\"10*t\"", more, steps);
    text.replace(text.find("axis: z}"), 8,
                 "axis: z}, latch: {type: fixed, bodies: [ground, s], at: [0, 0, 0]}");
    RunSummary summary;
    const auto seen = outputs(text, &summary);
    ASSERT_EQ(seen.size(), 7u) << steps;
    const double expected[] = {0.0, 0.025, 0.05, 0.15, 0.2, 0.2, 0.2};
    for (std::size_t i = 0; i < 7; ++i)
      EXPECT_NEAR(seen[i][1], expected[i], 1e-9) << steps << " at " << seen[i][0];
    ASSERT_EQ(summary.events.size(), 3u);
    EXPECT_NEAR(summary.events[1].time, 1.0, 1e-12);
    EXPECT_NEAR(summary.events[2].time, 2.0, 1e-12);
  }
}

// x = t/10 m reaches 0.123 m at 1.23 s, and the run ends there.
TEST(StaticHistory, AnEventStopsWhereItsLevelIsReached) {
  for (const std::string& steps : kSteps) {
    Simulation s = made(slider("", "\"10*t\"",
                               "events: {there: {when: {body: s, channel: z, above: 0.123}, "
                               "stop: true}}\n",
                               steps));
    const RunSummary r = s.run();
    EXPECT_EQ(r.end, RunEnd::finished) << r.message;
    EXPECT_NEAR(r.t, 1.23, 1e-9) << steps;
    EXPECT_NEAR(s.body(0).r.z(), 0.123, 1e-9) << steps;
  }
}

// A motor follows its function of time, over several turns and back.
TEST(StaticHistory, DrivesFollowTheirFunctions) {
  for (const std::string& steps : kSteps) {
    Simulation s = made(R"yaml(
format: 1
bodies: {b: {mass: 1, inertia: [1, 1, 1]}}
joints: {j: {type: revolute, bodies: [ground, b], at: [0, 0, 0], axis: z}}
loads:
  m: {type: rotary_motor, joint: j, angle: "6*t*(3 - t)"}
  k: {type: torsional_spring, joint: j, stiffness: 2}
output: {hdf5: false, every: 0.5 s}
analysis: {type: statics, history: 3 s)yaml" +
                        steps + "}\n");
    const RunSummary r = s.run([&](Simulation& now) {
      const double t = now.time();
      EXPECT_NEAR(now.joint(0).coordinates[0], 6.0 * t * (3.0 - t), 1e-9) << steps << " at " << t;
    });
    EXPECT_EQ(r.end, RunEnd::finished) << r.message;
  }
}

// Without an equilibrium at the start there is no history.
TEST(StaticHistory, SaysWhenItsStartHasNoEquilibrium) {
  Simulation s = made(R"(
format: 1
bodies: {b: {mass: 1, inertia: [1, 1, 1]}}
joints: {j: {type: prismatic, bodies: [ground, b], at: [0, 0, 0], axis: x}}
loads: {f: {type: force, body: b, force: [1, 0, 0]}}
output: {hdf5: false}
analysis: {type: statics, history: 2 s}
)");
  const RunSummary r = s.run();
  EXPECT_EQ(r.end, RunEnd::not_converged);
  EXPECT_EQ(r.t, 0.0);
  EXPECT_NE(r.message.find("of the loads at the start of the history"), std::string::npos)
      << r.message;
}

TEST(StaticHistory, BelongsToStatics) {
  test::expect_fault(
      "format: 1\nbodies: {b: {mass: 1, inertia: [1, 1, 1]}}\nanalysis: {history: 2 s}\n",
      "It requires type statics");
}

}  // namespace polhode::static_history_tests
