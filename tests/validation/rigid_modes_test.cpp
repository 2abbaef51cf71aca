// SPDX-License-Identifier: Apache-2.0
// Modes about equilibria with contacts and stops that are rows (law: rigid)
// against closed forms.
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <polhode/core/format.hpp>
#include <polhode/io/read/read_model.hpp>
#include <polhode/simulation/modal.hpp>
#include <support/run_text.hpp>

namespace polhode::test::rigid_modes_tests {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

constexpr double kG = 9.81;

ModesReport modes_of(const std::string& bodies, const std::string& law, const std::string& more,
                     const std::string& rest = "") {
  const ModalAnalysis analysis(io::read_model_text(format(R"yaml(
format: 1
gravity: [0, 0, -9.81]
bodies:
  floor: {{fixed: true, shape: {{plane: z}}}}
{}
{}
contacts: {{default: {{law: rigid{}}}{}}}
analysis: {{type: modes}}
)yaml",
                                                          bodies, more, law, rest),
                                                   "model.yaml"));
  EXPECT_TRUE(analysis.converged()) << analysis.message();
  return analysis.report();
}

/// ω² of all modes, ascending.
std::vector<double> squares(const ModesReport& r) {
  std::vector<double> list;
  for (const Mode& m : r.modes) list.push_back(m.omega_squared);
  return list;
}

/// A box on the floor with three springs to the ground: along x, at a height
/// above its centre, and along y and z through it.
std::string springs(double k, double height) {
  return format(
      "loads:\n"
      "  x: {{type: spring_damper, bodies: [ground, box], at: [[-3, "
      "0, {0}], [0, 0, {0}]], "
      "stiffness: {1}}}\n"
      "  z: {{type: spring_damper, bodies: [ground, box], at: [[0, "
      "0, 3], [0, 0, 0.05]], "
      "stiffness: {1}, free_length: 3}}\n",
      height, k);
}

}  // namespace

// A block pressed on the floor: without friction it slides on its spring,
// √(k/m) in all directions that springs hold; the stretched spring above it
// pulls with its force over its length across. With friction nothing moves.
// @tests{statics-row-stiffness}
TEST(RigidModes, ABlockOnTheFloorSlidesOnItsSpringWithoutFrictionOnly) {
  const double m = 2.0, k = 500.0;
  const std::string box = "  box: {shape: {box: [0.2, 0.2, 0.1]}, mass: 2, position: [0, 0, 0.05]}";
  const ModesReport slides = modes_of(box, "", springs(k, 0.05));
  ASSERT_EQ(slides.freedoms, 3);
  EXPECT_THAT(slides.held,
              Contains("the contact of body 'box' and the ground: 4 points, held along "
                       "the normal alone"));
  // The spring along z has 2.95 m, 0.05 m less than its free length: it pushes
  // with 25 N, and across it is unstable with 25/2.95 N/m; the spring along x
  // resists.
  const double across = -k * 0.05 / 2.95;
  EXPECT_NEAR(squares(slides).back(), (k + across) / m, 1e-6 * k / m);
  EXPECT_NEAR(squares(slides).front(), across / m, 1e-6 * k / m);
  const ModesReport sticks = modes_of(box, ", friction: 0.5", springs(k, 0.05));
  EXPECT_EQ(sticks.freedoms, 0);
  EXPECT_TRUE(sticks.modes.empty());
  EXPECT_THAT(sticks.held, Contains(HasSubstr("4 points, held along the normal and by friction")));
}

// A rod whose round end lies on a rough floor and whose other end a spring
// carries turns about the point of contact, on the roundness of its end: the
// moment of the spring, k L², and the weight at the height of the end above the
// floor.
// @tests{statics-rows}
TEST(RigidModes, ARodTurnsAboutTheEndThatItRestsOn) {
  const double L = 1.0, r = 0.02, m = 2.0, k = 800.0;
  // Level: the spring carries half of the weight at the far end, by its
  // stretch.
  const double stretch = 0.5 * m * kG / k;
  for (const double mu : {0.0, 0.6}) {
    const ModesReport modes =
        modes_of(format("  rod: {{mass: {0}, inertia: [0.001, {1}, {1}], "
                        "position: [0, 0, {2}], com: [0, 0, 0], shape: [{{"
                        "sphere: {3}, position: [{4}, 0, 0]}}]}}",
                        m, m * L * L / 12.0, r, 2 * r, -0.5 * L),
                 format(", friction: {}", mu),
                 format("joints: {{plane: {{type: planar, bodies: [ground, "
                        "rod], at: [0, 0, 0], axis: y}}}}\n"
                        "loads:\n  s: {{type: spring_damper, bodies: [ground, "
                        "rod], at: [[{0}, 0, {1}], "
                        "[{0}, 0, {2}]], stiffness: {3}, free_length: {4}}}\n"
                        "  c: {{type: spring_damper, bodies: [ground, rod], "
                        "at: [[-5, 0, {2}], [0, 0, "
                        "{2}]], stiffness: 0.001}}",
                        0.5 * L, r + 20.0, r, k, 20.0 - stretch));
    // Unknowns: displacement x of the centre and angle θ (about −y, lifting the
    // far end). The end's centre stays at height r: z = L θ/2. T = m (x'² +
    // L²θ'²/4)/2 + J θ'²/2. V: spring at the far end rises by L θ: k L²/2 θ²;
    // geometric terms of its force F = m g/2 over 20 m across, and of the
    // weight: second order of heights with the end's centre at r.
    const double F = 0.5 * m * kG, J = m * L * L / 12.0, I = J + 0.25 * m * L * L;
    if (mu > 0.0) {
      ASSERT_EQ(modes.freedoms, 1);
      // Rolls: x = r θ' of the end's centre.
      const double mass = I + m * r * r, across = F / 20.0 + 0.001;
      EXPECT_NEAR(squares(modes)[0], (k * L * L + across * r * r) / mass, 2e-3 * k * L * L / mass);
    } else {
      ASSERT_EQ(modes.freedoms, 2);
      EXPECT_NEAR(squares(modes)[1], k * L * L / I, 2e-3 * k * L * L / I);
      EXPECT_NEAR(squares(modes)[0], (F / 20.0 + 0.001) / m, 2e-2 * (F / 20.0) / m);
    }
  }
}

// A ball at the bottom of a bowl, a ring of the inner rim of a tube aside: here
// the outside of a ball on top of which it would fall. Without friction between
// two fixed balls it is held by the curvature of the contacts: a ball of radius
// r on two of radius R with its normals at ±β to the vertical swings about the
// line of both centres like a pendulum of the length d cos β.
TEST(RigidModes, ABallBetweenTwoBallsSwingsAboutTheirLine) {
  const double r = 0.1, R = 0.3, beta = 0.6, m = 1.5, d = r + R;
  const ModesReport modes =
      modes_of(format("  a: {{fixed: true, shape: {{sphere: {0}}}, position: [{1}, 0, "
                      "1]}}\n"
                      "  b: {{fixed: true, shape: {{sphere: {0}}}, position: [-{1}, 0, "
                      "1]}}\n"
                      "  ball: {{shape: {{sphere: {2}}}, mass: {3}, position: [0, 0, "
                      "{4}]}}",
                      2 * R, d * std::sin(beta), 2 * r, m, 1 + d * std::cos(beta)),
               "", "", ", exclude: [[ball, floor]]");
  // On top it diverges: λ² = g/(d cos β); three rotations are free.
  ASSERT_FALSE(modes.modes.empty());
  EXPECT_NEAR(squares(modes)[0], -kG / (d * std::cos(beta)), 1e-9 * kG / d);
  EXPECT_EQ(modes.freedoms, 4);
}

// A pendulum pressed on its stop is held like by a joint; what hangs on it
// swings.
TEST(RigidModes, APendulumOnItsStopCarriesAnotherOne) {
  const double L = 0.5;
  const ModesReport modes = modes_of(
      "  upper: {mass: 2, inertia: [0.01, 0.01, 0.01], position: [-0.3, 0, "
      "2]}\n"
      "  lower: {mass: 1, point_mass: true, position: [-0.3, 0, 1.5]}",
      "",
      "joints:\n  hinge: {type: revolute, bodies: [ground, upper], at: [0, 0, "
      "2.5], axis: y, "
      "limits: {lower: 0 deg, upper: 90 deg}}\n"
      "  rod: {type: distance, bodies: [upper, lower], at: [[-0.3, 0, 2], "
      "[-0.3, 0, 1.5]]}",
      "");
  ASSERT_EQ(modes.freedoms, 2);
  EXPECT_THAT(modes.held, Contains(HasSubstr("the stop of")));
  for (const double square : squares(modes)) EXPECT_NEAR(square, kG / L, 1e-7 * kG / L);
}

TEST(RigidModes, ModesAboutTheStartAreRefused) {
  const std::string text = R"yaml(
format: 1
gravity: [0, 0, -9.81]
bodies:
  floor: {fixed: true, shape: {plane: z}}
  box: {shape: {box: [0.2, 0.2, 0.1]}, mass: 2, position: [0, 0, 0.05]}
contacts: {default: {law: rigid}}
analysis: {type: modes, about: start}
)yaml";
  try {
    const ModalAnalysis analysis(io::read_model_text(text, "model.yaml"));
    FAIL();
  } catch (const std::exception& e) {
    EXPECT_THAT(e.what(), HasSubstr("forces of contacts and stops with the law rigid"));
  }
}

}  // namespace polhode::test::rigid_modes_tests
