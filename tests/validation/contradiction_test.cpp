// SPDX-License-Identifier: Apache-2.0
// Motions that joints and drives do not allow: the run ends at the last state at which all rows
// hold, at every step, order and engine, and names the rows.
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <polhode/core/format.hpp>
#include <support/run_text.hpp>

namespace polhode::test::contradiction_tests {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

/// How a model is run: the rest of its analysis.
struct Way {
  std::string name, analysis;
};

std::vector<Way> ways() {
  return {{"Coarse", "step: 50 ms"},
          {"Default", "step: 10 ms"},
          {"Fine", "step: 0.1 ms"},
          {"FourthOrder", "step: 10 ms, order: 4"},
          {"SixthOrder", "step: 10 ms, order: 6"},
          {"Automatic", "tolerance: 1e-6"},
          {"AutomaticSixthOrder", "tolerance: 1e-6, order: 6"},
          {"Damped", "step: 10 ms, rho_inf: 0.8"},
          {"Sparse", "step: 10 ms, solver: sparse_lu"},
          {"SparseFine", "step: 0.1 ms, solver: klu"}};
}

class Contradiction : public testing::TestWithParam<Way> {
 protected:
  static Simulation of(const std::string& text, double duration) {
    return made(text + format("\nanalysis: {{duration: {}, {}}}\n", duration, GetParam().analysis));
  }
};

INSTANTIATE_TEST_SUITE_P(At, Contradiction, testing::ValuesIn(ways()),
                         [](const auto& p) { return p.param.name; });

/// The run ends where the rows still hold, to round-off of lengths of a metre.
void expect_right_end(const RunSummary& r) {
  EXPECT_EQ(r.end, RunEnd::not_converged);
  EXPECT_LE(r.constraint_residual_max, 1e-12);
}

/// A slider that is moved by x = t² and by x = t³ at once.
TEST_P(Contradiction, OfTwoDrivesOfASliderEndsTheRunAtItsStart) {
  Simulation s = of(R"(format: 1
bodies: {a: {mass: 1, inertia: [1, 1, 1], motion: {x: t^2, y: 0, z: 0}}}
joints: {S: {type: prismatic, bodies: [ground, a], at: [0, 0, 0], axis: x}}
loads: {m1: {type: linear_motor, joint: S, displacement: t^3}})",
                    1.0);
  const RunSummary r = s.run();
  expect_right_end(r);
  EXPECT_EQ(r.t, 0.0);
  EXPECT_THAT(r.message, AllOf(HasSubstr("linear_motor 'm1'"), HasSubstr("joint 'a.motion'"),
                               HasSubstr("gap")));
}

/// A bar on two parallel hinges cannot turn.
TEST_P(Contradiction, OfALockedBarWithItsMotorEndsTheRunAtItsStart) {
  Simulation s = of(R"(format: 1
bodies: {a: {shape: {box: [1, 0.1, 0.1]}, density: 1000, position: [0.5, 0, 0]}}
joints:
  A: {type: revolute, bodies: [ground, a], at: [0, 0, 0], axis: y}
  B: {type: revolute, bodies: [ground, a], at: [1, 0, 0], axis: y}
loads: {m: {type: rotary_motor, joint: A, speed: 1}})",
                    1.0);
  const RunSummary r = s.run();
  expect_right_end(r);
  EXPECT_EQ(r.t, 0.0);
  EXPECT_THAT(r.message,
              AllOf(HasSubstr("joint 'A'"), HasSubstr("joint 'B'"), HasSubstr("rotary_motor 'm'")));
}

std::string two_motors(const std::string& first, const std::string& second) {
  return R"(format: 1
bodies:
  a: {shape: {box: [1, 0.1, 0.1]}, density: 1000, position: [0.5, 0, 0]}
  b: {shape: {box: [1, 0.1, 0.1]}, density: 1000, position: [1.5, 0, 0]}
joints:
  A: {type: revolute, bodies: [ground, a], at: [0, 0, 0], axis: y}
  B: {type: spherical, bodies: [a, b], at: [1, 0, 0]}
loads:
  one: {type: rotary_motor, joint: A, )" +
         first + "}\n  two: {type: rotary_motor, joint: A, " + second + "}";
}

TEST_P(Contradiction, OfTwoMotorsIsNamedWithoutTheJointsThatHold) {
  Simulation s = of(two_motors("speed: 1", "angle: 0.5 * t"), 0.5);
  const RunSummary r = s.run();
  expect_right_end(r);
  EXPECT_EQ(r.t, 0.0);
  EXPECT_THAT(r.message, AllOf(HasSubstr("rotary_motor 'one'"), HasSubstr("rotary_motor 'two'"),
                               Not(HasSubstr("joint"))));
}

/// Two motors whose functions differ in the third derivative: a short step has hardly a gap. The
/// run ends at the last state whose gap, half of t³ - t⁴ at each, is the rounding of a counted
/// angle, four times 8 epsilon times 2 pi for each step.
TEST_P(Contradiction, OfHighOrderIsNamedOnceItsGapIsNoRounding) {
  Simulation s = of(two_motors("angle: t^3", "angle: t^4"), 0.5);
  const RunSummary r = s.run();
  const double rounding = 32.0 * std::numeric_limits<double>::epsilon() * 2.0 * std::numbers::pi *
                          static_cast<double>(r.steps + 1);
  EXPECT_EQ(r.end, RunEnd::not_converged);
  EXPECT_LE(0.5 * r.t * r.t * r.t, rounding);
  EXPECT_LE(r.constraint_residual_max, rounding);
  EXPECT_THAT(r.message, AllOf(HasSubstr("cannot all hold: rotary_motor 'one', rotary_motor 'two'"),
                               Not(HasSubstr("limit position"))));
}

/// Likewise with two drives of a slide, whose rows count no turns: at 0.01 ms too, the first step
/// whose gap t³/2 is no rounding of a metre is refused.
TEST(ContradictionOfASlide, OfHighOrderIsNamedAtItsStart) {
  for (const char* step : {"1 ms", "0.1 ms", "0.03 ms"}) {
    Simulation s = made(format(R"(format: 1
bodies: {{a: {{mass: 1, inertia: [1, 1, 1], motion: {{x: t^2 + t^3, y: 0, z: 0}}}}}}
joints: {{S: {{type: prismatic, bodies: [ground, a], at: [0, 0, 0], axis: x}}}}
loads: {{m1: {{type: linear_motor, joint: S, displacement: t^2}}}}
analysis: {{duration: 1, step: {}}}
)",
                               step));
    const RunSummary r = s.run();
    expect_right_end(r);
    EXPECT_EQ(r.t, 0.0) << step;
    EXPECT_TRUE(r.distrust.empty()) << step;
    EXPECT_THAT(r.message, AllOf(HasSubstr("linear_motor 'm1'"), HasSubstr("joint 'a.motion'")));
  }
}

TEST_P(Contradiction, IsNoneWhereTwoMotorsAgree) {
  Simulation s = of(two_motors("speed: 1", "angle: t"), 0.5);
  const RunSummary r = finished(s);
  EXPECT_LE(r.constraint_residual_max, 1e-12);
  EXPECT_NEAR(s.joint("A").coordinates.at(0), 0.5, 1e-12);
}

/// Drives agree up to t = 0.1 s, and then no longer.
TEST_P(Contradiction, EndsTheRunWhereItBegins) {
  Simulation s = of(two_motors("angle: t", R"(angle: "t < 0.1 ? t : 0.2 - t")"), 0.5);
  const RunSummary r = s.run();
  expect_right_end(r);
  EXPECT_NEAR(r.t, 0.1, 1e-9);
  EXPECT_THAT(r.message, AllOf(HasSubstr("'one'"), HasSubstr("'two'")));
}

TEST_P(Contradiction, OfAGearWithTwoMotorsIsNamed) {
  const std::string text = R"(format: 1
bodies:
  a: {shape: {cylinder: {diameter: 0.4, length: 0.05}}, density: 1000}
  b: {shape: {cylinder: {diameter: 0.2, length: 0.05}}, density: 1000, position: [0.3, 0, 0]}
joints:
  A: {type: revolute, bodies: [ground, a], at: [0, 0, 0], axis: z}
  B: {type: revolute, bodies: [ground, b], at: [0.3, 0, 0], axis: z}
loads:
  teeth: {type: gear, joints: [A, B], ratio: -0.5}
  one: {type: rotary_motor, joint: A, speed: 1}
  two: {type: rotary_motor, joint: B, speed: )";
  Simulation wrong = of(text + "-1.9}", 0.5);
  const RunSummary r = wrong.run();
  expect_right_end(r);
  EXPECT_EQ(r.t, 0.0);
  EXPECT_THAT(r.message, AllOf(HasSubstr("gear 'teeth'"), HasSubstr("rotary_motor 'one'"),
                               HasSubstr("rotary_motor 'two'")));
  Simulation right = of(text + "-2}", 0.5);
  EXPECT_LE(finished(right).constraint_residual_max, 1e-12);
}

/// Four-bar of a crank a = 0.8, coupler b = 0.5, rocker c = 0.4 and ground d = 1: the crank turns
/// to the angle at which coupler and rocker are in one line, cos φ = (a² + d² − (b + c)²)/(2 a d).
std::string four_bar(double speed) {
  const double a = 0.8, b = 0.5, c = 0.4, d = 1.0, phi = std::numbers::pi / 6.0;
  const Vec3 A = Vec3::Zero(), D(d, 0, 0), B(a * std::cos(phi), a * std::sin(phi), 0);
  const Vec3 way = D - B;
  const double length = way.norm(), along = (b * b - c * c + length * length) / (2.0 * length);
  const Vec3 normal(-way.y() / length, way.x() / length, 0.0);
  const Vec3 C = B + along / length * way + std::sqrt(b * b - along * along) * normal;
  std::string text = "format: 1\nbodies:\n";
  const auto bar = [&](const char* name, const Vec3& from, const Vec3& to) {
    const Vec3 v = to - from, m = 0.5 * (from + to);
    text += format(
        "  {}: {{shape: {{box: [{:.17g}, 0.05, 0.05]}}, density: 1000, position: [{:.17g}, "
        "{:.17g}, "
        "0], orientation: {{axis: z, angle: {:.17g}}}}}\n",
        name, v.norm(), m.x(), m.y(), std::atan2(v.y(), v.x()));
  };
  bar("crank", A, B);
  bar("coupler", B, C);
  bar("rocker", D, C);
  text += "joints:\n";
  const auto hinge = [&](const char* name, const char* bodies, const Vec3& at) {
    text += format("  {}: {{type: revolute, bodies: [{}], at: [{:.17g}, {:.17g}, 0], axis: z}}\n",
                   name, bodies, at.x(), at.y());
  };
  hinge("A", "ground, crank", A);
  hinge("B", "crank, coupler", B);
  hinge("C", "coupler, rocker", C);
  hinge("D", "ground, rocker", D);
  return text + format("loads: {{m: {{type: rotary_motor, joint: A, speed: {}}}}}", speed);
}

TEST_P(Contradiction, OfACrankBeyondItsReachEndsTheRunAtTheLimitPosition) {
  const double limit = std::acos((0.8 * 0.8 + 1.0 - 0.9 * 0.9) / 1.6) - std::numbers::pi / 6.0;
  Simulation s = of(four_bar(1.0), 1.0);
  const RunSummary r = s.run();
  expect_right_end(r);
  EXPECT_LE(r.t, limit + 1e-9);
  EXPECT_GE(r.t, limit - 2e-4);
  EXPECT_THAT(r.message,
              AllOf(HasSubstr("limit position"), HasSubstr("joint 'A'"), HasSubstr("joint 'B'"),
                    HasSubstr("joint 'C'"), HasSubstr("joint 'D'"), HasSubstr("rotary_motor 'm'")));
}

/// The slider with two drives beside balls on a floor, which conjugate gradients solve, and with a
/// solid on it, whose nodes are condensed.
TEST(ContradictionWithOtherParts, IsNamedByEveryEngineAtEveryStep) {
  std::string balls = "  floor: {fixed: true, shape: {plane: z}}\n";
  for (int k = 0; k < 64; ++k)
    balls += format("  ball_{}: {{shape: {{sphere: 0.1}}, mass: 1, position: [{}, {}, 0.05]}}\n", k,
                    2.0 + 0.2 * (k % 8), 0.2 * (k / 8));
  const std::string solid =
      R"(materials: {m: {type: elastic, youngs_modulus: 1e7, poisson_ratio: 0, density: 1000}}
solids: {bar: {mesh: {block: {size: [1, 0.1, 0.1], cells: [4, 1, 1]}, position: [0.5, 0, 0]}, material: m, bonded: {a: xmin}}}
)";
  for (const auto& [bodies, sections] :
       {std::pair(balls, std::string("contacts: {}\ngravity: [0, 0, -9.81]\n")),
        std::pair(std::string(), solid)})
    for (const char* step : {"50 ms", "10 ms", "0.1 ms"}) {
      Simulation s = made(format(R"(format: 1
bodies:
  a: {{mass: 1, inertia: [1, 1, 1], motion: {{x: t^2, y: 0, z: 0}}}}
{}joints: {{S: {{type: prismatic, bodies: [ground, a], at: [0, 0, 0], axis: x}}}}
loads: {{m1: {{type: linear_motor, joint: S, displacement: t^3}}}}
{}analysis: {{duration: 1, step: {}}}
)",
                                 bodies, sections, step));
      const RunSummary r = s.run();
      expect_right_end(r);
      EXPECT_LE(r.t, 1e-6) << step;  // the gap t² is then below the tolerance of rows
      EXPECT_THAT(r.message, AllOf(HasSubstr("linear_motor 'm1'"), HasSubstr("joint 'a.motion'")))
          << step;
    }
}

}  // namespace
}  // namespace polhode::test::contradiction_tests
