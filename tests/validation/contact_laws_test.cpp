// SPDX-License-Identifier: Apache-2.0
// Spring laws of contact: forces at rest and rebound at any step.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <polhode/core/error.hpp>

#include "validation/contact_law_scenes.hpp"

namespace polhode::contact_laws_tests {
namespace {

using namespace contact_law_scenes;

/// Spring laws carry bodies at rest for any masses and steps; no body rises.
/// @tests{spring-stiffness}
TEST(SpringLaws, SupportAnyBodyOfTheModel) {
  for (const Pile& pile : kPiles)
    for (const char* law : {"hertz", "linear"})
      for (const double step : {1e-2, 5e-3, 1e-3, 1e-4}) {
        const std::string where = format("{}, {}, {} s", pile.name, law, step);
        const Scene scene{pile.bodies, "friction: 0.5"};
        Simulation run = scene.with(law, step, step > 1e-3 ? 1.0 : 0.4);
        double rise = 0.0;
        const std::vector<double> start = {run.body(1).r.z(), run.body(2).r.z()};
        ASSERT_EQ(run.run({},
                          [&](Simulation& s) {
                            for (int k = 0; k < 2; ++k)
                              rise = std::max(rise, s.body(k + 1).r.z() - start[k]);
                          })
                      .end,
                  RunEnd::finished)
            << where;
        const double upper = pile.masses[1] * kG, both = upper + pile.masses[0] * kG;
        EXPECT_NEAR(run.contact(run.contact_pair(0, 1)).normal_force, both, 1e-5 * both) << where;
        EXPECT_NEAR(run.contact(run.contact_pair(1, 2)).normal_force, upper, 1e-5 * both) << where;
        EXPECT_LT(rise, 1e-12) << where;
      }
}

/// Speed of rebound over that of approach, of a ball that falls by 5 cm, from its apex, and the
/// mean number of iterations.
std::pair<double, double> rebound(const Scene& scene, const std::string& law, double step) {
  Simulation run = scene.with(law, step);
  double highest = 0.0;
  bool back = false;
  const RunSummary done = run.run({}, [&](Simulation& s) {
    back = back || s.body(1).v.z() > 0.0;
    if (back) highest = std::max(highest, s.body(1).r.z() - 0.1);
  });
  EXPECT_EQ(done.end, RunEnd::finished);
  return {std::sqrt(highest / 0.05),
          static_cast<double>(done.newton_iterations) / static_cast<double>(done.steps)};
}

/// Restitution e at the surface at any step, by the turn law and by a damper, whose stiffness
/// depends on the impact and not on the step. The apex lies between two steps: 2.5e-3 at 10 ms.
/// @tests{turn-law} @tests{contact-damped}
TEST(SpringLaws, ReboundAsStatedAtAnyStep) {
  for (const char* law : {"hertz", "linear"})
    for (const auto& [e, damped] :
         {std::pair(0.0, false), std::pair(0.5, false), std::pair(1.0, false), std::pair(0.3, true),
          std::pair(0.8, true)})
      for (const double step : {1e-2, 1e-3, 1e-4, 1e-5}) {
        const std::string where = format("{}, e = {}, damped: {}, {} s", law, e, damped, step);
        const Scene scene{kBall, format("restitution: {}{}", e, damped ? ", rebound: damped" : ""),
                          step > 5e-5 ? 0.3 : 0.16 + 0.05 * e};
        const auto [part, iterations] = rebound(scene, law, step);
        EXPECT_NEAR(part, e == 1.0 && step < 5e-5 ? part : e, 4e-3) << where;
        EXPECT_LT(iterations, 6.0) << where;
      }
}

/// A block on a slope between the coefficients of sliding and static friction sticks at any step,
/// not only at coarse ones.
/// @tests{contact-patch}
TEST(SpringLaws, HoldABlockOnASlopeAtAnyStep) {
  for (const char* law : {"barrier", "hertz", "linear"})
    for (const char* block : {kBox, kCube})
      for (const double step : {1e-2, 1e-3, 1e-4}) {
        const std::string where = format("{}, {} s, {}", law, step, block);
        Scene scene{block, "friction: 0.5, static_friction: 0.6", 0.2, 0.55};
        Simulation run = scene.with(law, step);
        ASSERT_EQ(run.run().end, RunEnd::finished) << where;
        EXPECT_LT(run.body(1).r.x(), 2e-4) << where;
        EXPECT_LT(run.body(1).v.norm(), 4e-4) << where;
        // Above the bound of static friction it slides by ½ g (sin − μ cos) t², once it is faster
        // than after two steps of gravity.
        scene.slope = 0.7;
        Simulation slides = scene.with(law, step);
        ASSERT_EQ(slides.run().end, RunEnd::finished) << where;
        const double a = std::atan(0.7), way = 0.02 * kG * (std::sin(a) - 0.5 * std::cos(a));
        EXPECT_LT(slides.body(1).r.x(), 1.01 * way) << where;
        EXPECT_GT(slides.body(1).r.x(), (step > 5e-3 ? 0.4 : 1.0 - 0.02 - 150.0 * step) * way)
            << where;
      }
}

/// Smallest gap of a body on a plane with a spring law, through a restart.
// Springs of given stiffness that are too soft for the rounded edges of their boxes: below them
// nothing passes, energy is exact, and a warning names the pair.
// @tests{spring-floor}
TEST(SpringLaws, LimitPenetrationToTheRoundingOfEdges) {
  const std::string bodies =
      "  crate: {fixed: true, shape: {box: [1, 1, 0.2]}, position: [0, 0, -0.1]}\n"
      "  a: {shape: {box: [0.2, 0.2, 0.2]}, mass: 1, position: [0, 0, 0.1]}";
  const double rounding = 2e-4;
  for (const char* law : {"linear, stiffness: 1e4", "hertz, hertz_stiffness: 1e6"})
    for (const double step : {1e-2, 1e-3, 1e-4}) {
      SCOPED_TRACE(format("{} at {} s", law, step));
      Simulation s = Scene{bodies, "friction: 0.3"}.with(law, step);
      const RunSummary end = s.run();
      EXPECT_LT(s.body("a").v.norm(), 1e-6);
      EXPECT_LT(end.contacts->least_gap, -0.6 * rounding);
      EXPECT_GT(end.contacts->least_gap, -0.9 * rounding);
      EXPECT_LT(end.energy_drift, 1e-12);
      EXPECT_NEAR(s.point("a", Vec3::Zero()).acceleration.norm(), 0.0, 1e-3);
      EXPECT_TRUE(std::any_of(end.warnings.begin(), end.warnings.end(), [](const auto& warning) {
        return warning.find("'crate' and 'a' penetrated each other") != std::string::npos;
      }));
    }
  // A stiffness that carries the box, by four corners or more, without that warning.
  Simulation s = Scene{bodies, "friction: 0.3"}.with("linear, stiffness: 1e6", 1e-3);
  const RunSummary end = s.run();
  EXPECT_LT(s.body("a").r.z() - 0.1, -kG / 1e7);
  EXPECT_GT(s.body("a").r.z() - 0.1, -kG / 4e6 - 1e-8);
  for (const std::string& warning : end.warnings)
    EXPECT_EQ(warning.find("penetrated each other"), std::string::npos) << warning;
}

/// Depth at rest after a fall of 10 mm onto a flat height field while sliding: that of a plane at
/// any size of cells and any step, as long as the rounding of the edges is not reached; otherwise
/// less than it, with a warning.
TEST(SpringLaws, RestOnFlatTrianglesAsOnAPlane) {
  const auto fall = [](double cell, double stiffness, double step) {
    const int n = static_cast<int>(std::lround(0.6 / cell)) + 1;
    std::string row = "[0";
    for (int k = 1; k < n; ++k) row += ", 0";
    row += "]";
    std::string heights = row;
    for (int k = 1; k < n; ++k) heights += ", " + row;
    return Scene{format("  field: {{fixed: true, position: [0, 0, 0], shape: {{height_field: "
                        "{{spacing: {}, heights: [{}]}}}}}}\n"
                        "  a: {{shape: {{box: [0.2, 0.2, 0.2]}}, mass: 10, position: [0.013, "
                        "0.007, 0.11], velocity: [0.5, 0, 0]}}",
                        cell, heights),
                 "friction: 0, restitution: 0", 0.3, 0.0, ""}
        .with(format("linear, stiffness: {}", stiffness), step);
  };
  const auto says_overlapped = [](const RunSummary& end) {
    return std::any_of(end.warnings.begin(), end.warnings.end(), [](const auto& warning) {
      return warning.find("'field' and 'a' penetrated each other") != std::string::npos;
    });
  };
  for (const double cell : {0.2, 0.05, 0.01})
    for (const double step : {1e-2, 1e-3, 2e-4}) {
      SCOPED_TRACE(format("cells of {} m at {} s", cell, step));
      Simulation s = fall(cell, 1e6, step);
      const RunSummary end = s.run();
      EXPECT_NEAR(s.body("a").r.z(), 0.1 - 10.0 * kG / 4e6, 1e-9);
      EXPECT_NEAR(s.body("a").v.x(), 0.5, 1e-12);
      EXPECT_LT(end.energy_drift, 1e-12);
      Simulation soft = fall(cell, 2e3, step);
      const RunSummary soft_end = soft.run();
      EXPECT_GT(soft_end.contacts->least_gap, -3e-4);
      EXPECT_LT(soft_end.energy_drift, 1e-12);
      EXPECT_TRUE(says_overlapped(soft_end));
    }
}

TEST(SpringLaws, ReboundFromTheRoundingOfEdges) {
  const std::string bodies =
      "  crate: {fixed: true, shape: {box: [1, 1, 0.2]}, position: [0, 0, -0.1]}\n"
      "  a: {shape: {box: [0.2, 0.2, 0.2]}, mass: 1, position: [0, 0, 0.11], velocity: [0, 0, -2]}";
  for (const char* law : {"linear, stiffness: 1e5", "hertz, hertz_stiffness: 1e7"})
    for (const double e : {0.0, 0.5, 1.0})
      for (const double step : {5e-3, 1e-3, 1e-4, 1e-5}) {
        SCOPED_TRACE(format("{} e {} at {} s", law, e, step));
        Simulation s =
            Scene{bodies, format("restitution: {}, friction: 0", e)}.with(law, step, 0.02);
        const RunSummary end = s.run();
        EXPECT_GT(end.contacts->least_gap, -0.9 * 2e-4);
        EXPECT_LT(end.energy_drift, 2e-11);
        const double approach = std::sqrt(4.0 + 2.0 * kG * 0.01);
        const double v = s.body("a").v.z(), z = s.body("a").r.z() - 0.1;
        const double squared = v * v + 2.0 * kG * z;  // of the separation
        if (e > 0.0) {
          EXPECT_NEAR(std::sqrt(squared), e * approach, 2e-3 * approach);
        } else {
          EXPECT_LT(std::abs(v), 0.05 * approach);  // its spring swings, damped
        }
      }
}

// Without gravity springs are chosen for impacts of two bodies: here a third drives one into the
// floor. Nothing gets deeper than four tolerances, also in the plane; energy is exact up to the
// rounding of positions that close to the floor.
// @tests{spring-floor}
TEST(SpringLaws, LimitPenetrationUnderSeveralBodies) {
  const std::string model = R"(
format: 1
gravity: [0, 0, 0]
bodies:
  floor: {fixed: true, shape: {plane: z}}
  a: {shape: {sphere: 0.1}, mass: 0.001, position: [0, 0, 0.0501], velocity: [0, 0, -0.1]}
  b: {shape: {sphere: 0.1}, mass: 10, position: [0, 0, 0.1502], velocity: [0, 0, -2]}
contacts: {default: {restitution: 1, friction: 0}}
analysis: {duration: 0.02 s, step: 1 ms}
)";
  const double tolerance = 5e-5;  // 1e-3 of the radius
  for (const char* law : {"linear", "hertz"})
    for (const char* step : {"10 ms", "1 ms", "0.1 ms", "0.01 ms"}) {
      SCOPED_TRACE(format("{} {}", law, step));
      Simulation s(io::read_model_text(
          model, "m.yaml",
          {format("contacts.default.law={}", law), format("analysis.step={}", step)}));
      const RunSummary end = s.run();
      EXPECT_EQ(end.end, RunEnd::finished);
      EXPECT_GT(end.contacts->least_gap, -4.0 * tolerance);
      EXPECT_LT(end.energy_drift, 1e-9);
      EXPECT_GT(s.body("b").v.z(), 0.0) << "the heavy ball goes back up";
    }
}

TEST(SpringLaws, RecordTheSmallestGap) {
  const Scene scene{kBall, "restitution: 0.5", 0.3};
  for (const char* law : {"hertz", "linear"}) {
    Simulation straight = scene.with(law, 1e-3);
    const double least = straight.run().contacts->least_gap;
    Simulation half = scene.with(law, 1e-3);
    while (half.time() < 0.2) half.step(0.2);
    Simulation rest(half.model(), half.state());
    EXPECT_EQ(rest.run().contacts->least_gap, least) << law;
    EXPECT_LT(least, -1e-5) << law;
    EXPECT_GT(least, -2e-4) << law;
  }
}

}  // namespace
}  // namespace polhode::contact_laws_tests
