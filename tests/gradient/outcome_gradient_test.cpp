// SPDX-License-Identifier: Apache-2.0
// Gradients of velocities, means, integrals, extremes and misfits.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include <gradient/gradient_models.hpp>
#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/io/read/read_outcome.hpp>

namespace polhode::test::outcome_gradient_tests {
namespace {

using testing::HasSubstr;

/// @tests{projection-derivative}
TEST(OutcomeGradient, OfVelocitiesOfRedundantLoopsIsThatOfRuns) {
  for (const int order : {2, 6})
    for (const auto& [step, steps] : {std::pair(0.04, 5), std::pair(0.02, 10)})
      for (const char* outcome : {"bodies.rod_4.velocity.x", "bodies.rod_4.angular_velocity.z"}) {
        const GradientCase c{example_text("bricard"),
                             step,
                             steps,
                             {"variables.L", "variables.w", "bodies.rod_1.mass", "gravity.1"},
                             {outcome},
                             order};
        EXPECT_LT(difference_from_runs(c, 3e-3, 5e-11), order == 2 ? 2e-9 : 2e-8)
            << order << " " << step << " " << outcome;
      }
  EXPECT_LT(difference_from_runs({example_text("bricard"),
                                  2e-4,
                                  300,
                                  {"variables.L", "variables.w", "bodies.rod_1.mass", "gravity.1"},
                                  {"bodies.rod_4.velocity.x"}},
                                 3e-3, 1e-9),
            1e-7);  // round-off of 300 small steps
}

constexpr const char* kThrow = R"yaml(
format: 1
gravity: [0, 0, -9.81]
bodies:
  ball: {mass: 2, inertia: [0.1, 0.1, 0.1], position: [0, 0, 1], velocity: [3, 0, 4]}
analysis: {duration: 0.6 s, step: 10 ms}
)yaml";
const std::vector<std::string> kBy{"bodies.ball.velocity.2", "bodies.ball.position.2", "gravity.2"};

RunGradient gradient_of(const std::string& text, const Outcome& outcome,
                        const std::vector<std::string>& by, double step, bool forward = false) {
  const io::ModelText source{
      text, "model.yaml", "model.yaml", {"analysis.step=" + std::to_string(step)}};
  GradientRequest request{.parameters = {}, .outcomes = {outcome}, .forward = forward};
  for (const std::string& path : by)
    request.parameters.push_back(io::gradient_parameter(source, path));
  return differentiate(io::read_model_text(source.text, source.file, source.overrides), request);
}

TEST(OutcomeGradient, OfMeansIntegralsAndExtremesIsItsClosedForm) {
  // z = 1 + 4 t − 9.81 t²/2, by the trapezoidal rule: ∫t² has the error h² T/6.
  const double T = 0.6;
  for (const double h : {0.1, 0.01, 1e-4}) {
    const double of_g = T * T * T / 6.0 + h * h * T / 12.0;
    for (const bool forward : {false, true}) {
      const auto by = [&](const char* text) {
        return gradient_of(kThrow, parse_outcome(text), kBy, h, forward).outcomes.front();
      };
      const OutcomeGradient integral = by("bodies.ball.position.z@integral");
      EXPECT_EQ(integral.unit, "m s");
      EXPECT_NEAR(integral.value, T + 2.0 * T * T - 9.81 * of_g, 1e-9);
      EXPECT_NEAR(integral.by[0], T * T / 2.0, 1e-9);
      EXPECT_NEAR(integral.by[1], T, 1e-9);
      EXPECT_NEAR(integral.by[2], of_g, 1e-9);
      const OutcomeGradient mean = by("bodies.ball.position.z@mean");
      EXPECT_NEAR(mean.by[2], of_g / T, 1e-9);
      const OutcomeGradient way = by("bodies.ball.velocity.z@integral");
      EXPECT_EQ(way.unit, "m");
      EXPECT_NEAR(way.by[0], T, 1e-9);
      EXPECT_NEAR(way.by[2], T * T / 2.0, 1e-9);
      // The highest point on the grid is at its time; the lowest one is the last or the first.
      const OutcomeGradient top = by("bodies.ball.position.z@max");
      EXPECT_NEAR(top.time, 4.0 / 9.81, h);
      EXPECT_NEAR(top.by[2], 0.5 * top.time * top.time, 1e-9);
      const OutcomeGradient low = by("bodies.ball.position.z@min");
      EXPECT_EQ(low.time, 0.0);
      EXPECT_NEAR(low.by[1], 1.0, 1e-9);
      EXPECT_NEAR(low.by[0], 0.0, 1e-12);
    }
  }
}

TEST(OutcomeGradient, OfMeansUpToAnEventThatStopsHasItsTime) {
  // x = 3 t until z = 1/2, at T: the mean is 3 T/2, the integral 3 T²/2.
  std::string text = std::string(kThrow) +
                     "events:\n  lands: {when: {body: ball, channel: z, below: 0.5}, stop: true}\n";
  text.replace(text.find("0.6 s"), 5, "2 s");
  const double g = 9.81, v = 4.0, T = (v + std::sqrt(v * v + g)) / g;
  const double by_v = T / (g * T - v), by_z = 1.0 / (g * T - v), by_g = 0.5 * T * by_v;
  for (const double h : {0.1, 0.01, 1e-3}) {
    const auto by = [&](const char* what) {
      return gradient_of(text, parse_outcome(what), kBy, h).outcomes.front();
    };
    const OutcomeGradient mean = by("bodies.ball.position.x@mean");
    EXPECT_NEAR(mean.value, 1.5 * T, 1e-9);
    EXPECT_NEAR(mean.by[0], 1.5 * by_v, 1e-8);
    EXPECT_NEAR(mean.by[1], 1.5 * by_z, 1e-8);
    EXPECT_NEAR(mean.by[2], 1.5 * by_g, 1e-8);
    const OutcomeGradient integral = by("bodies.ball.position.x@integral");
    EXPECT_NEAR(integral.by[0], 3.0 * T * by_v, 1e-8);
    EXPECT_NEAR(integral.by[2], 3.0 * T * by_g, 1e-8);
  }
}

TEST(OutcomeGradient, OfMisfitsIsThatOfTheSumOfSquares) {
  const auto file = std::filesystem::temp_directory_path() /
                    format("polhode_misfit_{}.csv", reinterpret_cast<std::uintptr_t>(&kBy));
  std::ofstream(file) << "t [s],bodies.ball.position.z [m],bodies.ball.velocity.x [m/s]\n"
                         "# a remark\n0.1,1.4,3.1\n0.3,1.7,\n0.6,1.6,2.8\n";
  const Outcome misfit = io::read_outcome("misfit:" + file.string());
  ASSERT_EQ(misfit.measured.size(), 5U);
  double value = 0.1 * 0.1 + 0.2 * 0.2, by_v = 0.0, by_g = 0.0;
  for (const auto& [t, measured] :
       {std::pair(0.1, 1.4), std::pair(0.3, 1.7), std::pair(0.6, 1.6)}) {
    const double off = 1.0 + 4.0 * t - 0.5 * 9.81 * t * t - measured;
    value += off * off;
    by_v += 2.0 * off * t;
    by_g += off * t * t;
  }
  std::vector<std::string> parameters = kBy;
  parameters.emplace_back("bodies.ball.velocity.0");
  for (const double h : {0.1, 0.01, 1e-4})
    for (const bool forward : {false, true}) {
      const OutcomeGradient g =
          gradient_of(kThrow, misfit, parameters, h, forward).outcomes.front();
      EXPECT_NEAR(g.value, value, 1e-9);
      EXPECT_NEAR(g.by[0], by_v, 1e-9);
      EXPECT_NEAR(g.by[2], by_g, 1e-9);
      EXPECT_NEAR(g.by[3], 2.0 * (-0.1 + 0.2), 1e-9);
      EXPECT_LT(g.spot_check, h < 1e-3 ? 1e-9 : 1e-11);
    }
  std::filesystem::remove(file);
}

TEST(OutcomeGradient, OfTablesThatCannotBeReadIsRefusedByName) {
  const auto file = std::filesystem::temp_directory_path() /
                    format("polhode_table_{}.csv", reinterpret_cast<std::uintptr_t>(&kBy));
  const auto fault = [&](const std::string& table) -> std::string {
    std::ofstream(file) << table;
    try {
      (void)io::read_outcome("misfit:" + file.string());
    } catch (const InputError& error) {
      return error.what();
    }
    return "none";
  };
  EXPECT_THAT(fault("a,b\n1,2\n"), HasSubstr("no column is named 't [s]' or 'time'"));
  EXPECT_THAT(fault("t,b\n1\n"), HasSubstr(":2: has 1 cells, the header 2"));
  EXPECT_THAT(fault("t,b\n1,x\n"), HasSubstr(":2: 'x' is no number"));
  EXPECT_THAT(fault("t,b\n-1,2\n"), HasSubstr(":2: '-1' is no time"));
  EXPECT_THAT(fault("t,b\n"), HasSubstr("holds no measured values"));
  std::filesystem::remove(file);
}

// The assembly turns `one` with the place of `two`, and the gear begins there.
constexpr const char* kGearedLinkage = R"yaml(
format: 1
gravity: [0, 0, -9.81]
variables: {ratio: 2.5}
bodies:
  one: {mass: 1.2, inertia: [2e-2, 3e-2, 1e-2], position: [0.3, 0, 0]}
  two: {mass: 0.7, inertia: [1e-2, 2e-2, 1.5e-2], position: [0.6, 0.2, 0]}
  disc: {mass: 0.4, inertia: [1e-2, 2e-2, 1.5e-2], position: [0, 0, 1]}
joints:
  A: {type: revolute, bodies: [ground, one], at: [0, 0, 0], axis: [0, 1, 0.2]}
  B: {type: spherical, bodies: [one, two], at: [0.6, 0, 0]}
  D: {type: revolute, bodies: [ground, disc], at: [0, 0, 1], axis: z}
  E: {type: distance, bodies: [ground, two], at: [[0.6, 0.8, 0.2], [0.6, 0.3, 0]], distance: 0.57}
loads:
  gear: {type: gear, joints: [D, A], ratio: ratio}
analysis: {duration: 0.3 s, step: 10 ms}
)yaml";

TEST(RunGradient, ByWhatMovesTheStartOfAGearThroughTheAssemblyIsThatOfRuns) {
  for (const auto& [step, steps] : {std::pair(0.04, 6), std::pair(0.01, 24), std::pair(4e-4, 200)})
    for (const char* outcome : {"bodies.two.position.z", "bodies.disc.angular_velocity.z"})
      EXPECT_LT(difference_from_runs({kGearedLinkage,
                                      step,
                                      steps,
                                      {"bodies.two.position.2", "ratio", "bodies.two.mass"},
                                      {outcome}},
                                     1e-3),
                2e-8)
          << step << " " << outcome;
}

TEST(RunGradient, OfWhatHasNoEffectIsZeroWithoutDoubt) {
  const GradientCase c{example_text("planetary_gearbox"),
                       0.002,
                       25,
                       {"joints.pin_3.at.2"},
                       {"bodies.planet_1.position.z"}};
  const GradientRequest request = c.request();
  const RunGradient run = differentiate(c.model(), request);
  EXPECT_NEAR(run.outcomes.front().by[0], 0.0, 1e-15);
  EXPECT_TRUE(gradient_doubts(run, 0, request, {}).empty());
}

}  // namespace
}  // namespace polhode::test::outcome_gradient_tests
