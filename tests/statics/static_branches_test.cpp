// SPDX-License-Identifier: Apache-2.0
// Loads at which equilibria lose their stability or end, whatever the load steps.
#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <polhode/core/format.hpp>
#include <polhode/io/read/read_model.hpp>
#include <polhode/simulation/simulation_details.hpp>

namespace polhode::static_branches_tests {
namespace {

using ::testing::HasSubstr;

RunSummary run_of(const std::string& text, const io::Overrides& overrides) {
  Simulation s(io::read_model_text(text, "branch.yaml", overrides));
  return s.run();
}

/// A rigid column on a torsional spring of 10 N m/rad buckles under 10 N at 1 m. Its stiffness is
/// linear in the load, so that interpolation meets the singular tangent exactly.
TEST(StaticBranches, AColumnOnASpringBucklesAtItsLoadForAnyLoadAndSteps) {
  const char* column = R"(
format: 1
variables: {F: 40, n: 10}
bodies: {a: {mass: 1, inertia: [1, 1, 1], position: [0, 0, 0.5]}}
joints: {j: {type: revolute, bodies: [ground, a], at: [0, 0, 0], axis: y}}
loads:
  s: {type: torsional_spring, joint: j, stiffness: 10}
  f: {type: force, body: a, at: [0, 0, 1], force: [0, 0, -F]}
analysis: {type: statics, load_steps: n}
output: {hdf5: false}
)";
  for (int F = 11; F <= 40; ++F)
    for (const int n : {1, 10, 100}) {
      const RunSummary r =
          run_of(column, {format("variables.F={}", F), format("variables.n={}", n)});
      ASSERT_EQ(r.statics->limit_points.size(), 1u) << F << ' ' << n;
      EXPECT_NEAR(r.statics->limit_points[0].load_factor, 10.0 / F, 2e-6) << F << ' ' << n;
      EXPECT_THAT(r.statics->limit_points[0].motion, HasSubstr("'a' rotates about y"));
      EXPECT_EQ(r.statics->unstable, 1);
    }
}

// S.-L. Lee, F. S. Manuel, E. C. Rossow, J. Eng. Mech. Div. ASCE 94 (1968) 527-548.
constexpr const char* kLee = R"(
format: 1
variables: {P: 20000}
materials: {m: {type: elastic, youngs_modulus: 7.2 GPa, poisson_ratio: 0.3, density: 2700}}
sections:
  s: {type: rectangle, height: 0.02, width: 0.3, material: m}
beams:
  frame: {points: [[0, 0, 0], [0, 0, 1.2], [1.2, 0, 1.2]], elements: 20, section: s, up: [-1, 0, 1]}
joints:
  foot: {type: revolute, bodies: [ground, frame.start], at: [0, 0, 0], axis: y}
  end: {type: revolute, bodies: [ground, frame.end], at: [1.2, 0, 1.2], axis: y}
loads: {p: {type: force, body: frame.12, force: [0, 0, -P]}}
analysis: {type: statics, load_steps: 10}
output: {hdf5: false}
)";
/// Of this mesh; 18,544.76 N of a fine one.
constexpr double kLimit = 18548.0;

/// Steps that end below the limit report it, by the stiffness that vanishes there.
/// @tests{statics-limit-point}
TEST(StaticBranches, LeesFrameReportsItsLimitLoadWithGivenLoadSteps) {
  for (const int n : {5, 10, 20, 200}) {
    const RunSummary r = run_of(kLee, {format("analysis.load_steps={}", n)});
    ASSERT_EQ(r.statics->limit_points.size(), 1u) << n;
    EXPECT_NEAR(20000.0 * r.statics->limit_points[0].load_factor, kLimit, 3e-4 * kLimit) << n;
  }
}

/// Below the limit the branch from the unloaded state reaches the load, although Newton's method
/// with the whole load finds a distant and unstable equilibrium.
TEST(StaticBranches, ALoadBelowTheLimitIsCarriedByTheBranchFromTheUnloadedState) {
  for (const double P : {15000.0, 18000.0, 18500.0}) {
    const RunSummary whole = run_of(kLee, {format("variables.P={}", P), "analysis.load_steps=1"});
    EXPECT_EQ(whole.end, RunEnd::finished) << whole.message;
    EXPECT_EQ(whole.statics->unstable, 0) << P;
    EXPECT_TRUE(whole.statics->limit_points.empty()) << P;
    const RunSummary many = run_of(kLee, {format("variables.P={}", P), "analysis.load_steps=50"});
    EXPECT_NEAR(whole.strain_energy, many.strain_energy, 1e-6 * many.strain_energy) << P;
  }
}

/// A column whose weight stands 1 mm off its axis: under 1.5 times the buckling load the branch
/// from the unloaded state has no limit point and leads to 1.4959 rad, a root of the balance of
/// moments θ = 1.5 (sin(θ) + 0.001 cos(θ)). Newton's method finds the unstable branch at −0.003 rad
/// and the one of the other side easily. @tests{statics-jump}
TEST(StaticBranches, AnImperfectColumnFollowsItsBranchBeyondBuckling) {
  double root = 1.5;
  for (int i = 0; i < 50; ++i) root = 1.5 * (std::sin(root) + 1e-3 * std::cos(root));
  for (const std::string history : {"", "analysis.history=1"})
    for (const int n : {1, 2, 3, 4, 5, 8, 10, 20, 50, 100, 1000}) {
      std::vector<std::string> set{format("analysis.load_steps={}", n)};
      if (!history.empty()) set.insert(set.end(), {history, "loads.f.force.2=-1.5*t"});
      Simulation s(io::read_model_text(R"(
format: 1
bodies: {b: {mass: 1, inertia: [0.1, 0.1, 0.1], position: [0.001, 0, 1]}}
joints: {j: {type: revolute, bodies: [ground, b], at: [0, 0, 0], axis: y}}
loads:
  s: {type: torsional_spring, joint: j, stiffness: 1}
  f: {type: force, body: b, force: [0, 0, -1.5]}
analysis: {type: statics}
output: {hdf5: false}
)",
                                       "column.yaml", set));
      const RunSummary r = s.run();
      ASSERT_EQ(r.end, RunEnd::finished) << n << r.message;
      EXPECT_EQ(r.statics->unstable, 0) << n << history;
      EXPECT_TRUE(r.statics->limit_points.empty()) << n << history;
      const Vec3 at = s.body(0).r;
      const double angle = std::atan2(at.x(), at.z()) - std::atan2(0.001, 1.0);
      EXPECT_NEAR(angle, root, 1e-8) << n << history;
    }
}

/// A cantilever under five times EI/L² along it and 0.01 of that to the side bends to the other
/// side of its end by 0.7954 L (the elastica, by shooting), 20 elements to 2e-3.
TEST(StaticBranches, ACantileverFollowsItsElasticaBeyondBuckling) {
  for (const int n : {1, 2, 3, 4, 5, 8, 10, 20, 100}) {
    Simulation s(io::read_model_text(R"(
format: 1
materials: {s: {type: elastic, youngs_modulus: 200 GPa, poisson_ratio: 0.3, density: 7800}}
sections: {c: {type: circle, diameter: 0.01, material: s}}
beams: {b: {points: [[0, 0, 0], [1, 0, 0]], elements: 20, section: c, bonded: {ground: start}}}
loads: {f: {type: force, body: b.end, force: [-490.87385212340513, 0.9817477042468103, 0]}}
analysis: {type: statics}
output: {hdf5: false}
)",
                                     "elastica.yaml", {format("analysis.load_steps={}", n)}));
    const RunSummary r = s.run();
    ASSERT_EQ(r.end, RunEnd::finished) << n << r.message;
    EXPECT_EQ(r.statics->unstable, 0) << n;
    EXPECT_TRUE(r.statics->limit_points.empty()) << n;
    EXPECT_NEAR(s.body(s.model().body_index("b.20")).r.y(), 0.7954, 2e-3) << n;
  }
}

/// Bodies that hang from a hinge have no equilibrium without their weight. From the side they come
/// to rest below it, not above.
TEST(StaticBranches, ADoublePendulumHangsDown) {
  for (const double angle : {-1.5, -0.5, 0.4, 1.2, 2.0}) {
    Simulation s(io::read_model_text(
        R"(
format: 1
gravity: [0, 0, -9.81]
variables: {x: 1, z: 0}
bodies:
  b: {mass: 1, inertia: [0.1, 0.1, 0.1], position: [0.5, 0, 0]}
  c: {mass: 1, inertia: [0.1, 0.1, 0.1], position: ["1 + 0.5*x", 0, "0.5*z"]}
joints:
  j: {type: revolute, bodies: [ground, b], at: [0, 0, 0], axis: y}
  k: {type: revolute, bodies: [b, c], at: [1, 0, 0], axis: y}
analysis: {type: statics}
output: {hdf5: false}
)",
        "pendulum.yaml",
        {format("variables.x={}", std::cos(angle)), format("variables.z={}", std::sin(angle))}));
    const RunSummary r = s.run();
    ASSERT_EQ(r.end, RunEnd::finished) << angle << r.message;
    EXPECT_EQ(r.statics->unstable, 0) << angle;
    EXPECT_NEAR(s.body(0).r.z(), -0.5, 1e-9) << angle;
    EXPECT_NEAR(s.body(1).r.z(), -1.5, 1e-9) << angle;
  }
}

}  // namespace
}  // namespace polhode::static_branches_tests
