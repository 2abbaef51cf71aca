// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <polhode/io/read/read_model.hpp>
#include <polhode/simulation/simulation_details.hpp>

namespace polhode::connectors {

inline constexpr double kPi = std::numbers::pi;

/// Final state of a run with connectors.
struct Outcome {
  RunSummary summary;
  std::vector<double> load;  ///< Report of the load "it" at the end, if there is one.
  std::vector<BodyMotion> bodies;
  [[nodiscard]] const BodyMotion& body(int i) const { return bodies[static_cast<std::size_t>(i)]; }
};

inline Outcome run(const std::string& text, const io::Overrides& overrides = {}) {
  Simulation s(io::read_model_text(text, "connector.yaml", overrides));
  Outcome o;
  o.summary = s.run();
  EXPECT_EQ(o.summary.end, RunEnd::finished) << o.summary.message;
  for (std::size_t i = 0; i < s.model().loads.size(); ++i)
    if (s.model().loads[i].name == "it") o.load = s.load(static_cast<int>(i));
  for (std::size_t i = 0; i < s.model().bodies.size(); ++i)
    o.bodies.push_back(s.body(static_cast<int>(i)));
  return o;
}

/// A slider of 2 kg along x at a displacement of 0.8 m, with this load in its joint.
inline std::string slider(const std::string& load, const std::string& T,
                          const std::string& more = "") {
  return R"(
format: 1
variables: {h: 2 ms}
bodies: {cart: {mass: 2, inertia: [1, 1, 1], position: [0.8, 0, 0])" +
         more + R"(}}
joints: {rail: {type: prismatic, bodies: [ground, cart], at_body: [[0, 0, 0], [0, 0, 0]], axis_body: [x, x]}}
loads: {it: {joint: rail, )" +
         load + R"(}}
analysis: {type: dynamics, duration: )" +
         T + R"( s, step: h}
output: {hdf5: false}
)";
}

/// A length of steps.
struct Step {
  const char* text;
  double h;
};
inline constexpr Step kSteps[] = {{"20 ms", 0.02}, {"2 ms", 0.002}, {"0.5 ms", 0.0005}};

inline std::string step_of(const Step& s) { return std::string("variables.h=") + s.text; }

/// Planetary train. Ring at rest (60 teeth, on the ground), planet 20, sun 20 teeth: wheels of 10,
/// 10, 30 cm.
inline std::string planetary(const std::string& loads, const std::string& analysis) {
  return R"(
format: 1
variables: {h: 2 ms}
bodies:
  carrier: {mass: 3, inertia: [0.05, 0.05, 0.08]}
  sun: {mass: 2, inertia: [0.01, 0.01, 0.02]}
  planet: {mass: 1, inertia: [0.005, 0.005, 0.008], position: [0.2, 0, 0.01]}
joints:
  main: {type: revolute, bodies: [ground, carrier], at: [0, 0, 0], axis: z}
  shaft: {type: revolute, bodies: [carrier, sun], at: [0, 0, 0], axis: z}
  pin: {type: revolute, bodies: [carrier, planet], at: [0.2, 0, 0.01], axis: z}
loads:
  it: {type: gear, joints: [shaft, pin], ratio: -1}
  ring: {type: gear, joints: [pin, main], ratio: -3}
)" + loads +
         R"(
analysis: {)" +
         analysis + R"(}
output: {hdf5: false}
)";
}

}  // namespace polhode::connectors
