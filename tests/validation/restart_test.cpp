// SPDX-License-Identifier: Apache-2.0
// Bitwise equal results of a run that is repeated, and of one in two parts.
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <polhode/io/read/read_model.hpp>
#include <polhode/io/results/checkpoint.hpp>
#include <support/paths.hpp>
#include <support/published_cases.hpp>
#include <support/scratch.hpp>

namespace polhode::test::restart_tests {
namespace {

struct RestartCase {
  std::string name;
  Model model;
};

Model with(Model model, double duration, std::optional<double> step,
           std::optional<double> tolerance, std::optional<int> order = {}) {
  model.analysis.duration = duration;
  model.analysis.step = step;
  model.analysis.tolerance = tolerance;
  model.analysis.order = order;
  return model;
}

/// An example with contact, whose points have histories of bristles, gaps and approach speeds.
Model touching(const std::string& name, double duration) {
  Model model = io::read_model(source_dir() + "/examples/" + name + "/model.yaml");
  model.analysis.duration = duration;
  return model;
}

/// Bodies, surfaces of solids and stops of joints, all of them in contact.
Model trolley() {
  Model model = io::read_model(source_dir() + "/tests/validation/data/trolley.yaml");
  model.analysis.duration = 0.25;
  return model;
}

/// A rope that slides over a drum, from a beam to a ball at its end.
Model rope(const std::string& drum = "{cylinder: [0.1, 0.1]}") {
  return io::read_model_text(
      R"(
format: 1
gravity: [0, 0, -9.81]
bodies:
  drum: {shape: )" +
          drum + R"(, mass: 1, orientation: {axis: x, angle: 90 deg}, position: [0, 0, -60 mm]}
  ball: {shape: {sphere: 0.05}, mass: 0.3, position: [0.3, 0, 0]}
joints:
  axle: {type: revolute, bodies: [ground, drum], at: [0, 0, -60 mm], axis: y, friction: {mu: 0.2, radius: 8 mm, length: 60 mm}}
cables:
  rope: {through: [[ground, [-0.3, 0, 0]], [ball]], stiffness: 5 kN, mass_per_length: 0.1, damping: 1,
         elements: 16, contact: {radius: 5 mm}}
contacts: {default: {law: barrier, friction: 0.3, restitution: 0.5}}
analysis: {duration: 0.4 s, step: 1 ms}
)",
      "rope.yaml");
}

/// A rope that slides over a soft block, with a ball at its end.
Model rope_on_pad() {
  return io::read_model_text(R"(
format: 1
gravity: [0, 0, -9.81]
materials: {rubber: {type: neo_hookean, youngs_modulus: 1 MPa, poisson_ratio: 0.3, density: 1000}}
bodies:
  ball: {shape: {sphere: 0.04}, mass: 0.2, position: [0.2, 0, 0]}
solids:
  pad: {mesh: {block: {size: [0.1, 0.06, 0.04], cells: [3, 2, 1]}, position: [0, 0, -0.026]}, material: rubber, bonded: {ground: zmin}}
cables:
  rope: {through: [[ground, [-0.15, 0, 0]], [ball]], stiffness: 2 kN, mass_per_length: 0.1, damping: 1,
         elements: 10, contact: {radius: 5 mm}}
contacts: {default: {law: barrier, friction: 0.3, restitution: 0.5}}
analysis: {duration: 30 ms, step: 1 ms}
)",
                             "pad.yaml");
}

/// The same with the impulse law, whose points have histories of impulses.
Model by_impulses(Model model) {
  model.contacts.standard.potential = "nonsmooth";
  return model;
}

/// Round bodies and a box on a height field, and a pen that leans in a tube.
Model on_triangles() {
  return io::read_model_text(R"(format: 1
gravity: [0, 0, -9.81]
bodies:
  field: {fixed: true, shape: {height_field: {spacing: 0.1, heights: [[0, 0, 0, 0, 0], [0, 0.02, 0, 0.01, 0], [0, 0, 0, 0, 0], [0, 0.01, 0, 0.02, 0], [0, 0, 0, 0, 0]]}}}
  cup: {fixed: true, shape: {tube: [0.06, 0.04, 0.06]}, position: [1, 0, 0]}
  table: {fixed: true, shape: {plane: z}, position: [0, 0, -0.03]}
  ball: {shape: {sphere: 0.04}, mass: 0.2, position: [0, 0.05, 0.05], velocity: [0.3, 0, 0]}
  drum: {shape: {tube: [0.06, 0.04, 0.05]}, mass: 0.2, orientation: {axis: x, angle: 80 deg}, position: [0.1, -0.05, 0.06]}
  crate: {shape: {box: [0.05, 0.04, 0.03]}, mass: 0.2, position: [-0.1, 0.02, 0.05], angular_velocity: [3, 1, 0]}
  pen: {shape: {cylinder: [0.008, 0.1]}, mass: 0.02, orientation: {axis: y, angle: 15 deg}, position: [1.0, 0, 0.022], angular_velocity: [0, 0, 5]}
contacts: {default: {law: barrier, friction: 0.3}}
analysis: {duration: 0.2 s, step: 1 ms}
)",
                             "triangles.yaml");
}

/// A wheel turned by a sampled controller, whose output is never zero after the first sample.
Model controlled_wheel() {
  return io::read_model_text(R"(format: 1
bodies: {wheel: {mass: 1, inertia: [0.01, 0.02, 0.015]}}
joints: {axle: {type: revolute, bodies: [ground, wheel], at: [0, 0, 0], axis: z}}
loads: {motor: {type: rotary_motor, joint: axle, moment: {controller: p}}}
controllers: {p: {joint: axle, channel: rz, setpoint: 1, proportional: 3, sample: 10 ms}}
analysis: {duration: 1 s, step: 5 ms}
)",
                             "wheel.yaml");
}

/// A tumbling strip whose stress relaxes, with an elastic region.
Model relaxing_strip() {
  return io::read_model_text(R"(format: 1
materials:
  soft: {type: mooney_rivlin_uncoupled, c1: 20 kPa, bulk_modulus: 2 MPa, density: 1000, relaxation: [{modulus_ratio: 0.8, time: 5 ms}, {modulus_ratio: 0.5, time: 1 s}]}
  hard: {type: neo_hookean, youngs_modulus: 1 MPa, poisson_ratio: 0.3, density: 1000}
bodies: {hub: {mass: 0.1, inertia: [1e-4, 1e-4, 1e-4], angular_velocity: [3, 20, 5]}}
solids:
  strip:
    mesh: {block: {size: [0.2, 0.03, 0.02], cells: [4, 1, 1]}, position: [0.1, 0, 0]}
    material: soft
    regions: {tip: {material: hard, within: {box: {from: [0.05, -1, -1], to: [1, 1, 1]}}}}
    bonded: {hub: xmin}
analysis: {duration: 0.2 s, step: 5 ms}
)",
                             "strip.yaml");
}

std::vector<RestartCase> cases() {
  return {
      {"FourBarFixedSteps", with(n_four_bar(2), 2.0, 0.01, {})},
      {"FourBarOrder6", with(n_four_bar(2), 2.0, 0.1, {}, 6)},
      {"FourBarAutomatic", with(n_four_bar(1), 2.0, {}, 1e-6)},
      {"SliderCrankFixedSteps", with(spatial_slider_crank(), 1.0, 0.005, {})},
      {"SprungChainDampedAutomatic", with(sprung_chain(1.0), 1.0, {}, 1e-4)},
      {"SqueezerAutomatic", with(andrews_squeezer(), 0.01, {}, 1e-6)},
      {"BricardFixedSteps", with(bricard(), 2.0, 0.01, {})},
      {"FreeTopHalvedSteps", with(free_symmetric_top({3.0, 0.0, 12.0}), 2.0, 0.25, {})},
      {"CardHouse", touching("card_house", 0.3)},
      {"RollingCoin", touching("rolling_coin", 0.05)},
      {"Rattleback", touching("rattleback", 0.2)},
      {"GearPair", touching("gear_pair", 0.05)},
      {"SpheresInABin", touching("spheres_in_a_bin", 0.3)},
      {"Trolley", trolley()},
      {"RopeOverADrum", rope()},
      {"RopeOnAPad", rope_on_pad()},
      {"RopeOverATube", rope("{tube: [0.1, 0.08, 0.1]}")},
      {"SpheresInABinByImpulses", by_impulses(touching("spheres_in_a_bin", 0.6))},
      {"OnTriangles", on_triangles()},
      {"ControlledWheel", controlled_wheel()},
      {"ControlledWheelFinely", with(controlled_wheel(), 1.0, 5e-5, {})},
      {"RelaxingStrip", relaxing_strip()},
      {"RelaxingStripAutomatic", with(relaxing_strip(), 0.04, {}, 1e-4)},
      {"OnTrianglesByImpulses", by_impulses(on_triangles())},
  };
}

class Restart : public testing::TestWithParam<RestartCase> {};

TEST_P(Restart, TwoRunsAgreeToTheBit) {
  Simulation first(GetParam().model), second(GetParam().model);
  ASSERT_EQ(first.run().end, RunEnd::finished);
  ASSERT_EQ(second.run().end, RunEnd::finished);
  EXPECT_EQ(first.state_hash(), second.state_hash());
}

TEST_P(Restart, FromACheckpointEndsInTheSameBits) {
  const Model& model = GetParam().model;
  const Scratch folder;
  const std::string file = folder / "checkpoint.pst";
  Simulation straight(model);
  const std::int64_t half = [&] {
    Simulation trial(model);
    return trial.run().steps / 2;
  }();
  while (straight.time() < model.analysis.duration * (1.0 - 1e-12)) {
    ASSERT_TRUE(straight.step(model.analysis.duration).accepted);
    if (straight.summary().steps == half)
      io::write_checkpoint(file, model, straight.system(), straight.state());
  }
  Simulation continued(model, io::read_checkpoint(file, model, straight.system()));
  EXPECT_EQ(continued.summary().steps, half);
  while (continued.time() < model.analysis.duration * (1.0 - 1e-12))
    ASSERT_TRUE(continued.step(model.analysis.duration).accepted);
  EXPECT_EQ(continued.state_hash(), straight.state_hash());
  EXPECT_EQ(continued.summary().energy_drift, straight.summary().energy_drift);
}

INSTANTIATE_TEST_SUITE_P(Of, Restart, testing::ValuesIn(cases()),
                         [](const auto& p) { return p.param.name; });

}  // namespace
}  // namespace polhode::test::restart_tests
