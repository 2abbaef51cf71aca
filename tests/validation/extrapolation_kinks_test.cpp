// SPDX-License-Identifier: Apache-2.0
// Extrapolated steps across kinks of forces, against closed forms of the motion.
#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <polhode/core/format.hpp>
#include <polhode/io/read/read_model.hpp>
#include <polhode/simulation/simulation.hpp>
#include <support/paths.hpp>

namespace polhode::test::extrapolation_kinks_tests {
namespace {

constexpr double kTolerances[] = {1e-4, 1e-6, 1e-8, 1e-10};

struct Reached {
  double error = 0.0;  ///< Largest over the frames.
  RunSummary summary;
};

/// Runs a model by extrapolation and compares a number at its output times.
template <class Number, class Exact>
Reached run(const std::string& text, double tolerance, const Number& number, const Exact& exact) {
  Model model =
      io::read_model_text(text, "kinks.yaml", {format("analysis.tolerance={:g}", tolerance)});
  Simulation simulation(model);
  Reached reached;
  reached.summary = simulation.run([&](const Simulation& s) {
    reached.error = std::max(reached.error, std::abs(number(s) - exact(s.time())));
  });
  EXPECT_EQ(reached.summary.end, RunEnd::finished) << reached.summary.message;
  EXPECT_TRUE(reached.summary.trusted());
  EXPECT_THAT(reached.summary.scheme, testing::HasSubstr("extrapolation"));
  return reached;
}

double height(const Simulation& s) { return s.body("ball").r.z(); }

/// Height of a mass that falls from a height onto a spring and rebounds without loss.
/// @param w  Frequency on the spring [rad/s].
double bounces(double t, double w, double h) {
  const double g = 9.81, fall = std::sqrt(2.0 * h / g), v = g * fall;
  // On the spring: z = −g/w² + A cos(w s + φ) from z = 0 and ż = −v, until z = 0 again.
  const double A = std::hypot(g / (w * w), v / w), phi = std::atan2(v / w, g / (w * w));
  const double on = 2.0 * (std::numbers::pi - phi) / w;
  const double period = 2.0 * fall + on;
  const double s = std::fmod(t + fall, period);  // from leaving the spring
  if (s < 2.0 * fall) return v * s - 0.5 * g * s * s;
  return -g / (w * w) + A * std::cos(w * (s - 2.0 * fall) + phi);
}

const char* kSpring =
    "format: 1\ngravity: [0, 0, -9.81]\nbodies:\n"
    "  ball: {mass: 2, inertia: [1, 1, 1], position: [0, 0, 0.4]}\n"
    "joints:\n  guide: {type: prismatic, bodies: [ground, ball], at: [0, 0, 0.4], axis: z}\n"
    "loads:\n  spring: {type: translational_spring, joint: guide, stiffness: 3200, "
    "free_displacement: -0.4, acts: compression}\n"
    "analysis: {duration: 3 s, method: extrapolation}\noutput: {every: 50 ms}\n";

TEST(ExtrapolationKinks, AMassBouncesOnASpringThatOnlyPushes) {
  std::int64_t iterations = 0;
  for (const double tolerance : kTolerances) {
    const Reached r =
        run(kSpring, tolerance, height, [](double t) { return bounces(t, 40.0, 0.4); });
    // Nine passages of the kink.
    EXPECT_LT(r.error, std::max(5.0 * tolerance, 1e-11)) << tolerance;
    EXPECT_LT(r.summary.energy_drift, std::max(5.0 * tolerance, 1e-11)) << tolerance;
    iterations = r.summary.newton_iterations;
  }
  // At order 2 an error of 1e-8 needs 3e5 iterations.
  EXPECT_LT(iterations, 100000);
}

TEST(ExtrapolationKinks, AMassHangsOnACableThatGoesSlack) {
  // Motion of the spring upside down: thrown up by the cable, falling into it.
  const std::string text =
      "format: 1\ngravity: [0, 0, 9.81]\nbodies:\n"
      "  ball: {mass: 2, inertia: [1, 1, 1], position: [0, 0, -0.4]}\n"
      "cables:\n  rope: {through: [[ground, [0, 0, -2]], [ball, [0, 0, 0]]], stiffness: 6400, "
      "free_length: 2}\n"
      "analysis: {duration: 3 s, method: extrapolation}\noutput: {every: 50 ms}\n";
  for (const double tolerance : kTolerances) {
    const Reached r = run(text, tolerance, height, [](double t) { return -bounces(t, 40.0, 0.4); });
    EXPECT_LT(r.error, std::max(5.0 * tolerance, 1e-11)) << tolerance;
  }
}

TEST(ExtrapolationKinks, AServoLeavesItsLimit) {
  // J ω' = min(c (ω₀ − ω), M).
  const double J = 0.5, c = 2.0, target = 3.0, M = 1.5;
  const double free = target - M / c, until = free * J / M;
  const auto angle = [&](double t) {
    if (t < until) return 0.5 * M / J * t * t;
    const double s = t - until, k = c / J;
    return 0.5 * free * until + target * s - (target - free) / k * (1.0 - std::exp(-k * s));
  };
  const std::string text =
      "format: 1\nbodies:\n  wheel: {mass: 1, inertia: [1, 1, 0.5]}\n"
      "joints:\n  axle: {type: revolute, bodies: [ground, wheel], at: [0, 0, 0], axis: z}\n"
      "loads:\n  servo: {type: rotary_servo, joint: axle, speed: 3, damping: 2, max_moment: 1.5}\n"
      "analysis: {duration: 2 s, method: extrapolation}\noutput: {every: 100 ms}\n";
  for (const double tolerance : kTolerances) {
    const Reached r = run(
        text, tolerance, [](const Simulation& s) { return s.joint("axle").coordinates[0]; }, angle);
    EXPECT_LT(r.error, 5.0 * tolerance) << tolerance;
    EXPECT_LT(r.summary.newton_iterations, 4000);
  }
}

TEST(ExtrapolationKinks, ATableOfAForceOverACoordinate) {
  // Force −k x up to a, then constant −k a: harmonic, then a parabola, until x = a again.
  const double k = 50.0, a = 0.1, m = 2.0, w = std::sqrt(k / m), v0 = 1.0;
  const double meets = std::asin(a * w / v0) / w, v = v0 * std::cos(w * meets), d = k * a / m;
  const auto exact = [&](double t) {
    if (t < meets) return v0 / w * std::sin(w * t);
    return a + v * (t - meets) - 0.5 * d * (t - meets) * (t - meets);
  };
  ASSERT_GT(2.0 * v / d + meets, 0.4);
  const std::string text =
      "format: 1\nbodies:\n  ball: {mass: 2, inertia: [1, 1, 1], velocity: [0, 0, 1]}\n"
      "joints:\n  guide: {type: prismatic, bodies: [ground, ball], at: [0, 0, 0], axis: z}\n"
      "loads:\n  spring: {type: translational_spring, joint: guide, spring_force: {table: [[-1, "
      "-50], "
      "[0, 0], [0.1, 5], [2, 5]]}}\n"
      "analysis: {duration: 0.4 s, method: extrapolation}\noutput: {every: 20 ms}\n";
  for (const double tolerance : kTolerances)
    EXPECT_LT(run(text, tolerance, height, exact).error, 5.0 * tolerance) << tolerance;
}

// Against order 2 with two short steps, whose errors of order two cancel.
TEST(ExtrapolationKinks, AnArmWithMusclesHasATenThousandthOfTheSteps) {
  const auto end_of = [](const io::Overrides& overrides, RunSummary* summary) {
    io::Overrides all = {"analysis.duration=0.5 s", "output.every=0.5 s"};
    all.insert(all.end(), overrides.begin(), overrides.end());
    Simulation simulation(
        io::read_model(source_dir() + "/examples/arm_with_muscles/model.yaml", all));
    const RunSummary run = simulation.run();
    if (summary) *summary = run;
    return simulation.body("forearm").r;
  };
  const Vec3 coarse = end_of({"analysis.step=0.4 ms"}, nullptr),
             fine = end_of({"analysis.step=0.2 ms"}, nullptr), exact = fine + (fine - coarse) / 3.0;
  for (const double tolerance : kTolerances) {
    RunSummary summary;
    const Vec3 end =
        end_of({"analysis.step=auto", format("analysis.tolerance={:g}", tolerance)}, &summary);
    EXPECT_THAT(summary.scheme, testing::HasSubstr("extrapolation"));
    EXPECT_LT((end - exact).norm(), std::max(tolerance, 1e-11)) << tolerance;
    EXPECT_LT(summary.steps, 50);
  }
}

}  // namespace
}  // namespace polhode::test::extrapolation_kinks_tests
