// SPDX-License-Identifier: Apache-2.0
// Gradients of runs whose impacts are located, against closed forms and differences of such runs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include <gradient/frozen_runs.hpp>
#include <polhode/core/format.hpp>
#include <polhode/gradient/located_run.hpp>

namespace polhode::test::located_gradient_tests {
namespace {

double located_value(const Model& model, const std::string& channel) {
  Simulation simulation(model);
  const RunTape tape = run_onto_located_tape(simulation);
  SystemMap map;
  const System system = build_system(model, &map);
  return OutcomeReader(model, map, channel).value(simulation.system(), tape.ends.back());
}

/// Relative difference of a gradient from sixth-order differences of located runs.
/// The slope of these has jumps of the order of the square of the step where an impact moves past a
/// point of the grid: the differences must not.
double difference_from_located_runs(const FrozenCase& c, std::int64_t impacts) {
  const double part = 0.1 * *c.step;
  const GradientRequest request = c.request();
  const RunGradient run = differentiate(c.model(), request);
  EXPECT_EQ(run.impacts, impacts);
  const OutcomeGradient& g = run.outcomes.front();
  EXPECT_LT(g.spot_check, 1e-11);
  const std::string& channel = request.outcomes.front().channel;
  std::vector<double> of_runs;
  for (const GradientParameter& p : request.parameters)
    of_runs.push_back(sixth_order_difference(
        [&](double x) { return located_value(p.at(x), channel); }, p.value, part * size_of(p)));
  return largest_difference(g, request.parameters, of_runs);
}

/// Tolerance on these differences, which are taken over a ten-thousandth at steps of a millisecond.
double bound(double h) { return h < 5e-3 ? 5e-8 : 1e-8; }

FrozenCase with_step(FrozenCase c, double step) {
  c.step = step;
  return c;
}

// A ball that bounces on a floor: parabolas between impacts, which the midpoint rule follows
// exactly.
const std::string kBall = R"yaml(
format: 1
variables: {height: 0.8, e: 0.7, g: 9.81, push: 0.5}
gravity: [0, 0, -g]
bodies:
  floor: {fixed: true, shape: {plane: z}}
  ball: {shape: {sphere: 0.2}, mass: 2, position: [0, 0, height], velocity: [1, 0, push]}
contacts: {default: {law: rigid, restitution: e}}
)yaml";

/// Height and speed of the ball's centre at a time, and the number of impacts so far.
std::array<double, 3> bouncing(double height, double e, double g, double push, double T) {
  const double R = 0.1;
  double z = height - R, v = push, t = 0.0, bounces = 0.0;
  for (;;) {
    const double flight = (v + std::sqrt(v * v + 2.0 * g * z)) / g;
    if (t + flight > T) break;
    t += flight;
    v = -e * (v - g * flight);
    z = 0.0;
    ++bounces;
  }
  const double left = T - t;
  return {R + z + v * left - 0.5 * g * left * left, v - g * left, bounces};
}

/// @tests{located-step} @tests{impact-derivative}
TEST(LocatedGradient, OfABouncingBallIsThatOfTheClosedForm) {
  const double T = 1.7, height = 0.8, e = 0.7, g = 9.81, push = 0.5;
  for (const double h : {0.1, 0.01, 1e-4}) {
    for (const int what : {0, 1}) {
      FrozenCase c{kBall, T, {"height", "e", "g", "push"}, ""};
      c.outcome = what == 0 ? "bodies.ball.position.z" : "bodies.ball.velocity.z";
      const auto of = [&](double dh, double de, double dg, double dp) {
        return bouncing(height + dh, e + de, g + dg, push + dp, T)[static_cast<std::size_t>(what)];
      };
      for (const bool forward : {false, true}) {
        const FrozenCase own = with_step(c, h);
        GradientRequest request = own.request();
        request.forward = forward;
        const RunGradient run = differentiate(own.model(), request);
        EXPECT_EQ(run.impacts, 4);
        EXPECT_EQ(static_cast<double>(run.impacts), bouncing(height, e, g, push, T)[2]);
        const OutcomeGradient& o = run.outcomes.front();
        EXPECT_NEAR(o.value, of(0, 0, 0, 0), 1e-9);
        // In 17,000 steps the rounding of dr acts as an acceleration of 1e-16/h² does.
        EXPECT_LT(o.spot_check, h < 1e-3 ? 1e-9 : 1e-11);
        const double d = 1e-3;
        const std::array<double, 4> exact = {
            sixth_order_difference([&](double x) { return of(x, 0, 0, 0); }, 0.0, d),
            sixth_order_difference([&](double x) { return of(0, x, 0, 0); }, 0.0, d),
            sixth_order_difference([&](double x) { return of(0, 0, x, 0); }, 0.0, d),
            sixth_order_difference([&](double x) { return of(0, 0, 0, x); }, 0.0, d)};
        for (std::size_t j = 0; j < exact.size(); ++j)
          EXPECT_NEAR(o.by[j] / exact[j], 1.0, h < 1e-3 ? 1e-6 : 1e-8)
              << h << " " << what << " " << j;
      }
    }
  }
}

// Two balls on a line: velocities behind an impact by both masses, places by the time of it.
/// @tests{impact-derivative}
TEST(LocatedGradient, OfTwoBallsIsThatOfTheClosedForm) {
  const std::string text = R"yaml(
format: 1
variables: {m: 1.3, M: 2.9, gap: 0.31, v: 1.7, w: -0.6, e: 0.6, R: 0.05}
bodies:
  left: {shape: {sphere: 2*R}, mass: m, position: [-R, 0, 0], velocity: [v, 0, 0]}
  right: {shape: {sphere: 2*R}, mass: M, position: [R + gap, 0, 0], velocity: [w, 0, 0]}
contacts: {default: {law: rigid, restitution: e}}
)yaml";
  const double T = 0.4;
  const auto place = [&](std::array<double, 7> p) {
    const auto [m, M, gap, v, w, e, R] = p;
    const double t = gap / (v - w);
    return R + gap + w * t + (w + m * (1.0 + e) * (v - w) / (m + M)) * (T - t);
  };
  const std::array<double, 7> at = {1.3, 2.9, 0.31, 1.7, -0.6, 0.6, 0.05};
  for (const double h : {0.05, 0.01, 1e-4}) {
    const FrozenCase c =
        with_step({text, T, {"m", "M", "gap", "v", "w", "e", "R"}, "bodies.right.position.x"}, h);
    const RunGradient run = differentiate(c.model(), c.request());
    EXPECT_EQ(run.impacts, 1);
    EXPECT_NEAR(run.outcomes.front().value, place(at), 1e-10);
    for (std::size_t j = 0; j < at.size(); ++j) {
      const auto moved = [&](double x) {
        std::array<double, 7> p = at;
        p[j] = x;
        return place(p);
      };
      const double exact = sixth_order_difference(moved, at[j], 1e-3 * std::abs(at[j]));
      EXPECT_NEAR(run.outcomes.front().by[j], exact,
                  (h < 1e-3 ? 1e-7 : 1e-8) * std::max(1.0, std::abs(exact)))
          << h << " " << j;
    }
  }
}

// A pendulum against a wall, and one against the stop of its own joint.
FrozenCase pendulum_and_wall() {
  return {R"yaml(
format: 1
variables: {L: 0.6, x: 0.25, speed: 1.1, wall: -0.05, e: 0.6, g: 9.81, m: 1.2}
gravity: [0, 0, -g]
bodies:
  wall: {fixed: true, shape: {plane: x}, position: [wall, 0, 0]}
  bob: {shape: {sphere: 0.1}, mass: m, position: [x, 0, -sqrt(L^2 - x^2)], angular_velocity: [0, speed, 0]}
joints:
  hinge: {type: revolute, bodies: [ground, bob], at: [0, 0, 0], axis: y}
contacts: {default: {law: rigid, restitution: e}}
)yaml",
          1.3,
          {"L", "x", "speed", "wall", "e", "g"},
          "bodies.bob.position.x"};
}

FrozenCase pendulum_and_stop() {
  return {R"yaml(
format: 1
variables: {x: 0.25, speed: 1.2, stop: 0.3, e: 0.6, g: 9.81, c: 0.2, k: 3.0}
gravity: [0, 0, -g]
bodies:
  upper: {mass: 1, inertia: [1e-2, 2e-2, 1e-2], position: [0, 0, -0.3], angular_velocity: [0, speed, 0], velocity: [-0.3*speed, 0, 0]}
  lower: {mass: 0.7, inertia: [1e-2, 1e-2, 1e-2], position: [x, 0, -0.8]}
joints:
  A: {type: revolute, bodies: [ground, upper], at: [0, 0, 0], axis: y}
  B: {type: revolute, bodies: [upper, lower], at: [0, 0, -0.6], axis: y, limits: {lower: -stop, upper: stop, restitution: e}}
loads:
  twist: {type: torsional_spring, joint: A, stiffness: k, damping: c}
  wind: {type: force, body: lower, at: [0.1, 0, -0.9], force: [2*sin(5*t + x), 0, 0]}
contacts: {default: {law: rigid}}
)yaml",
          0.4,
          {"x", "speed", "stop", "e", "g", "c", "k", "bodies.upper.mass", "bodies.lower.inertia.1"},
          "bodies.lower.position.x"};
}

// A four-bar of which one joint has a stop: an impulse goes around the loop.
FrozenCase loop_and_stop() {
  return {R"yaml(
format: 1
variables: {speed: 3.0, stop: 0.5, e: 0.5, g: 9.81}
gravity: [0, 0, -g]
bodies:
  left: {mass: 1, inertia: [0.1, 0.12, 0.1], position: [0, 0, 0.5], velocity: [0.5*speed, 0, 0], angular_velocity: [0, speed, 0]}
  bar: {mass: 1.5, inertia: [0.1, 0.15, 0.1], position: [0.6, 0, 1.1], velocity: [speed, 0, 0]}
  right: {mass: 0.8, inertia: [0.1, 0.1, 0.1], position: [1.2, 0, 0.6]}
joints:
  A: {type: revolute, bodies: [ground, left], at: [0, 0, 0], axis: y, limits: {lower: -1, upper: stop, restitution: e}}
  B: {type: revolute, bodies: [left, bar], at: [0, 0, 1], axis: y}
  C: {type: revolute, bodies: [bar, right], at: [1.2, 0, 1.2], axis: y}
  D: {type: revolute, bodies: [ground, right], at: [1.2, 0, 0], axis: y}
contacts: {default: {law: rigid}}
)yaml",
          0.5,
          {"speed", "stop", "e", "g", "bodies.left.mass", "bodies.bar.inertia.1"},
          "bodies.bar.position.x"};
}

/// @tests{located-step}
TEST(LocatedGradient, OfAPendulumAndAWallIsThatOfItsRuns) {
  for (const double h : {0.05, 0.01, 1e-3})
    EXPECT_LT(difference_from_located_runs(with_step(pendulum_and_wall(), h), 2), bound(h)) << h;
}

/// @tests{located-step}
TEST(LocatedGradient, OfStopsOfJointsIsThatOfTheirRuns) {
  for (const double h : {0.03, 0.01, 1e-3})
    EXPECT_LT(difference_from_located_runs(with_step(pendulum_and_stop(), h), 2), bound(h)) << h;
}

/// @tests{impact-derivative}
TEST(LocatedGradient, OfAStopInALoopIsThatOfItsRuns) {
  for (const double h : {0.02, 0.01, 1e-3})
    EXPECT_LT(difference_from_located_runs(with_step(loop_and_stop(), h), 1), bound(h)) << h;
}

/// Message of a gradient of a model with a floor that is refused.
std::string refusal(const std::string& bodies, const std::string& more,
                    const std::string& analysis = "duration: 1, step: 10 ms") {
  const std::string text = format(R"yaml(
format: 1
variables: {{p: 1.0}}
gravity: [0, 0, -9.81]
bodies:
  floor: {{fixed: true, shape: {{plane: z}}}}
{}
{}
analysis: {{{}}}
)yaml",
                                  bodies, more, analysis);
  try {
    GradientRequest request;
    const io::ModelText source{text, "model.yaml", "model.yaml", {}};
    request.parameters.push_back(io::gradient_parameter(source, "gravity.2"));
    request.outcomes.push_back(parse_outcome("bodies.ball.position.z@end"));
    (void)differentiate(io::read_model_text(text, "model.yaml"), request);
  } catch (const std::exception& error) {
    return error.what();
  }
  return "nothing";
}

TEST(LocatedGradient, RefusesByNameWhatHasNoDerivative) {
  using testing::HasSubstr;
  const std::string ball =
      "  ball: {shape: {sphere: 0.2}, mass: 1, position: [0, 0, 0.4], velocity: [1, 0, 0]}";
  const auto law = [](const std::string& of) {
    return format("contacts: {{default: {{law: rigid{}}}}}", of);
  };
  EXPECT_EQ(refusal(ball, law(", restitution: 0.9")), "nothing");
  EXPECT_THAT(refusal(ball, law("")),
              HasSubstr("the contact of body 'ball' and the ground: stays closed from t = "));
  EXPECT_THAT(refusal(ball, law(", restitution: 0.9, friction: 0.1")),
              HasSubstr("the contact of body 'ball' and the ground: has friction, and closes at"));
  EXPECT_THAT(refusal("  ball: {shape: {sphere: 0.2}, mass: 1, position: [0, 0, 0.2]}",
                      law(", restitution: 0.8"), "duration: 2, step: 10 ms"),
              HasSubstr("contacts: close more than 20 times within the step before t = "));
  EXPECT_THAT(refusal(ball, law(", restitution: 0.9"), "duration: 1, tolerance: 1e-6"),
              HasSubstr("analysis.step: is missing: impacts and events are located within fixed "
                        "steps"));
  EXPECT_THAT(
      refusal("  ball: {shape: {sphere: 0.2}, mass: 1, position: [0, 0, 0.1]}", law("")),
      HasSubstr("the contact of body 'ball' and the ground: is closed at t = 0 s: one that lasts "
                "has no derivative yet"));
  EXPECT_THAT(
      refusal("  ball: {shape: {box: [0.2, 0.2, 0.2]}, mass: 1, position: [0, 0, 0.4]}",
              law(", restitution: 0.5")),
      HasSubstr("together with the contact of body 'ball' and the ground: which of both is first "
                "depends on the parameters"));
  EXPECT_THAT(refusal(ball + "\n  other: {shape: {sphere: 0.2}, mass: 1, position: [0, 2, 0.4]}",
                      law(", restitution: 0.5")),
              HasSubstr("together with the contact of body 'other' and the ground"));
  EXPECT_THAT(refusal("  ball: {shape: {sphere: 0.2}, mass: 1, position: [0, 0, 0.4]}",
                      "loads:\n  push: {type: force, body: ball, force: [0, 0, 't > 0.1 ? 1 : "
                      "0']}\n" +
                          law(", restitution: 0.9")),
              HasSubstr("loads: have a function with a break at t = 0.1 s"));
  const std::string stop =
      "  ball: {shape: {sphere: 0.2}, mass: 1, position: [0, 0, 0.4]}\njoints:\n  slide: {type: "
      "prismatic, bodies: [ground, ball], at: [0, 0, 0.4], axis: z, limits: {lower: -0.1, "
      "restitution: 0.9}}\n";
  EXPECT_EQ(refusal(stop, law("")), "nothing");
  EXPECT_THAT(
      refusal(stop, "loads:\n  drive: {type: linear_motor, joint: slide, speed: 0.1}\n" + law("")),
      HasSubstr("loads.drive: prescribes a speed, whose integral together with impacts"));
  EXPECT_THAT(refusal(stop, ""), HasSubstr("joints.slide: has stops that act by forces"));
}

TEST(LocatedGradient, RefusesABodyThatOnlyGrazes) {
  // The ball passes over the peg, which it touches at the end of the 50th step.
  const std::string text = R"yaml(
format: 1
variables: {low: 0.2}
bodies:
  peg: {fixed: true, shape: {sphere: 0.2}, position: [0.5, 0, 0]}
  ball: {shape: {sphere: 0.2}, mass: 1, position: [0, 0, low], velocity: [1, 0, 0]}
contacts: {default: {law: rigid, restitution: 0.5}}
analysis: {duration: 1, step: 10 ms}
)yaml";
  for (const auto& [low, message] :
       {std::pair("0.21", "nothing"),
        std::pair("0.19999999999999",
                  "the contact of the ground and body 'ball': only grazes at t = 0.5 s")}) {
    GradientRequest request;
    const io::ModelText source{
        text, "model.yaml", "model.yaml", {std::string("variables.low=") + low}};
    request.parameters.push_back(io::gradient_parameter(source, "bodies.ball.velocity.0"));
    request.outcomes.push_back(parse_outcome("bodies.ball.position.z@end"));
    std::string said = "nothing";
    try {
      (void)differentiate(io::read_model_text(source.text, source.file, source.overrides), request);
    } catch (const std::exception& error) {
      said = error.what();
    }
    EXPECT_THAT(said, testing::HasSubstr(message));
  }
}

}  // namespace
}  // namespace polhode::test::located_gradient_tests
