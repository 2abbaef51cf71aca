// SPDX-License-Identifier: Apache-2.0
// The non-smooth law in models: its motion compared with that by forces, and what must not pass
// through another body.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "validation/contact_law_scenes.hpp"

namespace polhode::nonsmooth_law_tests {
namespace {

using namespace contact_law_scenes;

struct Compared {
  const char* name;
  Scene scene;
  double place, speed;  ///< Largest differences at 1 ms [m, m/s].
};

std::vector<double> motions(const Simulation& run) {
  std::vector<double> all;
  for (int k = 1; k < static_cast<int>(run.model().bodies.size()); ++k) {
    const BodyMotion m = run.body(k);
    for (int i = 0; i < 3; ++i) {
      all.push_back(m.r[i]);
      all.push_back(m.v[i]);
    }
  }
  return all;
}

/// Positions and velocities by impulses are those by the barrier to order 1 of the step, and to its
/// tolerance of some 5e-5 of the size.
/// @tests{nonsmooth-step} @tests{nonsmooth-exit}
TEST(NonsmoothLaw, MovesBodiesAsTheBarrierDoes) {
  const std::vector<Compared> cases = {
      {"ball, e = 0", {kBall, "restitution: 0", 0.3}, 1e-4, 1e-6},
      {"ball, e = 0.5", {kBall, "restitution: 0.5", 0.25}, 2e-3, 2e-2},
      {"ball, e = 1", {kBall, "restitution: 1", 0.3}, 3e-3, 3e-2},
      {"box lands",
       {"  a: {shape: {box: [0.2, 0.2, 0.2]}, mass: 1, position: [0, 0, 0.2], velocity: [1, 0, 0]}",
        "friction: 0.1"},
       1e-4,
       1e-5},
      {"box slides",
       {"  a: {shape: {box: [0.4, 0.4, 0.1]}, mass: 1, position: [0, 0, 0.05], velocity: [2, 0, "
        "0]}",
        "friction: 0.3"},
       1e-5,
       1e-5},
      {"three boxes",
       {"  a: {shape: {box: [0.3, 0.3, 0.1]}, mass: 3, position: [0, 0, 0.05]}\n"
        "  b: {shape: {box: [0.25, 0.25, 0.1]}, mass: 2, position: [0, 0, 0.15]}\n"
        "  c: {shape: {box: [0.2, 0.2, 0.1]}, mass: 1, position: [0, 0, 0.25]}",
        "friction: 0.5"},
       2e-5,
       1e-5},
      {"sticks on a slope", {kBox, "friction: 0.5", 0.4, 0.45}, 1e-5, 1e-5},
      {"slips on a slope", {kBox, "friction: 0.5", 0.4, 0.7}, 1e-5, 1e-5},
      {"rolling disc",
       {"  a: {shape: {cylinder: [0.2, 0.1]}, mass: 1, position: [0, 0, 0.1], velocity: [1, 0, "
        "0],\n"
        "      angular_velocity: [0, 10, 0], orientation: {axis: [1, 0, 0], angle: "
        "1.5707963267949}}",
        "friction: 0.5", 0.4, 0.2},
       2e-5,
       1e-4},
      {"two balls collide",
       {"  a: {shape: {sphere: 0.2}, mass: 1, position: [0, 0, 0.1], velocity: [2, 0, 0]}\n"
        "  b: {shape: {sphere: 0.2}, mass: 2, position: [0.5, 0.02, 0.1]}",
        "restitution: 0.5"},
       2e-3,
       2e-2},
      {"row of balls with gaps",
       {"  a: {shape: {sphere: 0.2}, mass: 1, position: [0, 0, 0.1], velocity: [1, 0, 0]}\n"
        "  b: {shape: {sphere: 0.2}, mass: 1, position: [0.212, 0, 0.1]}\n"
        "  c: {shape: {sphere: 0.2}, mass: 1, position: [0.424, 0, 0.1]}",
        "restitution: 1", 0.1},
       2e-3,
       2e-2},
      {"ball on a wedge",
       {"  w: {mass: 4, position: [0, 0, 0], inertia: [0.05, 0.1, 0.1], shape: {hull: {points: "
        "[[-0.3, -0.1, 0], [0.3, -0.1, 0], [-0.3, 0.1, 0], [0.3, 0.1, 0], [-0.3, -0.1, 0.2], "
        "[-0.3, 0.1, 0.2]]}}}\n"
        "  b: {shape: {sphere: 0.1}, mass: 1, position: [-0.084188612, 0, 0.18076805]}",
        "friction: 0", 0.15},
       1e-4,
       2e-3},
      {"spinning ball",
       {"  a: {shape: {sphere: 0.2}, mass: 1, position: [0, 0, 0.1], angular_velocity: [0, 30, 0]}",
        "friction: 0.2"},
       1e-5,
       1e-5},
      {"tilted coin",
       {"  a: {shape: {cylinder: [0.3, 0.02]}, mass: 1, position: [0, 0, 0.2],\n"
        "      angular_velocity: [0, 8, 15], orientation: {axis: [1, 0, 0], angle: 0.8}}",
        "friction: 0.3", 0.3},
       5e-4,
       5e-3}};
  for (const Compared& c : cases) {
    Simulation barrier = c.scene.with("barrier", 2.5e-4);
    ASSERT_EQ(barrier.run().end, RunEnd::finished) << c.name;
    const std::vector<double> expected = motions(barrier);
    for (const double step : {5e-3, 1e-3, 2.5e-4}) {
      Simulation impulses = c.scene.with("nonsmooth", step);
      ASSERT_EQ(impulses.run().end, RunEnd::finished) << c.name;
      const std::vector<double> found = motions(impulses);
      const double part = std::max(1.0, step / 1e-3);
      for (std::size_t k = 0; k < found.size(); ++k)
        EXPECT_NEAR(found[k], expected[k], part * (k % 2 == 0 ? c.place : c.speed))
            << c.name << ", " << step << ", number " << k;
    }
  }
}

/// Gap, energy lost in impacts and rise of energy of a frictionless coin that spins, tilted, on the
/// floor: no penetration, and no loss except in its first impact, after a fall of 0.5 mm.
/// @tests{nonsmooth-exit} @tests{contact-direction}
TEST(NonsmoothLaw, NothingRollsOrSlidesIntoTheFloor) {
  const Scene coin{
      "  a: {shape: {cylinder: [0.3, 0.02]}, mass: 1, position: [0, 0, 0.115],\n"
      "      angular_velocity: [0, 8, 15], orientation: {axis: [1, 0, 0], angle: 0.8}}",
      "friction: 0", 0.5};
  const Scene egg{
      "  a: {shape: {ellipsoid: [0.3, 0.3, 0.2]}, mass: 1, position: [0, 0, 0.1],\n"
      "      velocity: [1, 0, 0], angular_velocity: [3, 2, 10]}",
      "friction: 0", 0.5};
  for (const Scene& scene : {coin, egg}) {
    double lost_before = 0.0;
    for (const double step : {5e-3, 1e-3, 1e-4}) {
      Simulation run = scene.with("nonsmooth", step);
      const Balance start = run.balance();
      const RunSummary done = run.run();
      ASSERT_EQ(done.end, RunEnd::finished);
      EXPECT_GT(done.contacts->least_gap, -0.1 * kG * step * step) << step;
      EXPECT_LT(done.contacts->numerical, 1e-6) << step;
      EXPECT_LT(done.contacts->lost_in_impacts, 5e-3 * (start.kinetic + 1.0)) << step;
      if (lost_before > 0.0) {
        EXPECT_NEAR(done.contacts->lost_in_impacts, lost_before, 1e-3) << step;
      }
      lost_before = done.contacts->lost_in_impacts;
      EXPECT_TRUE(done.warnings.empty()) << step;
    }
  }
}

/// A ton on a gram: solved to the tolerance or refused with names, but never with penetration.
TEST(NonsmoothLaw, PreventsPenetrationUnderHeavyBodies) {
  for (const Pile& pile : kPiles)
    for (const double step : {1e-2, 1e-3, 1e-4}) {
      const Scene scene{pile.bodies, "friction: 0.5"};
      Simulation run = scene.with("nonsmooth", step, 0.2);
      const RunSummary done = run.run();
      EXPECT_EQ(done.end, RunEnd::finished) << pile.name;
      EXPECT_TRUE(done.warnings.empty()) << pile.name << ' ' << step;
      EXPECT_GT(done.contacts->least_gap, -5e-6) << pile.name << ' ' << step;
      const double upper = pile.masses[1] * kG;
      EXPECT_NEAR(run.contact(run.contact_pair(1, 2)).normal_force, upper, 4e-3 * upper)
          << pile.name << ' ' << step;
    }
}

/// Gaps, forces and energy of a stack whose light boxes lie below heavy ones, with rolling
/// friction: sweeps alone let it collapse by millimetres. @tests{nonsmooth-projection}
TEST(NonsmoothLaw, SupportsHeavyBoxesOnLightOnesWithRollingFriction) {
  const Scene scene{
      "  a: {shape: {box: [0.2, 0.2, 0.1]}, mass: 0.01, position: [0, 0, 0.05]}\n"
      "  b: {shape: {box: [0.2, 0.2, 0.1]}, mass: 5, position: [0.01, 0, 0.15]}\n"
      "  c: {shape: {box: [0.2, 0.2, 0.1]}, mass: 0.2, position: [0, 0.01, 0.25]}\n"
      "  d: {shape: {box: [0.2, 0.2, 0.1]}, mass: 2, position: [0, 0, 0.35]}",
      "friction: 0.5, rolling_friction: 1 mm", 0.3};
  for (const double step : {1e-2, 1e-3, 1e-4}) {
    Simulation run = scene.with("nonsmooth", step);
    const RunSummary done = run.run();
    ASSERT_EQ(done.end, RunEnd::finished) << step;
    EXPECT_TRUE(done.warnings.empty()) << step;
    EXPECT_GT(done.contacts->least_gap, -1e-6) << step;
    EXPECT_LT(done.contacts->lost_in_impacts, 1e-5) << step;
    EXPECT_LT(std::abs(done.contacts->numerical), 1e-6) << step;
    const double weight = 7.21 * kG;
    EXPECT_NEAR(run.contact(run.contact_pair(0, 1)).normal_force, weight, 2e-3 * weight) << step;
  }
}

/// A flat ellipsoid that spins about its diameter close to the floor: at the start the point that
/// is nearest does not approach, within a step another one meets the floor.
/// @tests{contact-direction}
TEST(NonsmoothLaw, NothingSpinsIntoTheFloor) {
  for (const double spin : {50.0, 100.0})
    for (const double step : {1e-2, 5e-3, 1e-3, 1e-4}) {
      const Scene scene{
          format("  a: {{shape: {{ellipsoid: [0.1, 0.1, 0.03]}}, mass: 0.5, position: [0, 0, "
                 "0.033], angular_velocity: [{}, 0, 0]}}",
                 spin),
          "friction: 0", 0.1};
      Simulation run = scene.with("nonsmooth", step);
      const RunSummary done = run.run();
      ASSERT_EQ(done.end, RunEnd::finished) << spin << ' ' << step << ": " << done.message;
      EXPECT_GT(done.contacts->least_gap, -std::min(9e-5, 20.0 * step * step))
          << spin << ' ' << step;
      EXPECT_LT(std::abs(done.contacts->numerical), 1e-12) << spin << ' ' << step;
    }
}

/// A bar that falls askew on a fixed one, edges first: in a step of 10 ms it moves by its own
/// thickness, and the edges cross only at the end of it.
TEST(NonsmoothLaw, NoEdgePassesThroughAnother) {
  for (const double speed : {2.0, 5.0})
    for (const double step : {1e-2, 5e-3, 1e-3, 2e-4}) {
      Scene scene{
          format("  rail: {{fixed: true, shape: {{box: [1, 0.02, 0.02]}}, position: [0.45, 0, 0], "
                 "orientation: {{axis: x, angle: 45 deg}}}}\n"
                 "  a: {{shape: {{box: [0.02, 1, 0.02]}}, mass: 1, position: [-0.07, 0, 0.05], "
                 "orientation: {{axis: y, angle: 45 deg}}, velocity: [{0}, 0, -{0}]}}",
                 speed),
          "friction: 0", 0.1};
      scene.floor.clear();
      Simulation run = scene.with("nonsmooth", step);
      double lowest = 1.0;
      const RunSummary done = run.run({}, [&](const Simulation& s) {
        if (s.body("a").r.x() > -0.03) lowest = std::min(lowest, s.body("a").r.z());
      });
      ASSERT_EQ(done.end, RunEnd::finished) << step << ": " << done.message;
      // The bar may have turned onto one of its faces.
      EXPECT_GT(lowest, 0.01 * (1.0 + std::sqrt(2.0)) - 1e-4) << speed << ' ' << step;
    }
}

/// A heavy slab that would sink into the boxes below it, with few sweeps and with too many points
/// for the other searches.
TEST(NonsmoothLaw, NamesBodiesThatWouldOverlap) {
  std::string bodies =
      "  heavy: {shape: {box: [2, 2, 0.5]}, mass: 1000000, position: [0, 0, 0.55]}";
  for (int k = 0; k < 49; ++k)
    bodies += format(
        "\n  b{}: {{shape: {{box: [0.2, 0.2, 0.3]}}, mass: 0.001, position: [{}, {}, 0.15]}}", k,
        0.25 * (k % 7 - 3), 0.25 * (k / 7 - 3));
  const Scene scene{bodies, "friction: 0.5", 0.5};
  Model model = scene.with("nonsmooth", 1e-2).model();
  model.contacts.sweeps = 1;
  Simulation run(model);
  const RunSummary done = run.run();
  EXPECT_EQ(done.end, RunEnd::not_converged);
  EXPECT_NE(done.message.find("'heavy'"), std::string::npos) << done.message;
  EXPECT_NE(done.message.find("would overlap"), std::string::npos) << done.message;
  EXPECT_NE(done.message.find("contacts.sweeps"), std::string::npos) << done.message;
  ASSERT_FALSE(done.warnings.empty());
  EXPECT_NE(done.warnings.back().find("ended above sweep_tolerance"), std::string::npos);
}

}  // namespace
}  // namespace polhode::nonsmooth_law_tests
