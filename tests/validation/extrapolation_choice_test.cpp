// SPDX-License-Identifier: Apache-2.0
// What a tolerance chooses for models that dissipate: orders by extrapolation, order 2 around stops
// and for undamped vibrations that no step resolves.
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <polhode/io/read/read_model.hpp>
#include <polhode/simulation/simulation_details.hpp>
#include <support/paths.hpp>
#include <support/published_cases.hpp>

namespace polhode::test::extrapolation_choice_tests {
namespace {

using testing::HasSubstr;

Simulation run(Model model, double tolerance) {
  model.analysis.step.reset();
  model.analysis.tolerance = tolerance;
  Simulation s(std::move(model));
  const RunSummary r = s.run();
  EXPECT_EQ(r.end, RunEnd::finished) << r.message;
  return s;
}

std::int64_t work(const Simulation& s) { return s.state().ledger.iterations; }

// A body that falls along a rail against a viscous damper and rebounds from a stop.
std::string bouncing(const std::string& limits) {
  return R"yaml(
format: 1
gravity: [0, 0, -9.81]
bodies: {block: {mass: 2, inertia: [0.01, 0.01, 0.01], position: [0, 0, 1]}}
joints: {rail: {type: prismatic, bodies: [ground, block], at: [0, 0, 1], axis: z, limits: )yaml" +
         limits + R"yaml(}}
loads: {oil: {type: translational_spring, joint: rail, damping: 1}}
analysis: {duration: 1.5 s, tolerance: 1e-6}
)yaml";
}

/// Height of that block above its start: v' = −g − (c/m) v between rebounds at −depth.
double height_after(double t, double depth, double e) {
  const double rate = 1.0 / 2.0, g = 9.81, v_end = -g / rate;
  double z = 0.0, v = 0.0;
  const auto moved = [&](double s) {
    return v_end * s + (v - v_end) / rate * -std::expm1(-rate * s);
  };
  const auto speed = [&](double s) { return v_end + (v - v_end) * std::exp(-rate * s); };
  for (;;) {
    // The time of the rebound: after the highest point, where the motion is monotonous.
    double low = v > 0.0 ? std::log1p(-v / v_end) / rate : 0.0, high = low + 10.0;
    if (z + moved(high) > -depth) return z + moved(t);
    for (int i = 0; i < 100; ++i) {
      const double middle = 0.5 * (low + high);
      (z + moved(middle) > -depth ? low : high) = middle;
    }
    if (low >= t) return z + moved(t);
    v = -e * speed(low);
    z = -depth;
    t -= low;
  }
}

double block_height(const Simulation& s) { return s.system().motion(s.state(), 0).r.z() - 1.0; }

// Closed form of fall and rebound with viscous drag: impacts at 0.33 s, 0.85 s ... The barrier of
// the stop ends a few millionths of a metre before it.
TEST(ExtrapolationChoice, GoesAroundAStopByOrderTwo) {
  const Model model =
      io::read_model_text(bouncing("{lower: -0.5, restitution: 0.8}"), "block.yaml");
  for (const double tolerance : {1e-4, 1e-6, 1e-8}) {
    const Simulation s = run(model, tolerance);
    EXPECT_NEAR(block_height(s), height_after(1.5, 0.5, 0.8), 10.0 * tolerance + 1e-5) << tolerance;
    EXPECT_EQ(s.summary().scheme, "orders 4 to 12 by extrapolation");
  }
}

// A stop that is not touched costs nothing.
TEST(ExtrapolationChoice, KeepsItsOrderWhereAStopIsNotTouched) {
  const auto far = [](const std::string& limits) {
    return run(io::read_model_text(bouncing(limits), "block.yaml"), 1e-9);
  };
  const Simulation stopped = far("{lower: -30}"), free = far("{lower: -1e6}");
  EXPECT_EQ(work(stopped), work(free));
  EXPECT_NEAR(block_height(stopped), height_after(1.5, 30.0, 0.0), 1e-9);
}

// A mass on a stiff spring that nothing damps, which hardly vibrates, beside a damped pendulum. A
// step that does not resolve the vibration makes it grow.
std::string stiff(const std::string& stiffness) {
  return R"yaml(
format: 1
gravity: [0, 0, -9.81]
bodies:
  bob: {mass: 1, inertia: [0.01, 0.01, 0.01], position: [0, 0, -1], angular_velocity: [0, 3, 0], velocity: [-3, 0, 0]}
  weight: {mass: 1, inertia: [0.01, 0.01, 0.01], position: [1, 0, -1], velocity: [0.01, 0, 0]}
joints:
  pin: {type: revolute, bodies: [ground, bob], at: [0, 0, 0], axis: y}
  rail: {type: prismatic, bodies: [ground, weight], at: [1, 0, -1], axis: x}
loads:
  oil: {type: torsional_spring, joint: pin, damping: 0.3}
  wire: {type: translational_spring, joint: rail, stiffness: )yaml" +
         stiffness + R"yaml(}
analysis: {duration: 4 s, tolerance: 1e-5}
)yaml";
}

TEST(ExtrapolationChoice, ClosesTheBalanceOfEnergyWhereAStiffSpringIsNotDamped) {
  Model alone = io::read_model_text(stiff("1e5"), "stiff.yaml");
  alone.loads.pop_back();
  const Simulation exact = run(std::move(alone), 1e-10);
  for (const char* stiffness : {"1e5", "1e6", "1e7"})
    for (const double tolerance : {1e-4, 1e-6}) {
      const Simulation s = run(io::read_model_text(stiff(stiffness), "stiff.yaml"), tolerance);
      EXPECT_TRUE(s.summary().trusted()) << stiffness << ", " << tolerance;
      EXPECT_LE(s.summary().energy_drift, 10.0 * tolerance) << stiffness;
      const auto bob = [](const Simulation& of) { return of.system().motion(of.state(), 0).r; };
      EXPECT_LT((bob(s) - bob(exact)).norm(), 10.0 * tolerance) << stiffness;
    }
  EXPECT_THAT(run(io::read_model_text(stiff("1e7"), "stiff.yaml"), 1e-4).summary().warnings,
              testing::Contains(HasSubstr("a vibration of body 'weight' on 'wire', which nothing "
                                          "damps")));
}

// Where limits keep steps short, steps of order 2 need less work; where they do not, far more.
TEST(ExtrapolationChoice, TakesTheSchemeOfLessWork) {
  const auto work_with = [](double max_step, double tolerance, std::optional<int> order) {
    Model model = soft_governor();
    model.analysis.max_step = max_step;
    model.analysis.order = order;
    model.analysis.duration = 1.0;
    return work(run(std::move(model), tolerance));
  };
  EXPECT_LT(work_with(1e-3, 1e-3, {}), 1.3 * static_cast<double>(work_with(1e-3, 1e-3, 2)));
  EXPECT_LT(work_with(1.0, 1e-6, {}), 0.2 * static_cast<double>(work_with(1.0, 1e-6, 2)));
}

// The governor's steps follow its tolerance: the error is at most five times as large.
TEST(ExtrapolationChoice, MeetsItsToleranceOnTheStiffGovernor) {
  const PublishedCase c = flyball_case();
  const Reference r = Reference::read(c.data);
  std::int64_t before = 0;
  for (const double tolerance : {1e-4, 1e-6, 1e-8}) {
    Model model = c.model;
    model.analysis.duration = c.duration;
    model.output.every.reset();
    const Simulation s = run(std::move(model), tolerance);
    EXPECT_LT(std::abs(c.observe(s)[0] - r.values.back()[0]), 5.0 * tolerance);
    EXPECT_GT(work(s), before);
    before = work(s);
  }
  EXPECT_LT(before, 40000);
}

// Events at times of frames: steps of some 1e-9 s are left between them, in which the work of
// drives is rounding.
TEST(ExtrapolationChoice, DoesNotJudgeStepsThatALimitCutsShortByTheirBalance) {
  const Simulation s =
      run(io::read_model(source_dir() + "/examples/geneva_drive/model.yaml"), 1e-6);
  EXPECT_EQ(s.summary().scheme, "orders 4 to 12 by extrapolation");
  EXPECT_THAT(s.summary().warnings, testing::IsEmpty());
}

TEST(ExtrapolationChoice, ContinuesARunFromItsStateWithTheSameBits) {
  for (const char* limits : {"{lower: -30}", "{lower: -0.5, restitution: 0.8}"}) {
    Model model = io::read_model_text(bouncing(limits), "block.yaml");
    Simulation once(model);
    std::vector<State> states{once.state()};
    while (once.time() < 1.5 && states.size() < 1000) {
      ASSERT_TRUE(once.step(1.5).accepted);
      states.push_back(once.state());
    }
    for (const std::size_t k : {states.size() / 3, states.size() / 2}) {
      Simulation rest(model, states[k]);
      while (rest.time() < 1.5) ASSERT_TRUE(rest.step(1.5).accepted);
      EXPECT_EQ(block_height(rest), block_height(once)) << limits;
      EXPECT_EQ(work(rest), work(once)) << limits;
    }
  }
}

// Without orders above 2, part by part.
TEST(ExtrapolationChoice, NamesWhatStandsAgainstAHigherOrder) {
  Model model = io::read_model_text(bouncing("{lower: -30}, friction: {mu: 0.2}"), "block.yaml");
  EXPECT_THAT(Simulation(std::move(model)).summary().narration,
              HasSubstr("Order 2 with automatic steps, for the tolerance of 1e-06: the joint "
                        "'rail' has dry friction which is not smooth"));
}

}  // namespace
}  // namespace polhode::test::extrapolation_choice_tests
