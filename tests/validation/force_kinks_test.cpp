// SPDX-License-Identifier: Apache-2.0
// Automatic steps across kinks and jumps of forces, against closed forms of the motion, at
// tolerances from coarse to fine.
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <tuple>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <polhode/core/format.hpp>
#include <polhode/io/read/read_model.hpp>
#include <polhode/simulation/simulation.hpp>

namespace polhode::test::force_kinks_tests {
namespace {

constexpr double kGravity = 9.81;

/// A model with one coordinate, and its motion.
struct Known {
  std::string name;
  std::string model;
  std::string scheme;  ///< Part of its name.
  std::function<double(double)> exact;
  double regularised = 0.0;  ///< Effect of the bristle, which the exact law does not have [m].
};

/// A ball on a vertical rail.
std::string rail(const std::string& ball, const std::string& joint, const std::string& loads) {
  return format(
      "format: 1\ngravity: [0, 0, -9.81]\nbodies:\n  ball: {{mass: 2, inertia: [1, 1, 1]{}}}\n"
      "joints:\n  guide: {{type: prismatic, bodies: [ground, ball], at: [0, 0, 0], axis: z{}}}\n"
      "{}analysis: {{duration: 2 s}}\noutput: {{every: 50 ms}}\n",
      ball, joint, loads);
}

/// A ball on a rail without gravity.
std::string level(const std::string& ball, const std::string& loads,
                  const std::string& joint = "") {
  std::string text = rail(ball, joint, loads);
  return text.replace(text.find("-9.81"), 5, "0");
}

/// Thrown up at v against the resistance c v² and falling back: F = −m g − c |v| v.
double against_drag(double t, double v, double c, double m) {
  const double fastest = std::sqrt(m * kGravity / c), phi = std::atan(v / fastest);
  const double length = fastest * fastest / kGravity, rises = fastest * phi / kGravity;
  if (t < rises) return length * std::log(std::cos(phi - kGravity * t / fastest) / std::cos(phi));
  const double top = -length * std::log(std::cos(phi));
  return top - length * std::log(std::cosh(kGravity * (t - rises) / fastest));
}

/// To and fro at v between springs of frequency w that begin at ±a.
double with_free_play(double t, double v, double w, double a) {
  const double way = a / v, on = std::numbers::pi / w, half = 2.0 * way + on;
  const double s = std::fmod(t, 2.0 * half), sign = s < half ? 1.0 : -1.0, u = std::fmod(s, half);
  if (u < way) return sign * v * u;
  if (u < way + on) return sign * (a + v / w * std::sin(w * (u - way)));
  return sign * v * (half - u);
}

/// From rest at zero under the acceleration p up to a, and −q beyond: there and back.
double over_a_jump(double t, double p, double q, double a) {
  const double before = std::sqrt(2.0 * a / p), v = p * before, beyond = 2.0 * v / q;
  const double period = 2.0 * before + beyond, s = std::fmod(t, period);
  if (s < before) return 0.5 * p * s * s;
  const double u = s - before;
  if (u < beyond) return a + v * u - 0.5 * q * u * u;
  return 0.5 * p * (period - s) * (period - s);
}

/// Thrown up at v with a friction F that turns around at once.
double with_dry_friction(double t, double v, double F, double m) {
  const double up = kGravity + F / m, down = kGravity - F / m, rises = v / up;
  if (t < rises) return v * t - 0.5 * up * t * t;
  return 0.5 * v * rises - 0.5 * down * (t - rises) * (t - rises);
}

/// Pushed by 5 sin 3t against a dry friction of 3: at rest until it is passed, to a stop, and back.
double pushed_to_and_fro(double t, double m) {
  const auto speed = [&](double from, double to, double sign) {
    return (-5.0 / 3.0 * (std::cos(3.0 * to) - std::cos(3.0 * from)) - 3.0 * sign * (to - from)) /
           m;
  };
  const auto way = [&](double from, double to, double sign) {
    const double s = to - from;
    return (-5.0 / 9.0 * (std::sin(3.0 * to) - std::sin(3.0 * from)) +
            5.0 / 3.0 * std::cos(3.0 * from) * s - 1.5 * sign * s * s) /
           m;
  };
  const double breaks = std::asin(0.6) / 3.0, back = (std::numbers::pi + std::asin(0.6)) / 3.0;
  double rests = 1.0;  // root of the speed, by Newton's method
  for (int k = 0; k < 60; ++k)
    rests -= speed(breaks, rests, 1.0) * m / (5.0 * std::sin(3.0 * rests) - 3.0);
  if (t < breaks) return 0.0;
  if (t < rests) return way(breaks, t, 1.0);
  return way(breaks, rests, 1.0) + (t < back ? 0.0 : way(back, t, -1.0));
}

/// Lifted off a stop by the force 11 t.
double lifted(double t, double m) {
  const double s = t - m * kGravity / 11.0;
  return s < 0.0 ? 0.0 : 11.0 / (6.0 * m) * s * s * s;
}

/// Depth below the free length of a mass that falls from a height h above it into a cable with
/// stiffness k and damping c, which pulls only: N = max(0, k x + c ẋ) where it is longer.
double caught(double t, double h, double k, double c, double m) {
  const double decay = 0.5 * c / m, w = std::sqrt(k / m - decay * decay), rest = m * kGravity / k;
  double x = -h, v = 0.0, from = 0.0;
  for (;;) {
    // Free, until the cable is taut: x + v s + g s²/2 = 0, going down.
    const double free = (-v + std::sqrt(v * v - 2.0 * kGravity * x)) / kGravity, s = t - from;
    if (s < free) return x + v * s + 0.5 * kGravity * s * s;
    from += free;
    v += kGravity * free;
    const auto taut = [&](double u) {
      const double A = -rest, B = (v + decay * A) / w, e = std::exp(-decay * u);
      const double at = rest + e * (A * std::cos(w * u) + B * std::sin(w * u));
      const double rate =
          e * ((w * B - decay * A) * std::cos(w * u) - (w * A + decay * B) * std::sin(w * u));
      return std::pair(at, rate);
    };
    const auto pulls = [&](double u) { return k * taut(u).first + c * taut(u).second > 0.0; };
    double lasts = 0.0, step = 1e-3;
    while (lasts < 3.0 && pulls(lasts + step)) lasts += step;
    for (int halving = 0; halving < 50; ++halving)
      if (pulls(lasts + (step *= 0.5))) lasts += step;
    if (t - from < lasts || lasts > 2.9) return taut(t - from).first;
    std::tie(x, v) = taut(lasts);
    from += lasts;
  }
}

/// Drawn to a by a PD controller from a time on: m ẍ = P (a − x) − D ẋ.
double drawn(double t, double from, double a, double P, double D, double m) {
  const double s = t - from, decay = 0.5 * D / m, w = std::sqrt(P / m - decay * decay);
  if (s < 0.0) return 0.0;
  return a * (1.0 - std::exp(-decay * s) * (std::cos(w * s) + decay / w * std::sin(w * s)));
}

/// A table of the force of the free play of 0.1 m with springs of 50 N/m: of mass 2, w = 5/s.
const char* kPlay =
    "loads:\n  spring: {type: translational_spring, joint: guide, spring_force: {table: [[-3, "
    "-145], [-0.1, 0], [0.1, 0], [3, 145]]}}\n";

Known drawn_by(const std::string& name, const std::string& setpoint, const std::string& events) {
  return {
      name,
      level("", format("loads:\n  push: {{type: joint_force, joint: guide, force: {{controller: "
                       "hold}}}}\ncontrollers:\n  hold: {{joint: guide, channel: z, setpoint: "
                       "'{}', proportional: 800, derivative: 12}}\n{}",
                       setpoint, events)),
      "order 2", [](double t) { return drawn(t, 1.013, 0.1, 800.0, 12.0, 2.0); }};
}

std::vector<Known> known() {
  const std::string push = "loads:\n  push: {type: joint_force, joint: guide, force: 5*sin(3*t)}\n";
  const std::string thrown = ", velocity: [0, 0, 6]", slides = ", velocity: [0, 0, 0.7]";
  return {
      {"QuadraticDragWhereTheMotionTurnsBack",
       rail(thrown, "", "loads:\n  air: {type: drag, body: ball, quadratic: 0.4}\n"),
       "extrapolation", [](double t) { return against_drag(t, 6.0, 0.4, 2.0); }},
      {"QuadraticDragByComponents",
       rail(thrown, "",
            "loads:\n  air: {type: axis_drag, bodies: [ground, ball], at: [0, 0, 0], axis: z, "
            "quadratic: [0, 0, 0.4]}\n"),
       "extrapolation", [](double t) { return against_drag(t, 6.0, 0.4, 2.0); }},
      {"FreePlay", level(slides, kPlay), "composition",
       [](double t) { return with_free_play(t, 0.7, 5.0, 0.1); }},
      {"ALawThatJumps",
       level("",
             "loads:\n  law: {type: translational_spring, joint: guide, spring_force: 'x > "
             "0.3 ? 12 : -3'}\n"),
       "composition", [](double t) { return over_a_jump(t, 1.5, 6.0, 0.3); }},
      {"ALawThatJumpsUnderADrivingForce",
       level("",
             "loads:\n  law: {type: translational_spring, joint: guide, spring_force: 'x > "
             "0.3 ? 14 : -1'}\n  push: {type: joint_force, joint: guide, force: 2}\n"),
       "extrapolation", [](double t) { return over_a_jump(t, 1.5, 6.0, 0.3); }},
      {"DryFrictionOfASoftBristle", rail(thrown, ", friction: {force: 5, stiffness: 1e4}", ""),
       "order 2", [](double t) { return with_dry_friction(t, 6.0, 5.0, 2.0); }},
      {"ACableThatIsDamped",
       rail("", "",
            "cables:\n  rope: {through: [[ground, [0, 0, 2]], [ball, [0, 0, 0]]], "
            "stiffness: 7680, free_length: 2.4, damping: 60}\n"),
       "extrapolation", [](double t) { return -0.4 - caught(t, 0.4, 3200.0, 60.0, 2.0); }},
      {"ACableThatRunsOverItsPoints",
       rail("", "",
            "cables:\n  rope: {through: [[ground, [0, 0, 2]], [ball, [0, 0, 0]]], slides: "
            "true, stiffness: 7680, free_length: 2.4, damping: 60}\n"),
       "extrapolation", [](double t) { return -0.4 - caught(t, 0.4, 3200.0, 60.0, 2.0); }},
      {"DryFriction", rail(thrown, ", friction: {force: 5}", ""), "order 2",
       [](double t) { return with_dry_friction(t, 6.0, 5.0, 2.0); }},
      {"ALawOfDryFriction",
       rail(thrown, "",
            "loads:\n  rubs: {type: translational_spring, joint: guide, damper_force: "
            "'5*sign(v)'}\n"),
       "order 2", [](double t) { return with_dry_friction(t, 6.0, 5.0, 2.0); }},
      {"BreakingAwayFromALawOfDryFriction",
       level("", push + "  rubs: {type: translational_spring, joint: guide, damper_force: "
                        "'3*sign(v)'}\n"),
       "order 2", [](double t) { return pushed_to_and_fro(t, 2.0); }},
      {"BreakingAwayFromDryFriction", level("", push, ", friction: {force: 3}"), "order 2",
       [](double t) { return pushed_to_and_fro(t, 2.0); }, 5e-5},
      {"LiftingOffAStopThatIsARow",
       rail("", ", limits: {lower: 0}",
            "loads:\n  push: {type: joint_force, joint: guide, force: "
            "11*t}\ncontacts: {default: {law: rigid}}\n"),
       "order 2", [](double t) { return lifted(t, 2.0); }},
      {"LiftingOffAStopWithABand",
       rail("", ", limits: {lower: 0}",
            "loads:\n  push: {type: joint_force, joint: guide, force: 11*t}\n"),
       "extrapolation", [](double t) { return lifted(t, 2.0); }, 2e-4},
      drawn_by("AControllerWhoseSetpointJumps", "0.1*step(t, 1.013)", ""),
      drawn_by("AControllerThatIsSwitchedOn", "0.1",
               "events:\n  first: {at: 0, off: [hold]}\n  then: {at: 1.013, on: [hold]}\n"),
  };
}

class ForceKinks : public testing::TestWithParam<Known> {};

// @tests{force-kink}
// @tests{break-away}
// @tests{joint-friction-turn}
TEST_P(ForceKinks, CostNoMoreThanTheTolerance) {
  for (const double tolerance : {1e-4, 1e-6, 1e-8}) {
    Simulation simulation(io::read_model_text(GetParam().model, "kinks.yaml",
                                              {format("analysis.tolerance={:g}", tolerance)}));
    double error = 0.0;
    const RunSummary run = simulation.run([&](const Simulation& s) {
      error = std::max(error, std::abs(s.body("ball").r.z() - GetParam().exact(s.time())));
    });
    ASSERT_EQ(run.end, RunEnd::finished) << run.message;
    EXPECT_THAT(run.scheme, testing::HasSubstr(GetParam().scheme));
    EXPECT_LT(error, 5.0 * tolerance + GetParam().regularised)
        << tolerance << ", steps " << run.steps;
  }
}

INSTANTIATE_TEST_SUITE_P(Of, ForceKinks, testing::ValuesIn(known()),
                         [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace polhode::test::force_kinks_tests
