// SPDX-License-Identifier: Apache-2.0
// Models whose gradients are compared with differences of runs, at rho_inf = 1 and below.
#pragma once

#include <string>

#include <gradient/gradient_runs.hpp>
#include <polhode/io/text/file_error.hpp>
#include <support/paths.hpp>

namespace polhode::test {

/// An example of the program, with more loads.
inline std::string example_text(const std::string& name, const std::string& more = "") {
  return io::read_file(source_dir() + "/examples/" + name + "/model.yaml") + more;
}

inline constexpr const char* kDoublePendulum = R"yaml(
format: 1
gravity: [0, 0, -9.81]
variables: {a: 0.3 m, speed: 2 rad/s}
bodies:
  one: {mass: 1.2, inertia: [2e-2, 3e-2, 1e-2], position: [a, 0, 0], angular_velocity: [0, speed, 0.5]}
  two: {mass: 0.7, inertia: [1e-2, 2e-2, 1.5e-2], position: [0.6, 0.2, 0]}
joints:
  A: {type: spherical, bodies: [ground, one], at: [0, 0, 0]}
  B: {type: revolute, bodies: [one, two], at: [0.6, 0.01, 0], axis: [0.3, 0.1, 1]}
analysis: {duration: 1 s, step: 10 ms}
output:
  probes:
    tip: {body: two, point: [0.1, 0.3, 0]}
)yaml";

/// Two bodies on a ball and a skew hinge.
inline GradientCase double_pendulum(double step, int steps, int order = 2) {
  return {kDoublePendulum,
          step,
          steps,
          {"a", "speed", "bodies.one.mass", "bodies.two.inertia.1", "joints.B.axis.0",
           "joints.B.at.1", "gravity.2"},
          {"bodies.two.position.z@end"},
          order};
}

/// Loads of the spatial slider-crank.
inline constexpr const char* kSliderCrankLoads = R"yaml(
loads:
  spring: {type: spring_damper, bodies: [ground, slider], at: [[-0.2, 0.05, 0], [0.2, 0, 0]], stiffness: 40, damping: 3, free_length: 0.3}
  twist: {type: torsional_spring, joint: A, stiffness: 0.2, damping: 0.01, free_angle: 0.3}
  drive: {type: moment, body: crank, moment: [0.1*sin(20*t), 0, 0]}
)yaml";

/// Motors of angle and speed, a servo and a gear.
inline constexpr const char* kDrives = R"yaml(
format: 1
gravity: [0, 0, -9.81]
variables: {w: 3 rad/s, amp: 0.3, k: 25, ratio: 2.5}
bodies:
  one: {mass: 1.2, inertia: [2e-2, 3e-2, 1e-2], position: [0.3, 0, 0]}
  two: {mass: 0.7, inertia: [1e-2, 2e-2, 1.5e-2], position: [0.6, 0.2, 0]}
  three: {mass: 0.4, inertia: [1e-2, 2e-2, 1.5e-2], position: [0.6, 0.5, 0.1]}
  disc: {mass: 0.4, inertia: [1e-2, 2e-2, 1.5e-2], position: [0, 0, 1]}
joints:
  A: {type: revolute, bodies: [ground, one], at: [0, 0, 0], axis: [0, 1, 0.2]}
  B: {type: revolute, bodies: [one, two], at: [0.6, 0, 0], axis: [0.3, 0.1, 1]}
  C: {type: prismatic, bodies: [two, three], at: [0.6, 0.5, 0.1], axis: [0, 1, 0.3]}
  D: {type: revolute, bodies: [ground, disc], at: [0, 0, 1], axis: z}
loads:
  drive: {type: rotary_motor, joint: A, angle: amp*(1 - cos(5*t))}
  turn: {type: rotary_motor, joint: B, speed: w*t}
  slide: {type: linear_servo, joint: C, displacement: 0.05*sin(4*t), stiffness: 10*k, damping: 2}
  gear: {type: gear, joints: [D, A], ratio: ratio}
analysis: {duration: 1 s, step: 10 ms}
)yaml";

}  // namespace polhode::test
