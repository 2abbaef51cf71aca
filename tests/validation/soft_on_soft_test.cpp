// SPDX-License-Identifier: Apache-2.0
// A soft block pressed on another one: its nodes lie over middles, edges and corners of faces.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include <polhode/core/format.hpp>
#include <polhode/io/read/read_model.hpp>
#include <polhode/simulation/simulation_details.hpp>

namespace polhode::test::soft_on_soft_tests {
namespace {

/// Block of 50 mm square and 20 mm height that is pressed by 5 mm onto one of 100 mm and 30 mm.
/// @param x, y, gap  Its displacement aside and its height above the other one, in mm.
/// @param cells  Along its sides and along those of the other one.
std::string blocks(double x, double y, double gap, const std::string& time,
                   const std::string& material, const std::string& analysis,
                   const std::string& element = "hex8", std::pair<int, int> cells = {2, 3}) {
  return format(R"(
format: 1
materials: {{s: {{type: neo_hookean, youngs_modulus: 1 MPa, poisson_ratio: 0.0, density: 1000{1}}}}}
bodies: {{ram: {{mass: 1, inertia: [1, 1, 1], position: [0, 0, 0.06], motion: {{x: 0, y: 0, z: "-0.005{2}", rotation_vector: [0, 0, 0]}}}}}}
solids:
  u: {{mesh: {{block: {{size: [0.05, 0.05, 0.02], cells: [{7}, {7}, 1]}}, position: [{3}, {4}, {5}]}}, element: {0}, material: s, bonded: {{ram: zmax}}, contact: {{surface: zmin}}}}
  l: {{mesh: {{block: {{size: [0.1, 0.1, 0.03], cells: [{8}, {8}, 1]}}, position: [0, 0, 0.015]}}, element: {0}, material: s, bonded: {{ground: zmin}}, contact: {{surface: zmax}}}}
contacts: {{}}
analysis: {6}
)",
                element, material, time, 1e-3 * x, 1e-3 * y, 0.04 + 1e-3 * gap, analysis,
                cells.first, cells.second);
}

/// From any start, centred or aside, an equilibrium is found, and the force is one curve of the
/// way: the secant of those at the smallest and the largest gap passes within 1 % of all. The force
/// with a gap of 0.3 mm is 385.1 N by dynamics with a loose tolerance before edges were rounded.
// @tests{patch-force} @tests{mesh-contact}
TEST(SoftOnSoft, FindsTheEquilibriumFromEveryStart) {
  const auto force = [](double x, double y, double gap) {
    Simulation s(io::read_model_text(blocks(x, y, gap, "", "", "{type: statics}"), "punch.yaml"));
    const RunSummary summary = s.run();
    EXPECT_EQ(summary.end, RunEnd::finished) << gap << ' ' << summary.message;
    return std::abs(s.contact(0).force[2]);
  };
  const double first = force(0.0, 0.0, 0.1), last = force(0.0, 0.0, 1.0);
  for (const double gap : {0.15, 0.2, 0.25, 0.3, 0.4}) {
    const double line = first + (last - first) * (gap - 0.1) / 0.9, here = force(0.0, 0.0, gap);
    EXPECT_NEAR(here / line, 1.0, 0.01) << gap;
    if (gap == 0.3) {
      EXPECT_NEAR(here, 385.1, 0.005 * 385.1);
    }
    // Aside the punch is as stiff, but for the places of its edges on the coarse mesh below.
    if (gap == 0.2) {
      EXPECT_NEAR(force(1.3, 0.78, gap) / here, 1.0, 0.005);
    }
  }
}

/// Centred, nothing draws the punch aside: at every number of load steps there is no lateral force,
/// and the equilibrium is stable and the same one. Points of the block below that lay exactly under
/// the border of the other one could slip past it: of 40 gaps 9 ended in other stable equilibria
/// with lateral forces up to 2 N, and load steps had to be divided where Newton's method came to
/// unstable ones. The gap of 1 mm is one in which contact begins in the middle of a load step.
// @tests{mesh-contact} @tests{patch-force}
TEST(SoftOnSoft, RemainsSymmetricAndStableAtAnyNumberOfLoadSteps) {
  for (const double gap : {0.1, 0.3, 0.7, 0.8, 1.0, 1.1}) {
    double first = 0.0;
    for (const char* steps : {"", ", load_steps: 1", ", load_steps: 3", ", load_steps: 20"}) {
      SCOPED_TRACE(std::to_string(gap) + steps);
      Simulation s(io::read_model_text(
          blocks(0.0, 0.0, gap, "", "", format("{{type: statics{}}}", steps)), "punch.yaml"));
      const RunSummary summary = s.run();
      ASSERT_EQ(summary.end, RunEnd::finished) << summary.message;
      ASSERT_TRUE(summary.statics.has_value());
      EXPECT_EQ(summary.statics->unstable, 0);
      EXPECT_TRUE(summary.statics->limit_points.empty());
      const Vec3 force = s.contact(0).force;
      EXPECT_LT(force.head<2>().norm(), 1e-7);
      if (first == 0.0) first = force[2];
      EXPECT_NEAR(force[2] / first, 1.0, 1e-7);
    }
  }
}

/// In motion, at a coarse step, a tenth and a hundredth of it, the balances close at each. The
/// coarse step is a tenth of the time in which the punch comes down, and may be refused; the others
/// are not, and they take fewer iterations the shorter they are: at a kink of the gap iterations
/// would alternate whatever the step.
// @tests{patch-force}
TEST(SoftOnSoft, IsPressedAtEveryStep) {
  const std::string time = "*(t<0.5 ? 0.5-0.5*cos(pi*t/0.5) : 1)",
                    viscous = ", viscosity: {relaxation_time: 10 ms}";
  double iterations = std::numeric_limits<double>::infinity();  // in a step of the run before
  for (const char* analysis : {"{duration: 0.8, step: 50 ms}", "{duration: 0.2, step: 5 ms}",
                               "{duration: 0.08, step: 0.5 ms}"}) {
    SCOPED_TRACE(analysis);
    Simulation s(io::read_model_text(blocks(0.0, 0.0, 0.3, time, viscous, analysis), "p.yaml"));
    const RunSummary summary = s.run();
    ASSERT_EQ(summary.end, RunEnd::finished) << summary.message;
    if (std::isfinite(iterations)) {
      EXPECT_EQ(summary.rejected_steps, 0);
    }
    const double now =
        static_cast<double>(summary.newton_iterations) / static_cast<double>(summary.steps);
    EXPECT_LT(now, iterations);
    iterations = now;
    EXPECT_LT(summary.energy_drift, 1e-11);
    EXPECT_LT(summary.linear_momentum_drift, 1e-10);
    EXPECT_LT(summary.angular_momentum_drift, 1e-10);
    EXPECT_GT(s.contact(0).normal_force, 1.0);
  }
}

/// Fine meshes touch in more points than sweeps solve: some of the hundreds of rows of their first
/// impact missed their law by 1e-4 of the speeds, and shorter steps were no better. A coarse step,
/// a tenth and a hundredth of it.
// @tests{row-problem}
TEST(SoftOnSoft, ImpactsOfFineMeshesMeetTheirLaw) {
  const std::string time = "*(t<0.5 ? 0.5-0.5*cos(pi*t/0.5) : 1)",
                    viscous = ", viscosity: {relaxation_time: 10 ms}";
  for (const char* analysis : {"{duration: 0.05, step: 50 ms}", "{duration: 0.045, step: 5 ms}",
                               "{duration: 0.034, step: 0.5 ms}"}) {
    SCOPED_TRACE(analysis);
    Simulation s(io::read_model_text(
        blocks(0.0, 0.0, 0.05, time, viscous, analysis, "hex8", {3, 9}), "p.yaml"));
    const RunSummary summary = s.run();
    ASSERT_EQ(summary.end, RunEnd::finished) << summary.message;
    EXPECT_TRUE(summary.trusted()) << testing::PrintToString(summary.distrust);
    EXPECT_LT(summary.energy_drift, 1e-11);
    EXPECT_LT(summary.linear_momentum_drift, 1e-10);
    EXPECT_GT(s.contact(0).normal_force, 0.0);
  }
}

/// Likewise of triangles, as of wedges and tetrahedra, and of quadratic faces, at which iterations
/// alternated at kinks (a tenth of a second of motion took minutes): with triangles in one
/// direction the meshes have no symmetry.
// @tests{patch-triangles}
TEST(SoftOnSoft, OfTrianglesAndQuadraticFacesIsPressedAtEveryStep) {
  const std::string time = "*(t<0.5 ? 0.5-0.5*cos(pi*t/0.5) : 1)",
                    viscous = ", viscosity: {relaxation_time: 10 ms}";
  for (const char* element : {"wedge6", "hex20", "tet15"})
    for (const char* analysis : {"{duration: 0.16, step: 20 ms}", "{duration: 0.1, step: 5 ms}",
                                 "{duration: 0.055, step: 0.5 ms}"}) {
      SCOPED_TRACE(element + std::string(analysis));
      Simulation s(
          io::read_model_text(blocks(0.0, 0.0, 0.1, time, viscous, analysis, element), "p.yaml"));
      const RunSummary summary = s.run();
      ASSERT_EQ(summary.end, RunEnd::finished) << summary.message;
      EXPECT_LE(summary.rejected_steps, 2);
      EXPECT_LT(summary.newton_iterations, 25 * summary.steps);
      EXPECT_LT(summary.energy_drift, 1e-11);
      EXPECT_LT(summary.linear_momentum_drift, 1e-10);
      EXPECT_LT(summary.angular_momentum_drift, 1e-10);
      EXPECT_GT(s.contact(0).normal_force, 1.0);
    }
}

/// In statics the equilibrium of triangles and quadratic faces is stable and the same one at any
/// number of load steps. Two blocks of tet15, with faces of seven nodes, have two stable ones;
/// their forces differ by 0.07 %.
// @tests{patch-triangles}
TEST(SoftOnSoft, OfTrianglesAndQuadraticFacesHasOneEquilibrium) {
  for (const char* element : {"wedge6", "hex20"}) {
    Vec3 first = Vec3::Zero();
    for (const char* steps : {"", ", load_steps: 1", ", load_steps: 20"}) {
      SCOPED_TRACE(element + std::string(steps));
      Simulation s(io::read_model_text(
          blocks(0.0, 0.0, 0.3, "", "", format("{{type: statics{}}}", steps), element), "p.yaml"));
      const RunSummary summary = s.run();
      ASSERT_EQ(summary.end, RunEnd::finished) << summary.message;
      ASSERT_TRUE(summary.statics.has_value());
      EXPECT_EQ(summary.statics->unstable, 0);
      const Vec3 force = s.contact(0).force;
      if (first.isZero()) first = force;
      EXPECT_LT((force - first).norm(), 1e-7 * first.norm());
    }
  }
}

}  // namespace
}  // namespace polhode::test::soft_on_soft_tests
