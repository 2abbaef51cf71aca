// SPDX-License-Identifier: Apache-2.0
// Gradients of runs with events, against closed forms and differences of such runs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include <gradient/frozen_runs.hpp>
#include <polhode/gradient/located_run.hpp>

namespace polhode::test::event_gradient_tests {
namespace {

double value_of_run(const Model& model, const std::string& channel) {
  Simulation simulation(model);
  SystemMap map;
  const System system = build_system(model, &map);
  const RunTape tape = run_onto_event_tape(simulation, map);
  return OutcomeReader(model, map, channel).value(simulation.system(), tape.ends.back());
}

/// The slope of runs has jumps of the order of the square of the step where an event moves past a
/// point of the grid: the differences must not. Short steps leave little room beside rounding.
double difference_from_event_runs(FrozenCase c, double h, std::int64_t events) {
  c.step = h;
  const GradientRequest request = c.request();
  const RunGradient run = differentiate(c.model(), request);
  EXPECT_EQ(run.events, events);
  const OutcomeGradient& g = run.outcomes.front();
  EXPECT_LT(g.spot_check, 1e-11);
  std::vector<double> of_runs;
  for (const GradientParameter& p : request.parameters)
    of_runs.push_back(sixth_order_difference(
        [&](double x) { return value_of_run(p.at(x), request.outcomes.front().channel); }, p.value,
        (h < 5e-3 ? 0.1 : 0.01) * h * size_of(p)));
  return largest_difference(g, request.parameters, of_runs);
}

// A ball thrown up, which the run follows to the ground: range and its derivatives in closed form.
/// @tests{located-step}
TEST(EventGradient, OfTheRangeOfAThrowIsThatOfTheClosedForm) {
  const std::string text = R"yaml(
format: 1
variables: {up: 4.0, along: 3.0, height: 1.2, low: 0.1, g: 9.81}
gravity: [0, 0, -g]
bodies:
  ball: {mass: 2, inertia: [1e-2, 1e-2, 1e-2], position: [0, 0, height], velocity: [along, 0, up]}
events:
  land: {when: {body: ball, channel: z, below: low}, stop: true}
)yaml";
  for (const double h : {0.1, 0.01, 1e-3}) {
    FrozenCase c{text, 3.0, {"up", "along", "height", "low", "g"}, "bodies.ball.position.x"};
    c.step = h;
    const RunGradient run = differentiate(c.model(), c.request());
    const double root = std::sqrt(16.0 + 2.0 * 9.81 * 1.1), T = (4.0 + root) / 9.81;
    EXPECT_EQ(run.events, 1);
    const OutcomeGradient& o = run.outcomes.front();
    EXPECT_NEAR(o.value, 3.0 * T, 1e-10);
    EXPECT_NEAR(o.by[0], 3.0 * (1.0 + 4.0 / root) / 9.81, 1e-8);
    EXPECT_NEAR(o.by[1], T, 1e-8);
    EXPECT_NEAR(o.by[2], 3.0 / root, 1e-8);
    EXPECT_NEAR(o.by[3], -3.0 / root, 1e-8);
    EXPECT_NEAR(o.by[4], 3.0 * (1.1 / root - T) / 9.81, 1e-8);
  }
}

// An arm that is turned by a spring, with a ball that it releases at an angle, and that lands.
/// @tests{located-step}
TEST(EventGradient, OfAThrowingArmIsThatOfItsRuns) {
  const FrozenCase c{R"yaml(
format: 1
variables: {k: 60.0, c: 0.3, let_go: 1.1, m: 0.4, L: 0.8, g: 9.81}
gravity: [0, 0, -g]
bodies:
  arm: {mass: 2, inertia: [0.01, 0.1, 0.1], position: [-L/2, 0, 1]}
  ball: {mass: m, inertia: [1e-3, 1e-3, 1e-3], position: [-L, 0, 0.9]}
joints:
  axle: {type: revolute, bodies: [ground, arm], at: [0, 0, 1], axis: y}
  sling: {type: distance, bodies: [arm, ball], at: [[-L, 0, 1], [-L, 0, 0.9]]}
loads:
  spring: {type: torsional_spring, joint: axle, stiffness: k, damping: c, free_angle: 2.0}
  wind: {type: force, body: ball, force: [0.5*sin(4*t), 0, 0]}
events:
  throw: {when: {joint: axle, channel: rz, above: let_go}, off: [sling]}
  land: {when: {body: ball, channel: z, below: 0.2}, after: throw, stop: true}
)yaml",
                     2.0,
                     {"k", "c", "let_go", "m", "L", "g", "bodies.arm.mass"},
                     "bodies.ball.position.x"};
  for (const double h : {0.02, 0.01, 2e-3})
    EXPECT_LT(difference_from_event_runs(c, h, 2), h < 5e-3 ? 1e-7 : 1e-8) << h;
}

std::string refusal(const std::string& event, const std::string& more = "") {
  const std::string text = R"yaml(
format: 1
gravity: [0, 0, -9.81]
bodies:
  ball: {mass: 2, inertia: [1e-2, 1e-2, 1e-2], position: [0, 0, 1]}
  other: {mass: 2, inertia: [1e-2, 1e-2, 1e-2], position: [1, 0, 1]}
joints:
  rod: {type: distance, bodies: [ball, other], at: [[0, 0, 1], [1, 0, 1]]}
events:
)yaml" + event + "\n" + more +
                           "analysis: {duration: 0.4, step: 10 ms}\n";
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

TEST(EventGradient, RefusesByNameWhatHasNoDerivative) {
  using testing::HasSubstr;
  EXPECT_EQ(refusal("  low: {when: {body: ball, channel: z, below: 0.5}, off: [rod]}"), "nothing");
  EXPECT_THAT(refusal("  low: {when: {joint: rod, channel: fx, above: 0.5}, off: [rod]}"),
              HasSubstr("events.low.when: watches 'fx', whose time has no derivative yet"));
  EXPECT_THAT(refusal("  low: {when: {body: ball, channel: az, below: -50}, off: [rod]}"),
              HasSubstr("events.low.when: watches 'az', whose time has no derivative yet"));
  EXPECT_THAT(refusal("  low: {when: {body: ball, channel: z, below: 0.5}, on: [rod]}"),
              HasSubstr("events.low.on: switches on, with a jump of velocities"));
  EXPECT_THAT(
      refusal("  low: {when: {body: ball, channel: z, below: 0.5}, repeat: true, off: [rod]}"),
      HasSubstr("events.low.repeat: makes it occur again"));
  EXPECT_THAT(refusal("  low: {when: {body: ball, channel: z, below: 0.5}, off: [rod]}\n"
                      "  too: {when: {body: other, channel: z, below: 0.5}, stop: true}"),
              HasSubstr("together with another one, where the derivative is one-sided"));
}

}  // namespace
}  // namespace polhode::test::event_gradient_tests
