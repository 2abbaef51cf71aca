// SPDX-License-Identifier: Apache-2.0
// Friction in all joints of plane mechanisms of hinges against the same without redundant rows.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <polhode/core/format.hpp>
#include <polhode/newton/rank_report.hpp>
#include <support/run_text.hpp>

namespace polhode::test::plane_mechanism_friction_tests {
namespace {

/// A joint about y whose pin of 10 mm has friction. In a plane a cylindrical or spherical joint has
/// the same: none of them slides along y, tilts, or carries a force along y.
std::string pin(const std::string& name, const std::string& type, const std::string& rest) {
  const bool slides = type == "cylindrical";
  return format(
      "  {}: {{type: {}, {}{}, friction: {{mu: 0.1, radius: 10 mm, stiffness: {}, damping: 0}}}}\n",
      name, type, rest, type == "spherical" ? "" : ", axis: y", slides ? "200/0.01^2" : "200");
}

/// Mechanism of hinges, or the same with joints of fewer rows.
struct Mechanism {
  std::string name;
  std::string (*text)(bool hinges);
  int redundant;
  double duration;
};

/// The quick-return mechanism of a shaping machine.
std::string quick_return(bool hinges) {
  const auto type = [&](const char* other) { return std::string(hinges ? "revolute" : other); };
  return R"(
format: 1
gravity: [0, 0, -9.81]
variables: {crank: 0.1, centre: 0.3, lever: 0.55, link: 0.2, height: 0.54, along: 'sqrt(link^2-(height-lever)^2)'}
bodies:
  crank: {shape: {cylinder: [0.24, 0.03]}, density: 7800, position: [0, 0, centre], orientation: {axis: x, angle: 90 deg}}
  die: {shape: {box: [0.04, 0.04, 0.06]}, density: 7800, position: [0, 0, centre + crank]}
  lever: {shape: {box: [0.05, 0.02, lever]}, density: 7800, position: [0, 0, lever/2]}
  link: {shape: {box: [link, 0.015, 0.03]}, density: 7800, position: [along/2, 0, (height+lever)/2], orientation: {axis: y, angle: 'atan2(lever-height, along)'}}
  ram: {shape: {box: [0.5, 0.08, 0.06]}, density: 7800, position: [along + 0.25, 0, height]}
joints:
  slot: {type: prismatic, bodies: [lever, die], at: [0, 0, centre + crank], axis: z, friction: {mu: 0.1, length: 60 mm, stiffness: 1e6}}
  guide: {type: prismatic, bodies: [ground, ram], at: [along + 0.25, 0, height], axis: x, friction: {mu: 0.1, length: 500 mm, stiffness: 1e6}}
)" + pin("shaft", "revolute", "bodies: [ground, crank], at: [0, 0, centre]") +
         pin("pin", type("cylindrical"), "bodies: [crank, die], at: [0, 0, centre + crank]") +
         pin("foot", type("spherical"), "bodies: [ground, lever], at: [0, 0, 0]") +
         pin("top", type("spherical"), "bodies: [lever, link], at: [0, 0, lever]") +
         pin("nose", type("cylindrical"), "bodies: [link, ram], at: [along, 0, height]") + R"(
loads:
  motor: {type: rotary_motor, joint: shaft, speed: {table: [[0, 0], [0.2 s, 60 rpm]]}}
  spring: {type: translational_spring, joint: guide, stiffness: 200 N/m}
)";
}

std::string four_bar(bool hinges) {
  const auto type = [&](const char* other) { return std::string(hinges ? "revolute" : other); };
  return R"(
format: 1
gravity: [0, 0, -9.81]
bodies:
  crank: {mass: 1, inertia: [0.01, 0.01, 0.01], position: [0, 0, 0.1]}
  rod: {mass: 2, inertia: [0.05, 0.05, 0.05], position: [0.3, 0, 0.3]}
  rocker: {mass: 1.5, inertia: [0.03, 0.03, 0.03], position: [0.55, 0, 0.2]}
joints:
)" + pin("shaft", "revolute", "bodies: [ground, crank], at: [0, 0, 0]") +
         pin("b", type("spherical"), "bodies: [crank, rod], at: [0, 0, 0.2]") +
         pin("c", type("cylindrical"), "bodies: [rod, rocker], at: [0.6, 0, 0.4]") +
         pin("d", "revolute", "bodies: [ground, rocker], at: [0.5, 0, 0]") + R"(
loads:
  motor: {type: rotary_motor, joint: shaft, speed: {table: [[0, 0], [0.2 s, 90 rpm]]}}
)";
}

std::string slider_crank(bool hinges) {
  const auto type = [&](const char* other) { return std::string(hinges ? "revolute" : other); };
  return R"(
format: 1
gravity: [0, 0, -9.81]
bodies:
  crank: {mass: 1, inertia: [0.005, 0.005, 0.005], position: [0, 0, 0.05]}
  rod: {mass: 0.8, inertia: [0.006, 0.006, 0.006], position: [0.12, 0, 0.05], orientation: {axis: y, angle: 'atan2(0.1, 0.24)'}}
  piston: {mass: 0.5, inertia: [0.001, 0.001, 0.001], position: [0.24, 0, 0]}
joints:
  cylinder: {type: prismatic, bodies: [ground, piston], at: [0.24, 0, 0], axis: x, friction: {mu: 0.1, length: 80 mm, stiffness: 1e6}}
)" + pin("shaft", "revolute", "bodies: [ground, crank], at: [0, 0, 0]") +
         pin("big_end", type("spherical"), "bodies: [crank, rod], at: [0, 0, 0.1]") +
         pin("small_end", type("cylindrical"), "bodies: [rod, piston], at: [0.24, 0, 0]") + R"(
loads:
  motor: {type: rotary_motor, joint: shaft, speed: {table: [[0, 0], [0.2 s, 300 rpm]]}}
)";
}

/// Moments of the motor and the energy dissipated.
struct Course {
  std::vector<double> moment;
  double largest = 0.0, dissipated = 0.0, drift = 0.0;
};

// The tolerance is on increments of the motion: friction, which follows from reactions, needs a
// small one for a ledger that closes, with or without redundant rows.
Course course(const std::string& text, double step, double duration, const std::string& solver) {
  Simulation s = made(text + format("analysis: {{duration: {:.17g} s, step: {:.17g} s, solver: {}, "
                                    "newton_tolerance: 1e-9}}\noutput: {{hdf5: false}}\n",
                                    duration, step, solver));
  Course c;
  while (s.time() < duration - 0.5 * step) {
    const StepReport r = s.step(1e3);
    EXPECT_TRUE(r.accepted) << r.message;
    if (!r.accepted) return c;
    c.moment.push_back(s.load(0)[1]);
    c.largest = std::max(c.largest, std::abs(c.moment.back()));
  }
  c.dissipated = s.balance().dissipated;
  c.drift = s.state().ledger.energy_drift;
  return c;
}

class PlaneMechanism : public testing::TestWithParam<Mechanism> {};

}  // namespace

// Out of their plane these mechanisms carry nothing, so the reactions of smallest norm are those of
// the mechanism without redundant rows, and so is friction, at any step. (Where a pin sticks, the
// bristles of different joints have different gradients, to the order of the step.)
// @tests{least-reactions}
TEST_P(PlaneMechanism, RubsAsTheSameWithoutRedundantRows) {
  const Mechanism& m = GetParam();
  const std::string hinged = m.text(true), relaxed = m.text(false);
  const Simulation at_start = made(hinged + "analysis: {duration: 1, step: 1 ms}\n");
  ASSERT_EQ(rank_report(at_start.system(), at_start.state()).redundant, m.redundant);
  const Simulation other = made(relaxed + "analysis: {duration: 1, step: 1 ms}\n");
  ASSERT_EQ(rank_report(other.system(), other.state()).redundant, 0);
  for (const double step : {10e-3, 2e-3, 1e-3, 0.1e-3}) {
    const double duration = step < 0.5e-3 ? 0.1 * m.duration : m.duration;
    const Course wanted = course(relaxed, step, duration, "automatic");
    for (const char* const solver : {"tree", "block_lu"}) {
      const Course found = course(hinged, step, duration, solver);
      ASSERT_EQ(found.moment.size(), wanted.moment.size()) << step;
      double most = 0.0;
      for (std::size_t k = 0; k < found.moment.size(); ++k)
        most = std::max(most, std::abs(found.moment[k] - wanted.moment[k]));
      EXPECT_LE(most, 1e-4 * wanted.largest) << solver << ' ' << step;
      EXPECT_NEAR(found.dissipated, wanted.dissipated, 3e-3 * wanted.dissipated)
          << solver << ' ' << step;
      EXPECT_LE(found.drift, 1e-5) << solver << ' ' << step;
    }
  }
}

// Which joints take part follows from the model alone, and their reactions from the state.
TEST_P(PlaneMechanism, ContinuesAfterARestartBitForBit) {
  const std::string text =
      GetParam().text(true) + "analysis: {duration: 1 s, step: 2 ms}\noutput: {hdf5: false}\n";
  Simulation straight = made(text);
  for (int k = 0; k < 50; ++k) ASSERT_TRUE(straight.step(1e3).accepted);
  Simulation again(io::read_model_text(text, "model.yaml", {}), straight.state());
  for (int k = 0; k < 50; ++k) {
    ASSERT_TRUE(straight.step(1e3).accepted);
    ASSERT_TRUE(again.step(1e3).accepted);
  }
  EXPECT_EQ(straight.state().history, again.state().history);
  EXPECT_EQ(straight.state().lambda, again.state().lambda);
  EXPECT_EQ(straight.body(1).r, again.body(1).r);
}

INSTANTIATE_TEST_SUITE_P(Of, PlaneMechanism,
                         testing::Values(Mechanism{"QuickReturn", quick_return, 6, 1.2},
                                         Mechanism{"FourBar", four_bar, 3, 1.0},
                                         Mechanism{"SliderCrank", slider_crank, 3, 0.5}),
                         [](const auto& p) { return p.param.name; });

}  // namespace polhode::test::plane_mechanism_friction_tests
