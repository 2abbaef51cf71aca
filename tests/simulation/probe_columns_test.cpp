// SPDX-License-Identifier: Apache-2.0
// Names of the columns of probes and channels, for all kinds of objects.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <polhode/io/text/units.hpp>
#include <polhode/joints/registry.hpp>
#include <polhode/simulation/channel_reader.hpp>
#include <polhode/simulation/probe.hpp>
#include <polhode/simulation/probe_columns.hpp>
#include <support/run_text.hpp>

namespace polhode::test::probe_columns_tests {
namespace {

/// A model with one object of each kind and a probe of it.
const char* const kAll = R"(
format: 1
gravity: [0, 0, -9.81]
bodies:
  cart: {mass: 2, inertia: [1, 1, 1], position: [0, 0, 0]}
  ball: {mass: 1, inertia: [1, 1, 1], shape: {sphere: 200 mm}, position: [0, 0, 3]}
  floor: {fixed: true, shape: {box: [1, 1, 0.1]}, position: [0, 0, 2.45]}
joints:
  rail: {type: cylindrical, bodies: [ground, cart], at: [0, 0, 0], axis: x, friction: {mu: 0.1, radius: 10 mm}, limits: {lower: -1, upper: 1}}
materials: {rubber: {type: neo_hookean, youngs_modulus: 1 MPa, poisson_ratio: 0.3, density: 1000}}
sections: {rod: {type: circle, diameter: 20 mm, material: rubber}}
beams: {strand: {points: [[5, 0, 0], [5, 0, -0.3]], elements: 2, section: rod, bonded: {ground: start}}}
cables:
  rope: {through: [[ground, [0, 0, 1]], [cart]], stiffness: 1 kN}
  muscle: {through: [[ground, [-0.4, 0, 0]], [cart]], muscle: {max_force: 60, optimal_length: 0.2, tendon_length: 0.2, activation: 0.1}}
solids: {cube: {mesh: {block: {size: [0.1, 0.1, 0.1], cells: [1, 1, 1]}, position: [7, 0, 0]}, material: rubber, bonded: {ground: zmax}}}
loads: {spring: {type: spring_damper, bodies: [ground, cart], at: [[1, 0, 1], [0, 0, 0]], stiffness: 10, damping: 1}}
contacts: {}
controllers: {c: {body: cart, channel: x, proportional: 1}}
analysis: {type: dynamics, duration: 4 ms, step: 1 ms}
output:
  hdf5: false
  probes:
    cart: {body: cart}
    turning: {body: cart, rotation: zyx, angular: true, helical: instantaneous}
    rail: {joint: rail}
    spring: {load: spring}
    rope: {cable: rope}
    muscle: {cable: muscle}
    strand: {beam: strand, element: 1}
    point: {solid: cube, point: [0, 0, 0], stress: true}
    held: {solid: cube, interface: ground}
    contact: {contact: [floor, ball]}
    c: {controller: c}
)";

TEST(ProbeColumns, HaveOneUniqueNameAndUnitForEachNumber) {
  Simulation s = made(kAll);
  (void)finished(s);
  for (const ProbeSpec& probe : s.model().output.probes) {
    EXPECT_EQ(s.probe(probe.name).size(), s.probe_columns(probe.name).size()) << probe.name;
    std::vector<std::string> names;
    for (const ProbeNumber& c : channel_columns(s.model(), probe)) {
      EXPECT_EQ(std::count(names.begin(), names.end(), c.name), 0) << probe.name << ' ' << c.name;
      names.push_back(c.name);
      if (c.unit != "SI" && c.unit != "-") {
        EXPECT_TRUE(io::read_unit(c.unit).unit) << probe.name << ' ' << c.name << ' ' << c.unit;
      }
    }
  }
}

// Probes, events and controllers read the same number.
TEST(ProbeColumns, AreTheNumbersThatChannelsRead) {
  Simulation s = made(kAll);
  (void)finished(s);
  SystemMap map;
  (void)build_system(s.model(), &map);
  for (const ProbeSpec& probe : s.model().output.probes) {
    const std::vector<double> row = s.probe(probe.name);
    for (const ProbeNumber& c : channel_columns(s.model(), probe)) {
      const ChannelReader reader(s, map, {probe, c.name}, "here");
      const double* x = row.data() + 1 + c.column;
      if (c.name == "gap") {  // beyond the distance at which contacts know gaps
        EXPECT_NEAR(reader.value(s), 0.4, 1e-3);
      } else if (c.size == 3) {
        EXPECT_EQ(reader.value(s), Vec3(x[0], x[1], x[2]).norm()) << probe.name << ' ' << c.name;
      } else {
        EXPECT_NEAR(reader.value(s), *x, 1e-14 * std::abs(*x)) << probe.name << ' ' << c.name;
      }
    }
  }
}

// The columns of a joint follow from its kind alone, as the simulation has them.
TEST(ProbeColumns, OfEveryKindOfJointAreItsCoordinates) {
  for (const JointKind& kind : joint_kinds()) {
    Model model;
    JointSpec joint;
    joint.name = "it";
    joint.type = kind.name;
    if (kind.takes_free_list) joint.free = {"x", "rz"};
    for (const Parameter& p : kind.parameters) joint.parameters[p.name] = 0.5;
    model.joints.push_back(joint);
    ProbeSpec probe;
    probe.kind = "joint";
    probe.target = "it";
    const std::vector<ProbeNumber> columns = channel_columns(model, probe);
    const auto count = [&](const auto& is) {
      return std::count_if(columns.begin(), columns.end(), is);
    };
    EXPECT_EQ(count([](const ProbeNumber& c) { return c.name.starts_with("rate "); }),
              count([](const ProbeNumber& c) { return c.unit == "m" || c.unit == "rad"; }))
        << kind.name;
    EXPECT_EQ(columns.back().name, "moment") << kind.name;
  }
}

}  // namespace
}  // namespace polhode::test::probe_columns_tests
