// SPDX-License-Identifier: Apache-2.0
#include <functional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <gradient/gradient_runs.hpp>
#include <polhode/core/error.hpp>

namespace polhode::test::differentiable_tests {
namespace {

using testing::HasSubstr;

/// A pendulum with a slider; entries are added to joints, loads, analysis and the end.
struct Entries {
  std::string of_joint{}, loads{}, analysis{}, more{}, shape{};
};

std::string text_of(const Entries& e) {
  return R"yaml(format: 1
gravity: [0, 0, -9.81]
bodies:
  rod: {mass: 1, inertia: [1e-2, 1e-2, 1e-2], position: [0.5, 0, 0])yaml" +
         e.shape + R"yaml(}
joints:
  hinge: {type: revolute, bodies: [ground, rod], at: [0, 0, 0], axis: y)yaml" +
         e.of_joint + "}\n" + (e.loads.empty() ? "" : "loads:\n" + e.loads) + e.more +
         "analysis: {duration: 0.1 s" +
         (e.analysis.empty() ? std::string(", step: 10 ms") : ", " + e.analysis) + "}\n";
}

GradientRequest request_of(const std::string& text, const std::string& path,
                           const std::string& outcome) {
  const io::ModelText source{text, "model.yaml", "model.yaml", {}};
  GradientRequest r;
  r.parameters.push_back(io::gradient_parameter(source, path));
  r.outcomes.push_back(parse_outcome(outcome));
  return r;
}

std::string refusal(const std::function<void()>& act) {
  try {
    act();
  } catch (const std::exception& error) {
    return error.what();
  }
  return "nothing";
}

std::string refusal_of(const Entries& e, const std::string& path = "bodies.rod.mass",
                       const std::string& outcome = "bodies.rod.position.z@end") {
  const std::string text = text_of(e);
  return refusal([&] {
    (void)differentiate(io::read_model_text(text, "model.yaml"), request_of(text, path, outcome));
  });
}

TEST(RequireDifferentiable, AcceptsThePendulumOfTheseTests) {
  EXPECT_EQ(refusal_of({}), "nothing");
}

TEST(RequireDifferentiable, RefusesSettingsByName) {
  EXPECT_THAT(refusal_of({.analysis = "step: 10 ms, momentum_rate: kinematic"}),
              HasSubstr("analysis.momentum_rate: is kinematic"));
  EXPECT_THAT(refusal_of({.analysis = "step: 10 ms, jacobian: every_step"}),
              HasSubstr("analysis.jacobian: is every_step: its steps are not solved"));
  EXPECT_THAT(refusal_of({.analysis = "step: 10 ms, newton_tolerance: 1e-3"}),
              HasSubstr("analysis.newton_tolerance: is 0.001"));
  EXPECT_THAT(refusal([] {
                Model model = io::read_model_text(text_of({}), "model.yaml");
                model.analysis.type = "statics";
                (void)differentiate(
                    model, request_of(text_of({}), "bodies.rod.mass", "bodies.rod.position.z@end"));
              }),
              HasSubstr("analysis.type: is statics, but gradients are those of a motion"));
}

TEST(RequireDifferentiable, RefusesStopsFrictionAndSpringsOfJointsByName) {
  EXPECT_THAT(refusal_of({.of_joint = ", limits: {lower: -2, upper: 2}"}),
              HasSubstr("joints.hinge: has stops that act by forces: where an impact falls within "
                        "a step depends on the parameters"));
  EXPECT_THAT(refusal_of({.of_joint = ", friction: {mu: 0.1, radius: 0.01}"}),
              HasSubstr("joints.hinge: has dry friction, whose memory has no derivative yet"));
  EXPECT_THAT(
      refusal_of(
          {.of_joint = ", enforcement: {type: penalty, stiffness: 1e6, turning_stiffness: 1e4}"}),
      HasSubstr("joints.hinge: is held by springs, which have no derivative yet"));
  EXPECT_THAT(refusal_of({.of_joint = ", breaks: {force: 1e6}"}),
              HasSubstr("joints.hinge: may break, which is an event within a step"));
}

TEST(RequireDifferentiable, RefusesContactsEventsAndControllersByName) {
  EXPECT_THAT(
      refusal_of(
          {.more = "contacts: {default: {law: barrier}}\n", .shape = ", shape: {sphere: 0.1}"}),
      HasSubstr("contacts.default.law: is barrier, with which the gradient of a run whose steps "
                "are kept is a wrong number"));
  EXPECT_THAT(
      refusal_of(
          {.more = "events:\n  low: {when: {body: rod, channel: az, below: -0.4}, stop: true}\n"}),
      HasSubstr("events.low.when: watches 'az', whose time has no derivative yet"));
  EXPECT_THAT(
      refusal_of(
          {.loads = "  drive: {type: rotary_motor, joint: hinge, moment: {controller: hold}}\n",
           .more = "controllers:\n  hold: {joint: hinge, channel: rz, setpoint: 0, sample: 10 ms, "
                   "proportional: 3}\n"}),
      HasSubstr("controllers.hold: has a memory without derivative"));
}

TEST(RequireDifferentiable, RefusesLoadsWithMemoryByName) {
  EXPECT_THAT(
      refusal_of({.loads = "  hold: {type: rotary_servo, joint: hinge, angle: 0.1, stiffness: "
                           "5, integral: 2}\n"}),
      HasSubstr("loads.hold: is a servo with an integral or a limit"));
  EXPECT_THAT(refusal_of({.loads = "  brake: {type: torsional_spring, joint: hinge, damper_moment: "
                                   "2*sign(v)}\n"}),
              HasSubstr("has a law that jumps, at which there is no derivative"));
}

TEST(RequireDifferentiable, RefusesLoadsAlongBeamsByName) {
  EXPECT_THAT(
      refusal_of(
          {.loads = "  ring: {type: slide_on_beam, beam: rail, body: rod}\n",
           .more = "sections: {s: {type: general, EA: 1e4, GA_y: 4e3, GA_z: 4e3, GJ: 160, EI_y: "
                   "200, EI_z: 150, mass_per_length: 0.5, inertia_per_length: [0.01, 0.005, "
                   "0.005]}}\n"
                   "beams: {rail: {points: [[-0.5, 0, 0], [1.5, 0, 0]], elements: 4, section: s, "
                   "bonded: {ground: start}}}\n"}),
      HasSubstr("loads.ring: is of type slide_on_beam, which has no derivative yet"));
}

TEST(RequireDifferentiable, RefusesAForceThatIsNotSymmetricInTime) {
  // A law that falls acts by the side of t_n in the step that crosses it.
  EXPECT_THAT(refusal_of({.loads = "  brake: {type: torsional_spring, joint: hinge, damper_moment: "
                                   "'abs(v) < 1 ? 2*v : v'}\n"}),
              HasSubstr("bodies.rod: feels a force at t = 0.06 s that is not symmetric in time"));
}

TEST(RequireDifferentiable, RefusesBreaksOfFunctionsInDampedRuns) {
  const std::string push =
      "  push: {type: moment, body: rod, moment: [0, 't > 0.045 ? 1 : 0', 0]}\n";
  EXPECT_EQ(refusal_of({.loads = push}), "nothing");
  EXPECT_THAT(refusal_of({.loads = push, .analysis = "step: 10 ms, rho_inf: 0.8"}),
              HasSubstr("analysis.rho_inf: is 0.8, and at t = 0.045 s a function has a break: "
                        "accelerations begin anew there"));
}

TEST(RequireDifferentiable, RefusesARunWhoseStatesNeedTooMuchMemory) {
  EXPECT_THAT(refusal([] {
                Model model = io::read_model_text(text_of({}), "model.yaml");
                model.analysis.step = 1e-9;
                (void)differentiate(
                    model, request_of(text_of({}), "bodies.rod.mass", "bodies.rod.position.z@end"));
              }),
              HasSubstr("analysis.duration: is too long for a gradient: its states need"));
}

TEST(GradientDoubts, AreToldInAChaoticRunAndNotInAShortOne) {
  RunGradient own, half;
  own.order = half.order = 2;
  own.steps = 1000;
  own.outcomes = half.outcomes = {{.outcome = "z@end", .value = 1.0, .by = {2.0}, .growth = 1.0}};
  half.outcomes[0].by = {2.0 + 3e-4};
  GradientRequest request;
  request.parameters.push_back({.path = "p", .value = 1.0});
  // Of an error C h² the difference of h and h/2 is three quarters.
  EXPECT_NEAR(error_bars(own, half)[0][0], 4e-4, 1e-12);
  EXPECT_TRUE(gradient_doubts(own, 0, request, error_bars(own, half)[0]).empty());
  half.outcomes[0].by = {4.0};
  EXPECT_THAT(
      gradient_doubts(own, 0, request, error_bars(own, half)[0]),
      testing::ElementsAre(HasSubstr("the gradient of 'z@end' by p changes by more than 10 % "
                                     "with half the step")));
  own.outcomes[0].growth = 1e5;
  EXPECT_THAT(gradient_doubts(own, 0, request, {}),
              testing::ElementsAre(HasSubstr("has fewer than nine digits: perturbations grow by a "
                                             "factor of 1e+05")));
}

TEST(RequireDifferentiable, RefusesDrivesWhoseVelocityJumps) {
  EXPECT_THAT(
      refusal_of(
          {.loads = "  drive: {type: rotary_motor, joint: hinge, angle: 'max(0, t - 0.045)'}\n"}),
      HasSubstr("bodies.rod: has a velocity that jumps at t = "));
}

TEST(RequireDifferentiable, RefusesDrivesWhoseVelocityJumpsInAutomaticAndExtrapolatedSteps) {
  for (const char* analysis :
       {"tolerance: 1e-4, order: 2", "tolerance: 1e-7", "tolerance: 1e-6, method: extrapolation"})
    EXPECT_THAT(refusal_of({.loads = "  drive: {type: rotary_motor, joint: hinge, angle: "
                                     "'max(0, t - 0.045)'}\n",
                            .analysis = analysis}),
                HasSubstr("bodies.rod: has a velocity that jumps at t = "))
        << analysis;
}

TEST(RequireDifferentiable, RefusesEventsStopsAndContactsInAutomaticSteps) {
  const std::string automatic = "tolerance: 1e-6";
  EXPECT_THAT(refusal_of({.of_joint = ", limits: {lower: -2, upper: 2}", .analysis = automatic}),
              HasSubstr("joints.hinge: has stops that act by forces: where an impact falls"));
  Entries event{.analysis = automatic};
  event.more = "events:\n  low: {when: {body: rod, channel: z, below: -0.4}, stop: true}\n";
  EXPECT_THAT(refusal_of(event),
              HasSubstr("analysis.step: is missing: impacts and events are located within fixed"));
  Entries contact{.analysis = automatic, .more = "contacts: {}\n"};
  contact.shape = ", shape: {sphere: 0.1}";
  EXPECT_THAT(refusal_of(contact),
              HasSubstr("analysis.step: is missing: impacts and events are located within fixed"));
}

TEST(RequireDifferentiable, AcceptsAutomaticAndExtrapolatedSteps) {
  EXPECT_EQ(refusal_of({.analysis = "tolerance: 1e-6"}), "nothing");
  EXPECT_EQ(refusal_of({.analysis = "step: 10 ms, method: extrapolation, order: 4"}), "nothing");
}

TEST(GradientParameters, AreRefusedByNameIfTheyAreNoNumbers) {
  EXPECT_THAT(refusal_of({}, "bodies.rod.weight"),
              HasSubstr("bodies.rod.weight: is not in the model. Name a variable"));
  EXPECT_THAT(
      refusal_of({}, "bodes.rdo.mas"),
      HasSubstr("bodes.rdo.mas: is not in the model. Did you mean 'bodies.rod.mass'? Name a"));
  EXPECT_THAT(refusal_of({.more = "variables: {speed: 2}\n"}, "spede"),
              HasSubstr("spede: is not in the model. Did you mean 'speed'?"));
  EXPECT_THAT(refusal_of({}, "bodies.rod.position"),
              HasSubstr("bodies.rod.position: is a list, no number. Name one of its numbers"));
  EXPECT_THAT(refusal_of({}, "joints.hinge.type"),
              HasSubstr("joints.hinge.type: is the text 'revolute', no number"));
  EXPECT_THAT(refusal_of({.loads = "  push: {type: moment, body: rod, moment: [0, sin(3*t), 0]}\n"},
                         "loads.push.moment.1"),
              HasSubstr("loads.push.moment.1: is a function of time, 'sin(3*t)'"));
}

TEST(GradientParameters, AreRefusedIfTheyChangeMoreThanNumbers) {
  EXPECT_THAT(refusal_of({}, "analysis.step"),
              HasSubstr("analysis.step: is a setting of the run, by which there is no derivative"));
  GradientRequest request = request_of(text_of({}), "bodies.rod.mass", "bodies.rod.position.z");
  request.parameters[0].at = [](double value) {
    Model model = io::read_model_text(text_of({}), "model.yaml");
    model.analysis.duration = 0.1 * value;
    return model;
  };
  EXPECT_THAT(refusal([&] {
                (void)differentiate(io::read_model_text(text_of({}), "model.yaml"), request);
              }),
              HasSubstr("bodies.rod.mass: changes the duration of the run"));
  EXPECT_THAT(
      refusal_of(
          {.loads = "  push: {type: moment, body: rod, moment: [0, 't > begin ? 1 : 0', 0]}\n",
           .more = "variables: {begin: 0.045}\n"},
          "variables.begin"),
      HasSubstr("variables.begin: moves the time of a break of a function, t = 0.045"));
  EXPECT_THAT(
      refusal_of(
          {.more = "variables: {n: 4}\nbeams:\n  b: {points: [[0, 1, 0], [1, 1, 0]], elements: n, "
                   "section: s}\nsections:\n  s: {type: circle, diameter: 0.01, material: m}\n"
                   "materials:\n  m: {type: elastic, youngs_modulus: 1e9, poisson_ratio: "
                   "0.3, density: 1000}\n"},
          "variables.n"),
      HasSubstr("variables.n: has no derivative, as the model cannot start at"));
}

TEST(GradientParameters, AreRefusedIfTheyChangeTheCompiledModel) {
  const std::string text = text_of(
      {.more = "variables: {n: 4}\nbeams:\n  b: {points: [[0, 1, 0], [1, 1, 0]], elements: n, "
               "section: s}\nsections:\n  s: {type: circle, diameter: 0.01, material: m}\n"
               "materials:\n  m: {type: elastic, youngs_modulus: 1e9, poisson_ratio: 0.3, "
               "density: 1000}\n"});
  GradientRequest request = request_of(text, "variables.n", "bodies.rod.position.z@end");
  request.parameters[0].step = 1.0;
  EXPECT_THAT(
      refusal([&] { (void)differentiate(io::read_model_text(text, "model.yaml"), request); }),
      HasSubstr("variables.n: changes the number of bodies of the compiled model. Choose a "
                "parameter that changes numbers only"));
}

TEST(GradientParameters, AreRefusedIfALoopCannotFollowThem) {
  // A four-bar in space with parallel hinges: one axis tilted, it is a structure.
  const std::string text = R"yaml(format: 1
gravity: [0, 0, -9.81]
variables: {tilt: 0.001}
bodies:
  left: {mass: 1, inertia: [0.1, 0.1, 0.1], position: [0, 0, 0.5], velocity: [0.5, 0, 0], angular_velocity: [0, 1, 0]}
  bar: {mass: 1, inertia: [0.1, 0.1, 0.1], position: [0.5, 0, 1], velocity: [1, 0, 0]}
  right: {mass: 1, inertia: [0.1, 0.1, 0.1], position: [1, 0, 0.5], velocity: [0.5, 0, 0], angular_velocity: [0, 1, 0]}
joints:
  A: {type: revolute, bodies: [ground, left], at: [0, 0, 0], axis: y}
  B: {type: revolute, bodies: [left, bar], at: [0, 0, 1], axis: y}
  C: {type: revolute, bodies: [bar, right], at: [1, tilt - 0.001, 1], axis: y}
  D: {type: revolute, bodies: [ground, right], at: [1, 0, 0], axis: [tilt - 0.001, 1, 0]}
analysis: {duration: 0.1 s, step: 10 ms}
)yaml";
  EXPECT_THAT(refusal([&] {
                (void)differentiate(io::read_model_text(text, "model.yaml"),
                                    request_of(text, "tilt", "bodies.bar.position.x@end"));
              }),
              HasSubstr("tilt: has no derivative: the joints of a loop could not move along"));
}

TEST(GradientParameters, AndOutcomesMustBeGiven) {
  const Model model = io::read_model_text(text_of({}), "model.yaml");
  GradientRequest request = request_of(text_of({}), "bodies.rod.mass", "bodies.rod.position.z");
  request.parameters.clear();
  EXPECT_THAT(refusal([&] { (void)differentiate(model, request); }),
              HasSubstr("the parameters: are missing. Name paths of the model"));
  request.outcomes.clear();
  EXPECT_THAT(refusal([&] { (void)differentiate(model, request); }),
              HasSubstr("the outcome: is missing. Name a channel"));
}

TEST(Outcomes, AreRefusedByNameIfTheyAreNoPositionsOrVelocities) {
  EXPECT_THAT(refusal_of({}, "bodies.rod.mass", "joints.hinge.force.x@end"),
              HasSubstr("unknown joint 'hinge.force'"));
  EXPECT_THAT(refusal_of({}, "bodies.rod.mass", "bodies.rod.acceleration.z@end"),
              HasSubstr("the outcome: 'bodies.rod.acceleration.z' is not a position or velocity. "
                        "Name bodies.NAME.position.x"));
  EXPECT_THAT(refusal_of({}, "bodies.rod.mass", "bodies.rod.positon.z@end"),
              HasSubstr("'bodies.rod.positon.z' is not a position or velocity. Did you mean "
                        "'bodies.rod.position.z'?"));
  EXPECT_THAT(refusal_of({}, "bodies.rod.mass", "bodes.rdo.position.z@end"),
              HasSubstr("'bodes.rdo.position.z' is not a position or velocity. Did you mean "
                        "'bodies.rdo.position.z'?"));
  EXPECT_THAT(refusal_of({}, "bodies.rod.mass", "bodies.rdo.position.z@end"),
              HasSubstr("unknown body 'rdo'. Did you mean 'rod'?"));
  EXPECT_THAT(refusal_of({.loads = "", .shape = "}\n  wall: {fixed: true"}, "bodies.rod.mass",
                         "bodies.wall.position.x"),
              HasSubstr("is of a fixed body, which depends on nothing. Name a moving body"));
  EXPECT_THAT(refusal_of({}, "bodies.rod.mass", "joints.hinge.rx@end"),
              HasSubstr("the outcome: joint 'hinge' has no coordinate 'rx'. Its coordinates: rz"));
  EXPECT_THAT(refusal_of({}, "bodies.rod.mass", "bodies.rod.position.z@last"),
              HasSubstr("the outcome: 'bodies.rod.position.z@last' has an unknown time 'last'"));
  EXPECT_THAT(refusal_of({}, "bodies.rod.mass", "bodies.rod.position.z@0.033"),
              HasSubstr("is at 0.033 s, where no step ends. Name a multiple of analysis.step"));
  EXPECT_THAT(
      refusal_of({.analysis = "tolerance: 1e-6"}, "bodies.rod.mass", "bodies.rod.position.z@0.2"),
      HasSubstr("is at 0.2 s, where no step ends. Name a time within the run"));
  EXPECT_EQ(refusal_of({}, "bodies.rod.mass", "bodies.rod.velocity.z@mean"), "nothing");
}

}  // namespace
}  // namespace polhode::test::differentiable_tests
