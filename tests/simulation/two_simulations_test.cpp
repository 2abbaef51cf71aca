// SPDX-License-Identifier: Apache-2.0
// Several simulations in one program, in turn and in threads: each has the results of a single one.
#include <thread>

#include <gtest/gtest.h>
#include <polhode/core/format.hpp>
#include <polhode/polhode.hpp>

namespace polhode::two_simulations_tests {
namespace {

/// A deformable bar that swings on a hinged body.
Model swing(int cells) {
  return io::read_model_text(R"(
format: 1
variables: {n: )" + std::to_string(cells) +
                                 R"(}
gravity: [0, 0, -9.81]
materials: {rubber: {type: neo_hookean, youngs_modulus: 1 MPa, poisson_ratio: 0.3, density: 1000}}
bodies: {hub: {shape: {box: [0.1, 0.1, 0.1]}, density: 1000, position: [-0.05, 0, 0]}}
solids:
  bar:
    mesh: {block: {size: [0.5, 0.05, 0.05], cells: [n, 1, 1]}, position: [0.25, 0, 0]}
    element: hex8_eas9
    material: rubber
    bonded: {hub: xmin}
joints: {pin: {type: revolute, bodies: [ground, hub], at: [-0.05, 0, 0], axis: y}}
analysis: {duration: 0.05, step: 0.005}
)",
                             "swing.yaml");
}

/// Three balls in a bowl.
Model balls() {
  return io::read_model_text(R"(
format: 1
gravity: [0, 0, -9.81]
contacts: {default: {friction: 0.3}}
bodies:
  floor: {fixed: true, shape: {plane: [0, 0, 1]}}
  a: {shape: {sphere: 0.1}, density: 1000, position: [0, 0, 0.2]}
  b: {shape: {sphere: 0.1}, density: 1000, position: [0.05, 0, 0.5]}
  c: {shape: {box: [0.1, 0.1, 0.1]}, density: 1000, position: [0.02, 0.03, 0.8]}
analysis: {duration: 0.5, step: 0.002}
)",
                             "balls.yaml");
}

/// Sixty balls that fall on each other, by conjugate gradients or by impulses.
Model pile(const char* law) {
  std::string bodies;
  for (int i = 0; i < 60; ++i)
    bodies += format("  b{}: {{shape: {{sphere: 0.2}}, mass: 1, position: [{}, {}, {}]}}\n", i,
                     0.23 * (i % 4) + 0.003 * (i % 7), 0.23 * (i / 4 % 4) + 0.004 * (i % 5),
                     0.11 + 0.21 * (i / 16));
  return io::read_model_text(
      "format: 1\ngravity: [0, 0, -9.81]\ncontacts: {default: {friction: 0.3, law: " +
          std::string(law) + "}}\nbodies:\n  floor: {fixed: true, shape: {plane: z}}\n" + bodies +
          "analysis: {duration: 0.05, step: 0.002}\n",
      "pile.yaml");
}

/// A pen that leans in the mouth of a tube, and a block of rubber that falls on a box.
Model surfaces() {
  return io::read_model_text(R"(
format: 1
gravity: [0, 0, -9.81]
materials: {rubber: {type: neo_hookean, youngs_modulus: 1 MPa, poisson_ratio: 0.3, density: 1000}}
bodies:
  floor: {fixed: true, shape: {box: [2, 2, 0.1]}, position: [0, 0, -0.05]}
  cup: {fixed: true, shape: {tube: [40 mm, 30 mm, 0.1]}, position: [0.5, 0, 0.05]}
  pen: {shape: {capsule: [10 mm, 0.2]}, density: 1000, position: [0.5, 0, 0.13], orientation: {axis: y, angle: 5 deg}}
solids:
  pad:
    mesh: {block: {size: [0.2, 0.2, 0.1], cells: [2, 2, 1]}, position: [0, 0, 0.052]}
    material: rubber
contacts: {default: {friction: 0.3}}
analysis: {duration: 0.05, step: 0.002}
)",
                             "surfaces.yaml");
}

std::string alone(const Model& model) {
  Simulation simulation(model);
  simulation.run();
  return simulation.state_hash();
}

TEST(TwoSimulations, SideBySideAreAsIfAlone) {
  const Model small = swing(2), large = swing(9);
  const std::string of_small = alone(small), of_large = alone(large);
  Simulation a(small), b(large);
  while (a.time() < 0.05 * (1.0 - 1e-12)) {
    a.step(0.05);
    b.step(0.05);
    EXPECT_GT(a.solid("bar").velocity.back().norm(), 0.0);
    EXPECT_GT(b.solid("bar").velocity.back().norm(), 0.0);
  }
  EXPECT_EQ(a.state_hash(), of_small);
  EXPECT_EQ(b.state_hash(), of_large);
}

TEST(TwoSimulations, InThreadsAreAsIfAlone) {
  const std::vector<Model> models{
      swing(2),        swing(9),          balls(),           balls(),    pile("barrier"),
      pile("barrier"), pile("nonsmooth"), pile("nonsmooth"), surfaces(), surfaces()};
  std::vector<std::string> expected, found(models.size());
  for (const Model& model : models) expected.push_back(alone(model));
  std::vector<std::thread> threads;
  for (std::size_t k = 0; k < models.size(); ++k)
    threads.emplace_back([&, k] { found[k] = alone(models[k]); });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(found, expected);
}

TEST(SimulationByName, FindsNamedObjectsOfTheModel) {
  Simulation s(swing(2));
  s.step(0.05);
  EXPECT_EQ(s.body("hub").r, s.body(0).r);
  EXPECT_EQ(s.body("ground").r, Vec3::Zero());
  EXPECT_EQ(s.joint("pin").force, s.joint(0).force);
  EXPECT_EQ(s.point("hub", Vec3::UnitX()).position, s.point(0, Vec3::UnitX()).position);
  try {
    (void)s.body("hubb");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "bodies: unknown body 'hubb'. Did you mean 'hub'? Use one of: ground, hub.");
  }
}

}  // namespace
}  // namespace polhode::two_simulations_tests
