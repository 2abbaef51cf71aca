// SPDX-License-Identifier: Apache-2.0
// Runs that are saved during impacts of solids and cables and continued from there.
#include <gtest/gtest.h>

#include <polhode/core/format.hpp>
#include <polhode/system/state_archive.hpp>
#include <support/run_text.hpp>

namespace polhode::test::surface_restart_tests {
namespace {

struct Fall {
  const char* name;
  std::string things;
  double step;
  int steps;
};

/// Solids of rubber and ropes that fall on shapes and on each other, some of them spinning and
/// sliding.
std::vector<Fall> falls() {
  const std::string rubber =
      "materials: {rubber: {type: neo_hookean, youngs_modulus: 1e6, poisson_ratio: 0.3, density: "
      "1000}}\n";
  const std::string left =
      "{mass: 1e-2, inertia: [1e-6, 1e-6, 1e-6], position: [-0.1, 0, 0.012], velocity: [0.5, 0.2, "
      "-1]}";
  const std::string right =
      "{mass: 1e-2, inertia: [1e-6, 1e-6, 1e-6], position: [0.1, 0, 0.013], velocity: [0.5, -0.2, "
      "-1]}";
  const std::string rope =
      "{through: [[left], [right]], stiffness: 1e4, mass_per_length: 0.1, elements: 4, contact: "
      "{radius: 5 mm}}";
  return {
      {"a solid on a plane", rubber + R"(
bodies: {floor: {fixed: true, shape: {plane: z}}}
solids:
  block: {mesh: {block: {size: [0.1, 0.1, 0.1], cells: [2, 2, 2]}, position: [0, 0, 0.0505]}, material: rubber,
          velocity: [1, 0, -1], contact: {}}
)",
       5e-4, 24},
      {"a solid on a free box", rubber + R"(
bodies: {table: {mass: 1, inertia: [0.01, 0.01, 0.01], position: [0.02, 0.01, -0.05], shape: {box: [0.2, 0.2, 0.1]}}}
solids:
  block: {mesh: {block: {size: [0.1, 0.1, 0.1], cells: [2, 2, 2]}, position: [0, 0, 0.0505]}, material: rubber,
          velocity: [1, 0, -1], contact: {}}
)",
       5e-4, 24},
      {"a solid on a solid", rubber + R"(
solids:
  low: {mesh: {block: {size: [0.1, 0.1, 0.1], cells: [2, 2, 2]}, position: [0, 0, 0]}, material: rubber, contact: {}}
  high: {mesh: {block: {size: [0.06, 0.06, 0.06], cells: [2, 2, 2]}, position: [0.01, 0.005, 0.081]}, material: rubber,
         velocity: [0.5, 0, -1], contact: {}}
)",
       5e-4, 24},
      {"a rope on a plane",
       "bodies: {floor: {fixed: true, shape: {plane: z}}, left: " + left + ", right: " + right +
           "}\ncables: {rope: " + rope + "}\n",
       5e-4, 30},
      {"a rope on a rope", "bodies: {left: " + left + ", right: " + right + R"(,
  front: {mass: 1e-2, inertia: [1e-6, 1e-6, 1e-6], position: [0, -0.1, 0]},
  back: {mass: 1e-2, inertia: [1e-6, 1e-6, 1e-6], position: [0, 0.1, 0]}}
cables:
  rope: )" + rope + R"(
  stay: {through: [[front], [back]], stiffness: 1e4, mass_per_length: 0.1, elements: 3, contact: {radius: 5 mm}}
)",
       5e-4, 30},
      {"a rope on a solid",
       rubber + "bodies: {left: " + left + ", right: " + right + "}\ncables: {rope: " + rope + R"(}
solids:
  block: {mesh: {block: {size: [0.1, 0.1, 0.1], cells: [2, 2, 2]}, position: [0, 0, -0.05]}, material: rubber, contact: {}}
)",
       5e-4, 30},
  };
}

std::string text_of(const Fall& fall, double e, double friction) {
  return "format: 1\ngravity: [0, 0, -9.81]\n" + fall.things +
         format(R"(contacts: {{default: {{restitution: {}, friction: {}}}}}
analysis: {{duration: {}, step: {}}}
output: {{hdf5: false}}
)",
                e, friction, fall.step * fall.steps, fall.step);
}

/// States saved before the impact and in every fourth step of it, some after maximum compression.
TEST(SurfaceRestart, DuringImpactsContinuesBitForBit) {
  for (const Fall& fall : falls())
    for (const double e : {0.0, 0.5}) {
      SCOPED_TRACE(format("{}, e = {}", fall.name, e));
      const std::string text = text_of(fall, e, 0.2);
      Simulation straight = made(text);
      const RunSummary whole = finished(straight);
      ASSERT_TRUE(whole.contacts);
      EXPECT_GT(whole.contacts->lost_in_impacts, 0.0);
      Simulation first = made(text);
      int touching = 0, saved = 0;
      while (first.time() < fall.step * (fall.steps - 0.5)) {
        ASSERT_TRUE(first.step(fall.step * fall.steps).accepted);
        const bool touches = first.contact(0).points > 0;
        touching += touches;
        if (saved > 0 && (!touches || touching % 4 != 1)) continue;
        ++saved;
        const std::string bytes = state_bytes(first.system(), first.state());
        Simulation second(Model(first.model()), state_from_bytes(first.system(), bytes, "here"));
        (void)finished(second);
        ASSERT_EQ(second.state_hash(), straight.state_hash())
            << "saved at " << first.time() << " s";
      }
      EXPECT_GE(touching, 3);
      EXPECT_GE(saved, 2);
    }
}

}  // namespace
}  // namespace polhode::test::surface_restart_tests
