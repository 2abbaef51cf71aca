// SPDX-License-Identifier: Apache-2.0
// Contact of cables with surfaces of deformable solids.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <polhode/core/format.hpp>
#include <polhode/io/read/read_model.hpp>
#include <polhode/simulation/simulation_details.hpp>
#include <polhode/surface_contact/solid_contact.hpp>

namespace polhode::test::cable_on_solid_tests {
namespace {

using testing::HasSubstr;

/// A cube is thrown at a cable between two blocks, all free in space.
Model thrown(const std::string& cube, const std::string& modulus, const std::string& law,
             double duration, double step) {
  return io::read_model_text(format(R"(
format: 1
bodies:
  left: {{shape: {{box: [0.1, 0.2, 0.2]}}, density: 1000, position: [-0.25, 0, 0]}}
  right: {{shape: {{box: [0.1, 0.2, 0.2]}}, density: 1000, position: [0.25, 0, 0]}}
materials: {{rubber: {{type: neo_hookean, youngs_modulus: {}, poisson_ratio: 0.3, density: 1000}}}}
solids:
  cube: {{mesh: {{block: {{size: [0.1, 0.1, 0.1], cells: [4, 4, 2]}}, {}, material: rubber}}
cables:
  rope: {{through: [[left, [0.05, 0, 0]], [right, [-0.05, 0, 0]]], stiffness: 20 kN, mass_per_length: 0.05,
         elements: 12, contact: {{radius: 5 mm}}}}
contacts: {{default: {{{}}}}}
analysis: {{duration: {:g}, step: {:g}}}
)",
                                    modulus, cube, law, duration, step),
                             "thrown.yaml");
}

ContactReport between(const Simulation& s, const std::string& a, const std::string& b) {
  const auto& pairs = s.contact_map().pairs;
  for (std::size_t k = 0; k < pairs.size(); ++k)
    if (s.model().side_name(pairs[k].a) == a && s.model().side_name(pairs[k].b) == b)
      return s.contact(static_cast<int>(k));
  throw std::logic_error("no such pair");
}

/// Impacts along a line of nodes, which deforms to a valley with a slope on both sides; beside that
/// line; and on edges and corners of a tumbling cube.
TEST(CableOnSolid, KeepsEnergyAndMomenta) {
  for (const char* cube :
       {"position: [0.003, 0, 0.056]}, velocity: [0, 0, -3]",
        "position: [0.003, 0.013, 0.056]}, velocity: [0, 0, -3]",
        "position: [0.003, 0.013, 0.085], orientation: {axis: [1, 2, 0], angle: 40 deg}}, "
        "velocity: [0, 0.2, -3], angular_velocity: [5, -9, 3]"}) {
    Simulation s(thrown(cube, "1 MPa", "restitution: 1", 0.012, 2e-4));
    const RunSummary r = s.run();
    ASSERT_EQ(r.end, RunEnd::finished) << cube << r.message;
    EXPECT_GT(between(s, "rope", "cube").impulse, 0.1) << cube;
    EXPECT_LT(r.energy_drift, 1e-10) << cube;
    EXPECT_LT(r.linear_momentum_drift, 1e-12) << cube;
    EXPECT_LT(r.angular_momentum_drift, 1e-12) << cube;
    EXPECT_GT(r.contacts->least_gap, -5e-5) << "the tolerance: 1e-2 of the cable's radius";
  }
}

/// Friction and impacts dissipate energy and conserve momenta.
TEST(CableOnSolid, HasFrictionAndKeepsMomenta) {
  Simulation s(thrown("position: [0.003, 0.013, 0.056]}, velocity: [1, 0.5, -3]", "1 MPa",
                      "restitution: 0.5, friction: 0.5", 0.01, 2e-4));
  double energy = s.balance().kinetic, rise = 0.0;
  const RunSummary r = s.run({}, [&](Simulation& now) {
    const Balance b = now.balance();
    rise = std::max(rise, b.kinetic + b.potential - energy);
    energy = b.kinetic + b.potential;
  });
  ASSERT_EQ(r.end, RunEnd::finished) << r.message;
  EXPECT_LT(rise, 1e-10);
  EXPECT_GT(r.contacts->lost_by_friction, 1e-3);
  EXPECT_LT(r.energy_drift, 1e-10) << "the loss is in the energy balance";
  EXPECT_LT(r.linear_momentum_drift, 1e-12);
  EXPECT_LT(r.angular_momentum_drift, 1e-12);
}

/// A plate that moves by three thicknesses of the cable in a step.
TEST(CableOnSolid, AFastPlateDoesNotPassThroughAThinCable) {
  Simulation s(io::read_model_text(R"(
format: 1
bodies:
  left: {shape: {box: [0.1, 0.2, 0.2]}, density: 1000, position: [-0.25, 0, 0]}
  right: {shape: {box: [0.1, 0.2, 0.2]}, density: 1000, position: [0.25, 0, 0]}
materials: {plastic: {type: neo_hookean, youngs_modulus: 100 MPa, poisson_ratio: 0.3, density: 1000}}
solids:
  plate: {mesh: {block: {size: [0.06, 0.06, 0.01], cells: [2, 2, 1]}, position: [0.003, 0.003, 0.012]},
          velocity: [0, 0, -30], material: plastic}
cables:
  rope: {through: [[left, [0.05, 0, 0]], [right, [-0.05, 0, 0]]], stiffness: 20 kN, mass_per_length: 0.05,
         elements: 12, contact: {radius: 5 mm}}
contacts: {default: {restitution: 1}}
analysis: {duration: 2 ms, step: 1 ms}
)",
                                   "fast.yaml"));
  const RunSummary r = s.run({}, [](Simulation& now) {
    const Vec3 middle = now.body(now.model().body_index("rope.6")).r;
    double low = 1.0;
    for (const Vec3& x : now.solid(0).position) low = std::min(low, x.z());
    EXPECT_GT(low, middle.z());
  });
  ASSERT_EQ(r.end, RunEnd::finished) << r.message;
  EXPECT_GT(between(s, "rope", "plate").impulse, 0.1);
  EXPECT_LT(r.energy_drift, 1e-10);
}

/// Cables that start within a solid are refused, except where the cable is attached to a body to
/// which the solid is bonded.
TEST(CableOnSolid, RefusesCablesThatStartWithinASolid) {
  const auto error_of = [](const std::string& bonded, double height) -> std::string {
    try {
      Simulation(io::read_model_text(format(R"(
format: 1
materials: {{rubber: {{type: neo_hookean, youngs_modulus: 1 MPa, poisson_ratio: 0.3, density: 1000}}}}
bodies:
  core: {{mass: 1, inertia: [1, 1, 1]}}
  ball: {{mass: 1, inertia: [1, 1, 1], position: [0.3, 0, {0}]}}
solids:
  pad: {{mesh: {{block: {{size: [0.1, 0.1, 0.1], cells: [2, 2, 2]}}, position: [0, 0, 0]}}, material: rubber{1}}}
cables:
  rope: {{through: [[core, [0, 0, {0}]], [ball]], stiffness: 10 kN, mass_per_length: 0.5, elements: 10, contact: {{radius: 5 mm}}}}
contacts: {{}}
analysis: {{duration: 0.1 ms, step: 0.1 ms}}
)",
                                            height, bonded),
                                     "start.yaml"))
          .run();
    } catch (const std::exception& e) {
      return e.what();
    }
    return {};
  };
  EXPECT_THAT(error_of("", 0.053), HasSubstr("rope in pad by 0.002 m"));
  EXPECT_EQ(error_of("", 0.0552), "");
  EXPECT_EQ(error_of(", bonded: {core: zmin}", 0.053), "") << "leaves the body it is attached to";
}

/// A cable that is pulled down across a soft block: the contact force balances the forces of its
/// ends.
TEST(CableOnSolid, HasAContactForceThatBalancesItsEnds) {
  for (const double beside : {0.0, 0.013}) {
    Simulation s(io::read_model_text(format(R"(
format: 1
materials: {{rubber: {{type: neo_hookean, youngs_modulus: 1 MPa, poisson_ratio: 0.3, density: 1000}}}}
solids:
  pad: {{mesh: {{block: {{size: [0.1, 0.1, 0.05], cells: [4, 4, 2]}}, position: [0, 0, -0.03025]}}, material: rubber, bonded: {{ground: zmin}}}}
cables:
  rope: {{through: [[ground, [-0.12, {0}, 0]], [ground, [0.12, {0}, 0]]], stiffness: 2 kN, free_length: 0.24,
         mass_per_length: 50, elements: 24, contact: {{radius: 5 mm}}}}
gravity: [0, 0, -9.81]
contacts: {{}}
analysis: {{type: statics, load_steps: 4}}
)",
                                            beside),
                                     "pad.yaml"));
    const RunSummary r = s.run();
    ASSERT_EQ(r.end, RunEnd::finished) << r.message;
    const ContactReport c = between(s, "rope", "pad");
    // Nodes have the weight of a piece each; the ends carry the vertical part of their tensions.
    const auto at = [&](int k) { return s.body(s.model().body_index(format("rope.{}", k))).r; };
    const CableReport rope = s.cable(0);
    const double weight = 50.0 * 0.24 * 23.0 / 24.0 * 9.81;
    const Vec3 left = at(1) - Vec3(-0.12, beside, 0.0), right = at(23) - Vec3(0.12, beside, 0.0);
    const double ends = -rope.tension.front() * left.normalized().z() -
                        rope.tension.back() * right.normalized().z();
    EXPECT_NEAR((c.force.z() + ends) / weight, 1.0, 1e-8);
    EXPECT_GT(c.force.z(), 0.3 * weight);
    EXPECT_LT(std::abs(c.force.x()), 1e-6 * weight);
  }
}

}  // namespace
}  // namespace polhode::test::cable_on_solid_tests
