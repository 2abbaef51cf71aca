// SPDX-License-Identifier: Apache-2.0
// Statics of slack cables, of snap-through, and of models without freedoms.
#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <polhode/core/format.hpp>
#include <polhode/io/read/read_model.hpp>
#include <polhode/simulation/modal.hpp>
#include <polhode/simulation/simulation_details.hpp>

namespace polhode::slack_and_snap_tests {
namespace {

using ::testing::HasSubstr;

/// Parameter a of the catenary of length s over the span d: 2a sinh(d/(2a)) = s.
double catenary(double d, double s) {
  double low = 1e-3 * d, high = 1e3 * d;
  for (int i = 0; i < 200; ++i) {
    const double a = std::sqrt(low * high);
    (2.0 * a * std::sinh(0.5 * d / a) > s ? low : high) = a;
  }
  return low;
}

constexpr const char* kRope = R"(
format: 1
gravity: [0, 0, -9.81]
variables: {n: 40, s: 1.5}
cables:
  rope: {through: [[ground, [0, 0, 0]], [ground, [1, 0, 0]]], stiffness: 1e6, mass_per_length: 0.5, elements: n, free_length: s}
analysis: {type: statics}
output: {hdf5: false}
)";

/// A straight initial shape, with a free length of 1.5 times the span: the whole cable is slack.
/// @tests{statics-relaxation}
TEST(SlackCable, FindsTheShapeOfTheCatenary) {
  for (const auto& [n, s] : {std::pair(20, 1.5), {40, 1.5}, {40, 1.05}, {40, 3.0}, {100, 1.5}}) {
    Simulation rope(io::read_model_text(
        kRope, "rope.yaml", {format("variables.n={}", n), format("variables.s={}", s)}));
    const RunSummary r = rope.run();
    ASSERT_EQ(r.end, RunEnd::finished) << n << ' ' << s << ' ' << r.message;
    EXPECT_TRUE(r.statics->slack.empty());
    EXPECT_EQ(r.statics->unstable, 0);
    const double a = catenary(1.0, s), sag = a * (std::cosh(0.5 / a) - 1.0);
    double lowest = 0.0;
    const Model& model = rope.model();
    for (std::size_t b = 0; b < model.bodies.size(); ++b)
      lowest = std::min(lowest, rope.body(static_cast<int>(b)).r.z());
    EXPECT_NEAR(lowest, -sag, (n == 20 ? 4e-3 : 2e-3) * sag) << n << ' ' << s;
    // The piece beside the middle carries half its own weight, and a μ g across.
    const double along = rope.cable(0).tension[static_cast<std::size_t>(n / 2)];
    const double down = 0.25 * 9.81 * s / n;
    EXPECT_NEAR(std::sqrt(along * along - down * down), a * 9.81 * 0.5, 5e-3 * a * 9.81 * 0.5)
        << n << ' ' << s;
  }
}

TEST(SlackCable, IsNamedInAWarning) {
  Simulation s(io::read_model_text(R"(
format: 1
gravity: [0, 0, -9.81]
bodies:
  lamp: {mass: 2, inertia: [1, 1, 1], position: [0, 0, -1]}
joints:
  rail: {type: prismatic, bodies: [ground, lamp], at: [0, 0, -1], axis: z}
loads:
  spring: {type: spring_damper, bodies: [ground, lamp], at: [[0, 0, 0], [0, 0, -1]], stiffness: 1000}
cables:
  stay: {through: [[ground, [0, 0, 0]], [lamp]], stiffness: 1e5, free_length: 1.5}
analysis: {type: statics}
output: {hdf5: false}
)",
                                   "lamp.yaml"));
  const RunSummary r = s.run();
  ASSERT_EQ(r.end, RunEnd::finished) << r.message;
  ASSERT_EQ(r.statics->slack.size(), 1u);
  EXPECT_EQ(r.statics->slack[0], "cable 'stay' is slack");
}

/// Two rods to a point that is pushed through the line between their feet (von Mises): with the
/// engineering strain the force is P = 2 EA z (1/l − 1/L_0), l² = 1 + z², largest where dP/dz = 0.
constexpr const char* kMises = R"(
format: 1
variables: {P: 1, steps: 10}
bodies:
  top: {mass: 1, inertia: [1, 1, 1], position: [0, 0, 0.2]}
joints:
  rail: {type: prismatic, bodies: [ground, top], at: [0, 0, 0], axis: z}
cables:
  left: {through: [[ground, [-1, 0, 0]], [top]], stiffness: 1000, tension_only: false}
  right: {through: [[ground, [1, 0, 0]], [top]], stiffness: 1000, tension_only: false}
loads:
  push: {type: force, body: top, force: [0, 0, -P]}
analysis: {type: statics, load_steps: steps}
output: {hdf5: false}
)";

double mises_limit() {
  const double l_0 = std::hypot(1.0, 0.2);
  double most = 0.0;
  for (double z = 0.2; z > 0.0; z -= 1e-6) {
    const double l = std::hypot(1.0, z);
    most = std::max(most, 2.0 * 1000.0 * (1.0 - l / l_0) * z / l);
  }
  return most;
}

// @tests{statics-jump}
TEST(SnapThrough, IsReportedAtAnyNumberOfLoadSteps) {
  const double limit = mises_limit();
  for (const int steps : {1, 2, 10, 34, 37, 41, 55, 100})
    for (const double part : {1.05, 1.5, 4.0}) {
      Simulation s(io::read_model_text(
          kMises, "truss.yaml",
          {format("variables.P={}", part * limit), format("variables.steps={}", steps)}));
      const RunSummary r = s.run();
      ASSERT_EQ(r.end, RunEnd::finished) << steps << ' ' << part << r.message;
      EXPECT_LT(s.body(s.model().body_index("top")).r.z(), -0.2);  // snapped through
      ASSERT_EQ(r.statics->limit_points.size(), 1u) << steps << ' ' << part;
      const LimitPoint& point = r.statics->limit_points[0];
      EXPECT_TRUE(point.jump);
      EXPECT_NEAR(point.load_factor * part, 1.0, 1e-3) << steps << ' ' << part;
      EXPECT_NE(point.motion.find("body 'top' moves along z"), std::string::npos) << point.motion;
      EXPECT_EQ(r.statics->unstable, 0);
    }
  for (const int steps : {1, 10}) {
    Simulation s(io::read_model_text(
        kMises, "truss.yaml",
        {format("variables.P={}", 0.99 * limit), format("variables.steps={}", steps)}));
    const RunSummary r = s.run();
    ASSERT_EQ(r.end, RunEnd::finished) << r.message;
    EXPECT_TRUE(r.statics->limit_points.empty());
    EXPECT_GT(s.body(s.model().body_index("top")).r.z(), 0.0);
  }
}

/// The squared frequency decreases to zero at the limit load: by the tangent, dP/dz.
TEST(Truss, HasTheFrequencyOfItsTangent) {
  const double limit = mises_limit(), l_0 = std::hypot(1.0, 0.2);
  for (const double part : {0.5, 0.9, 0.99, 0.999}) {
    const ModalAnalysis truss(io::read_model_text(
        kMises, "truss.yaml", {format("variables.P={}", part * limit), "analysis.type=modes"}));
    ASSERT_TRUE(truss.converged()) << truss.message();
    const double z = truss.simulation().body(truss.model().body_index("top")).r.z();
    const double l = std::hypot(1.0, z);
    const double stiffness = 2000.0 * (1.0 / l_0 - 1.0 / l + z * z / (l * l * l));
    EXPECT_NEAR(truss.report().modes.at(0).omega_squared, stiffness, 1e-6 * 80.0) << part;
  }
}

constexpr const char* kHeldBlock = R"(
format: 1
materials: {rubber: {type: elastic, youngs_modulus: 1 MPa, poisson_ratio: 0.3, density: 1000}}
solids:
  cube: {mesh: {block: {size: [1, 1, 1], cells: [1, 1, 1]}}, material: rubber, prescribed: {all: {nodes: {nodes: [0, 1, 2, 3, 4, 5, 6, 7]}, x: 0, y: 0, z: 0.1*t}}}
analysis: {type: statics}
output: {hdf5: false}
)";

TEST(SolidWithoutAFreeNode, RunsInStaticsAndModes) {
  Simulation s(io::read_model_text(kHeldBlock, "cube.yaml"));
  const RunSummary r = s.run();
  EXPECT_EQ(r.end, RunEnd::finished) << r.message;
  EXPECT_EQ(r.statics->unstable, 0);
  const ModalAnalysis modes(io::read_model_text(kHeldBlock, "cube.yaml", {"analysis.type=modes"}));
  ASSERT_TRUE(modes.converged()) << modes.message();
  EXPECT_TRUE(modes.report().modes.empty());
  EXPECT_THAT(modes.report().warnings.at(0), HasSubstr("every degree of freedom is constrained"));
}

/// A slider with 5 N of force against a spring that acts beyond some way only, in one step, in
/// several, and along a history; with friction it stays up to 2 N, and slides freely to the spring.
TEST(FreePlay, EndsWhereTheSpringActs) {
  const std::string slider = R"yaml(
format: 1
bodies: {s: {mass: 2, inertia: [0.01, 0.01, 0.01], position: [0.5, 0, 0]}}
joints: {j: {type: prismatic, bodies: [ground, s], at: [0, 0, 0], axis: x, JOINT}}
loads:
  f: {type: force, body: s, force: [F, 0, 0]}
  SPRING
analysis: {type: statics, load_steps: STEPS, HISTORY}
output: {hdf5: false}
)yaml";
  const std::string free =
      R"yaml(a: {type: translational_spring, joint: j, spring_force: "abs(x) < 0.1 ? 0 : 1000*(x-0.1)"})yaml";
  const std::string one_sided =
      "a: {type: spring_damper, bodies: [ground, s], at: [[0, 0, 0], [0.5, 0, 0]], stiffness: "
      "1000, "
      "free_length: 0.7, acts: tension}";
  const std::string cubic =
      R"yaml(a: {type: translational_spring, joint: j, spring_force: "1000*x^3"})yaml";
  struct Case {
    std::string name, joint, spring;
    double x, tolerance;
  };
  for (const Case& c :
       {Case{"free play", "", free, 0.105, 1e-9}, Case{"tension", "", one_sided, 0.205, 1e-9},
        Case{"cubic", "", cubic, std::cbrt(5e-3), 1e-9},
        Case{"friction", "friction: {force: 2}", free, 0.103, 2e-6},
        Case{"stop", "limits: {upper: 0.3}", "", 0.3, 3e-5}})
    for (const int steps : {1, 10, 100})
      for (const bool history : {false, true}) {
        std::string text = slider;
        const auto put = [&](const std::string& key, const std::string& value) {
          text.replace(text.find(key), key.size(), value);
        };
        put("JOINT", c.joint);
        put("SPRING", c.spring);
        put("STEPS", format("{}", steps));
        put("HISTORY", history ? "history: 1" : "");
        put("F", history ? "5*t" : "5");
        Simulation s(io::read_model_text(text, "slider.yaml"));
        const RunSummary r = s.run();
        ASSERT_EQ(r.end, RunEnd::finished) << c.name << ' ' << steps << history << r.message;
        EXPECT_NEAR(s.body(0).r.x() - 0.5, c.x, c.tolerance) << c.name << ' ' << steps << history;
      }
}

}  // namespace
}  // namespace polhode::slack_and_snap_tests
