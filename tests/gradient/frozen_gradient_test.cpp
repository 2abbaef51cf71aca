// SPDX-License-Identifier: Apache-2.0
// Gradients of automatic and of extrapolated steps against differences of runs with the same steps.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include <gradient/frozen_runs.hpp>

namespace polhode::test::frozen_gradient_tests {
namespace {

const std::string kDampedPendulum = std::string(kDoublePendulum) + R"yaml(
loads:
  twist: {type: torsional_spring, joint: B, stiffness: 0.5, damping: 0.05}
  strut: {type: spring_damper, bodies: [ground, two], at: [[0, 1, 0], [0.6, 0.3, 0]], stiffness: 20, damping: 1}
)yaml";

FrozenCase pendulum() {
  return {kDoublePendulum,
          0.5,
          {"a", "speed", "bodies.one.mass", "bodies.two.inertia.1", "joints.B.axis.0",
           "joints.B.at.1", "gravity.2"},
          "bodies.two.position.z"};
}

FrozenCase damped_pendulum() {
  FrozenCase c = pendulum();
  c.text = kDampedPendulum;
  for (const char* path : {"loads.twist.stiffness", "loads.twist.damping", "loads.strut.damping"})
    c.parameters.emplace_back(path);
  return c;
}

FrozenCase crank() {
  return {example_text("spatial_slider_crank", kSliderCrankLoads),
          0.4,
          {"loads.spring.stiffness", "loads.spring.damping", "loads.spring.free_length",
           "loads.twist.stiffness", "bodies.rod.mass", "variables.speed"},
          "bodies.slider.position.x"};
}

FrozenCase bricard() {
  return {example_text("bricard"),
          0.4,
          {"variables.L", "variables.w", "bodies.rod_1.mass"},
          "bodies.rod_3.position.x"};
}

FrozenCase drives() {
  return {kDrives, 0.4, {"w", "amp", "k", "bodies.three.mass", "ratio"}, "bodies.three.position.x"};
}

FrozenCase governor() {
  return {
      example_text("flyball_governor"),
      0.2,
      {"variables.m_ball", "variables.turn", "loads.spring_a.stiffness", "loads.spring_a.damping"},
      "bodies.slider.position.z"};
}

FrozenCase automatic(FrozenCase c, double tolerance, std::optional<int> order = {},
                     const std::string& solver = "automatic") {
  c.tolerance = tolerance;
  c.order = order;
  c.solver = solver;
  return c;
}

FrozenCase extrapolated(FrozenCase c, int order, double step) {
  c.step = step;
  c.order = order;
  c.method = "extrapolation";
  return c;
}

constexpr std::array kTolerances = {1e-4, 1e-6, 1e-9};

TEST(FrozenGradient, OfAutomaticStepsOfOrderTwoIsExact) {
  for (const double tolerance : {1e-4, 1e-5, 1e-7})
    EXPECT_LT(difference_from_frozen_runs(automatic(crank(), tolerance, 2)), 1e-9) << tolerance;
  for (const double rho : {1.0, 0.8}) {
    FrozenCase c = automatic(pendulum(), 1e-4, 2);
    c.rho_inf = rho;
    RunGradient run;
    EXPECT_LT(difference_from_frozen_runs(c, 3e-3, 1e-11, &run), 1e-9) << rho;
    EXPECT_EQ(run.order, 2);
    EXPECT_EQ(run.step, 0.0);
    EXPECT_NE(run.sequence.front().length, run.sequence.back().length);
  }
}

TEST(FrozenGradient, OfAutomaticCompositionsIsExact) {
  for (const int order : {6, 8})
    for (const double tolerance : kTolerances)
      EXPECT_LT(difference_from_frozen_runs(automatic(pendulum(), tolerance, order)), 1e-9)
          << order << " " << tolerance;
}

TEST(FrozenGradient, OfCompositionsAndExtrapolationOfARedundantLoopIsThatOfItsMotion) {
  // Newton's remainders of redundant rows limit differences of compositions here.
  const auto by = [](const std::string& method, const char* solver) {
    FrozenCase c = automatic(bricard(), 1e-9, {}, solver);
    c.method = method;
    return differentiate(c.model(), c.request()).outcomes.front().by;
  };
  const std::vector<double> extrapolated = by("extrapolation", "tree");
  for (const char* solver : {"tree", "block_lu"}) {
    const std::vector<double> composed = by("automatic", solver);
    for (std::size_t j = 0; j < 3; ++j)
      EXPECT_NEAR(composed[j] / extrapolated[j], 1.0, 1e-7) << solver;
  }
}

/// @tests{combination-derivative} @tests{projection-derivative}
TEST(FrozenGradient, OfExtrapolatedStepsIsExactAtEveryOrder) {
  for (const int order : {4, 6, 8})
    for (const double H : {0.1, 0.05, 0.01}) {
      EXPECT_LT(difference_from_frozen_runs(extrapolated(damped_pendulum(), order, H)), 1e-9)
          << order << " " << H;
      EXPECT_LT(difference_from_frozen_runs(extrapolated(crank(), order, H)), 1e-9)
          << order << " " << H;
    }
}

/// @tests{projection-derivative}
TEST(FrozenGradient, OfExtrapolatedLoopsAndDrivesIsExact) {
  for (const int order : {4, 6, 8})
    for (const double H : {0.1, 0.05, 0.01}) {
      // Effects of the governor's springs are 1e-10 of a length; remainders of redundant rows are
      // larger parts of short steps.
      EXPECT_LT(difference_from_frozen_runs(extrapolated(bricard(), order, H)),
                H > 0.02 ? 1e-9 : 2e-8)
          << order << " " << H;
      EXPECT_LT(difference_from_frozen_runs(extrapolated(drives(), order, H)), 3e-9)
          << order << " " << H;
      EXPECT_LT(difference_from_frozen_runs(extrapolated(governor(), order, 0.5 * H)), 3e-9)
          << order << " " << H;
    }
}

TEST(FrozenGradient, OfVariableOrderIsExactWithBothSolvers) {
  for (const double tolerance : kTolerances)
    for (const char* solver : {"tree", "block_lu"}) {
      RunGradient run;
      const auto difference = [&](const FrozenCase& c) {
        return difference_from_frozen_runs(automatic(c, tolerance, {}, solver), 3e-3, 1e-11, &run);
      };
      EXPECT_LT(difference(damped_pendulum()), 1e-9) << tolerance << " " << solver;
      int most = 0;
      for (const TakenStep& step : run.sequence) most = std::max(most, step.members);
      EXPECT_GT(2 * most, run.order);
      EXPECT_LT(difference(crank()), 1e-9) << tolerance << " " << solver;
      EXPECT_LT(difference(drives()), 5e-9) << tolerance << " " << solver;
      EXPECT_LT(difference(governor()), 5e-9) << tolerance << " " << solver;
    }
}

TEST(FrozenGradient, OfExtrapolatedRunsWithStepsOfOrderTwoIsExact) {
  FrozenCase c = automatic(damped_pendulum(), 1e-6);
  for (const StepSequence& sequence : {StepSequence{{0.1, 3}, {0.02, 1}, {0.03, 1}, {0.1, 2}},
                                       StepSequence{{0.01, 1}, {0.04, 4}, {0.05, 1}, {0.15, 2}}}) {
    RunGradient whole;
    whole.sequence = sequence;
    const GradientRequest request = c.request();
    const RunGradient run = differentiate_halves(c.model(), request, whole);
    EXPECT_EQ(run.order, 2);
    EXPECT_LT(run.outcomes.front().spot_check, 1e-12);
    for (std::size_t j = 0; j < request.parameters.size(); ++j) {
      const GradientParameter& p = request.parameters[j];
      const double d = 3e-3 * std::abs(p.value);
      const auto pair = [&](double k) {
        return frozen_value(p.at(p.value + k * d), halved(sequence), c.outcome) -
               frozen_value(p.at(p.value - k * d), halved(sequence), c.outcome);
      };
      const double of_runs = (45.0 * pair(1.0) - 9.0 * pair(2.0) + pair(3.0)) / (60.0 * d);
      EXPECT_NEAR(run.outcomes.front().by[j], of_runs, 1e-9 * std::max(1e-2, std::abs(of_runs)))
          << p.path;
    }
  }
}

TEST(FrozenGradient, OfAnUnresolvedVibrationHasStepsOfOrderTwoAndIsExact) {
  // A spring that nothing damps, of a period below the steps, beside a damped pendulum.
  FrozenCase c = automatic(damped_pendulum(), 1e-4);
  c.text +=
      R"yaml(  stiff: {type: spring_damper, bodies: [ground, bob], at: [[0, 3, 0], [0, 3, 0.5]], stiffness: 2e6, free_length: 0.5}
)yaml";
  const std::string bob =
      "bodies:\n  bob: {mass: 0.2, inertia: [1e-3, 1e-3, 1e-3], position: [0, 3, 0.5]}\n";
  c.text.replace(c.text.find("bodies:\n"), 8, bob);
  c.parameters = {"bodies.one.mass", "loads.strut.damping", "loads.stiff.stiffness"};
  RunGradient run;
  EXPECT_LT(difference_from_frozen_runs(c, 1e-3, 1e-10, &run), 1e-8);
  EXPECT_TRUE(std::any_of(run.sequence.begin(), run.sequence.end(),
                          [](const TakenStep& step) { return step.members == 1; }));
}

TEST(FrozenGradient, RunsAndReplaysEndAtTheSameState) {
  const FrozenCase c = automatic(crank(), 1e-6);
  Simulation simulation(c.model());
  const RunTape tape = run_onto_tape(simulation);
  const Simulation again(c.model());
  const State end = frozen_end(again, tape.sequence);
  const System& system = again.system();
  for (int b = 0; b < system.body_count(); ++b) {
    const BodyMotion m = system.motion(end, b), n = system.motion(tape.ends.back(), b);
    EXPECT_LT((m.r - n.r).norm() + (m.v - n.v).norm() + (m.W - n.W).norm(), 1e-10);
  }
  EXPECT_EQ(replay(again, tape.sequence).single_steps(), tape.single_steps());
  EXPECT_GT(tape.single_steps(), static_cast<std::int64_t>(tape.sequence.size()));
}

/// @tests{extrapolated-step}
TEST(ExtrapolatedStep, RemembersTheCoordinatesOfTheProjectedPositions) {
  for (const double H : {0.1, 0.02}) {
    Simulation simulation(extrapolated(damped_pendulum(), 4, H).model());
    for (int k = 0; k < 5; ++k) ASSERT_TRUE(simulation.step(1.0).accepted);
    const System& system = simulation.system();
    int found = 0;
    for (const InteractionRef& ref : system.interactions()) {
      if (system.group(ref.group).kind() != "torsional_spring") continue;
      ++found;
      EXPECT_NEAR(simulation.state().history[static_cast<std::size_t>(ref.first_history)],
                  simulation.joint("B").coordinates[0], 1e-14);
    }
    EXPECT_EQ(found, 1);
  }
}

TEST(FrozenGradient, OfTangentsIsThatOfTheAdjointInExtrapolatedSteps) {
  for (const double H : {0.1, 0.02}) {
    const FrozenCase c = extrapolated(crank(), 6, H);
    GradientRequest request = c.request();
    request.outcomes.push_back(parse_outcome("bodies.rod.velocity.x@0.2"));
    const RunGradient adjoint = differentiate(c.model(), request);
    request.forward = true;
    const RunGradient tangents = differentiate(c.model(), request);
    for (std::size_t k = 0; k < 2; ++k)
      for (std::size_t j = 0; j < request.parameters.size(); ++j)
        EXPECT_NEAR(tangents.outcomes[k].by[j], adjoint.outcomes[k].by[j],
                    1e-11 * std::abs(adjoint.outcomes[k].by[j]) + 1e-15);
  }
}

constexpr double kStiffness = 50.0, kDamping = 1.5, kMass = 2.0, kStart = 0.1;

/// A cart on a spring and a damper: x = x_0 e^(−δt) (cos ωt + δ/ω sin ωt).
FrozenCase swing(double tolerance) {
  return automatic({R"yaml(
format: 1
bodies:
  cart: {mass: 2, inertia: [1, 1, 1], position: [0.1, 0, 0]}
joints:
  guide: {type: prismatic, bodies: [ground, cart], at: [0, 0, 0], axis: x}
loads:
  spring: {type: translational_spring, joint: guide, stiffness: 50, damping: 1.5, free_displacement: -0.1}
analysis: {duration: 1.2 s}
)yaml",
                    1.2,
                    {"loads.spring.stiffness", "loads.spring.damping", "bodies.cart.mass"},
                    "bodies.cart.position.x@0.7"},
                   tolerance);
}

double swung(double k, double c, double m, double t) {
  const double delta = 0.5 * c / m, omega = std::sqrt(k / m - delta * delta);
  return kStart * std::exp(-delta * t) *
         (std::cos(omega * t) + delta / omega * std::sin(omega * t));
}

TEST(FrozenGradient, OfADampedSwingConvergesToItsClosedFormWithinTheErrorBar) {
  const double t = 0.7;
  // Derivative of the closed form, to 1e-12.
  const auto slope = [](const auto& f, double x) { return sixth_order_difference(f, x, 1e-3 * x); };
  const std::array expected = {
      slope([&](double k) { return swung(k, kDamping, kMass, t); }, kStiffness),
      slope([&](double c) { return swung(kStiffness, c, kMass, t); }, kDamping),
      slope([&](double m) { return swung(kStiffness, kDamping, m, t); }, kMass)};
  for (const std::optional<int> order : {std::optional<int>(), std::optional(2)})
    for (const double tolerance : {1e-4, 1e-6, 1e-8}) {
      FrozenCase c = swing(tolerance);
      c.order = order;
      const GradientRequest request = c.request();
      const RunGradient run = differentiate(c.model(), request);
      EXPECT_NEAR(run.outcomes[0].time, t, 1e-14);
      const std::vector<double> bars =
          error_bars(run, differentiate_halves(c.model(), request, run))[0];
      for (std::size_t j = 0; j < 3; ++j) {
        EXPECT_NEAR(run.outcomes[0].by[j], expected[j],
                    2.0 * bars[j] + 1e-10 * std::abs(expected[j]))
            << tolerance << " " << j;
        EXPECT_LT(bars[j], 1e3 * tolerance * std::abs(expected[j])) << tolerance << " " << j;
      }
    }
}

TEST(FrozenGradient, OfMeansAndMaximaIsTakenAtOutputTimes) {
  FrozenCase c = swing(1e-6);
  c.text += "output: {every: 20 ms}\n";
  GradientRequest request = c.request();
  request.outcomes = {parse_outcome("bodies.cart.position.x@mean"),
                      parse_outcome("bodies.cart.position.x@max")};
  const RunGradient run = differentiate(c.model(), request);
  EXPECT_GE(run.sequence.size(), 60u);
  for (const TakenStep& step : run.sequence) EXPECT_LT(step.length, 0.0201);
  double mean = 0.0;
  for (int k = 0; k < 12000; ++k)
    mean += swung(kStiffness, kDamping, kMass, 1e-4 * (k + 0.5)) / 12000.0;
  // The trapezoidal rule leaves h²/12 of the change of the rate over the run: 1e-5.
  EXPECT_NEAR(run.outcomes[0].value, mean, 2e-5);
  EXPECT_NEAR(run.outcomes[1].value, kStart, 1e-12);
}

}  // namespace
}  // namespace polhode::test::frozen_gradient_tests
