// SPDX-License-Identifier: Apache-2.0
// Contacts that are rows (law: rigid) in fast motion, under a tolerance, with small overlaps at the
// start, and where torsional and rolling friction bring bodies to rest.
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include <polhode/core/format.hpp>
#include <support/run_text.hpp>

namespace polhode::test::rigid_law_fault_tests {
namespace {

constexpr double kGravity = 9.81;

std::string model(const std::string& bodies, const std::string& law, const std::string& analysis,
                  const char* gravity = "[0, 0, -9.81]") {
  return format(R"yaml(
format: 1
gravity: {}
bodies:
{}
contacts: {{default: {{law: rigid{}}}}}
analysis: {{type: dynamics, {}}}
output: {{hdf5: false}}
)yaml",
                gravity, bodies, law, analysis);
}

}  // namespace

// Whatever the step and the phase, a ball does not get through a board that is thinner than its way
// in a step.
TEST(RigidLawFaults, NothingPassesThroughAThinBoard) {
  for (const double v : {5.0, 40.0, 300.0})
    for (const double h : {2e-2, 5e-3, 1e-3})
      for (int phase = 0; phase < 5; ++phase) {
        const double x = -0.3 - 0.2 * phase * v * h, T = 2.5 * (0.3 - x) / v;
        Simulation s = made(
            model(format("  board: {{fixed: true, shape: {{box: [0.02, 2, 2]}}}}\n"
                         "  ball: {{shape: {{sphere: 0.05}}, mass: 1, position: [{}, 0.01, 0.02], "
                         "velocity: [{}, 0, 0]}}",
                         x, v),
                  ", restitution: 0.5", format("duration: {}, step: {}", std::ceil(T / h) * h, h),
                  "[0, 0, 0]"));
        finished(s);
        EXPECT_NEAR(s.body(1).v[0], -0.5 * v, 1e-9 * v) << v << " " << h << " " << phase;
        EXPECT_LT(s.body(1).r[0], -0.035) << v << " " << h << " " << phase;
      }
}

// Cylinders and cones thrown onto a plane come to lie flat or roll: the lowest point of a rim is a
// row at any angle, so that nothing of it is below the plane but what its rounding cuts off.
TEST(RigidLawFaults, RoundBodiesComeToLieFlat) {
  struct Round {
    const char* kind;
    double diameter, length;
  };
  for (const Round& r : {Round{"cylinder", 0.2, 0.04}, Round{"cylinder", 0.1, 0.1},
                         Round{"cylinder", 0.1, 0.4}, Round{"cone", 0.2, 0.1}})
    for (const double h : {1e-2, 5e-3, 1e-3})
      for (int k = 0; k < 6; ++k) {
        SCOPED_TRACE(
            format("{} of {} m and {} m, step {} s, throw {}", r.kind, r.diameter, r.length, h, k));
        const double angle = k < 2 ? 3.0 * k : 40.0 * k, R = 0.5 * r.diameter;
        Simulation s = made(model(
            format("  floor: {{fixed: true, shape: {{plane: z}}}}\n"
                   "  round: {{shape: {{{}: [{}, {}]}}, density: 1000, position: [0, 0, {}], "
                   "orientation: {{axis: [1, {}, 0.3], angle: {} deg}}, velocity: [0.4, -0.3, 0], "
                   "angular_velocity: [{}, 1, 2]}}",
                   r.kind, r.diameter, r.length, std::hypot(R, r.length) + 0.02, 0.2 * k, angle,
                   k - 2),
            format(", friction: {}, restitution: {}", 0.3 * (k % 3), 0.35 * (k % 2)),
            format("duration: 1.5, step: {}", h)));
        double lowest = 1.0;
        while (s.time() < 1.5 * (1.0 - 1e-9)) {
          const StepReport report = s.step(1.5);
          ASSERT_TRUE(report.accepted) << report.message;
          const BodyMotion m = s.body(1);
          const Vec3 axis = m.q * Vec3::UnitZ();
          const double across = R * std::hypot(axis.x(), axis.y());
          const bool cone = std::string(r.kind) == "cone";
          // The centre of mass of a cone is at a quarter of its height.
          const double down = (cone ? 0.25 : 0.5) * r.length, up = (cone ? 0.75 : 0.5) * r.length;
          lowest = std::min({lowest, m.r.z() - down * axis.z() - across,
                             m.r.z() + up * axis.z() - (cone ? 0.0 : across)});
        }
        EXPECT_GT(lowest, -1e-3 * std::min(R, r.length));
        EXPECT_LE(s.summary().energy_drift, 1e-11);
      }
}

// Two balls that meet off centre at any speed and step, also with automatic steps: the impulse is
// along the line of centres, and momentum and energy (e = 1) are kept.
TEST(RigidLawFaults, FastBallsMeet) {
  for (const double v : {2.0, 10.0, 100.0})
    for (const char* steps : {"step: 20 ms", "step: 1 ms", "tolerance: 1e-4", "tolerance: 1e-7"}) {
      Simulation s = made(model(
          format("  a: {{shape: {{sphere: 0.1}}, mass: 1, position: [-1, 0, 0], velocity: [{0}, 0, "
                 "0]}}\n"
                 "  b: {{shape: {{sphere: 0.1}}, mass: 1, position: [1, 0.02, 0], velocity: [-{0}, "
                 "0, 0]}}",
                 v),
          ", restitution: 1", format("duration: {}, {}", 2.4 / v, steps), "[0, 0, 0]"));
      const RunSummary r = finished(s);
      EXPECT_LT(r.energy_drift, 1e-11);
      EXPECT_LT(s.body(0).v[0], 0.0) << v << " " << steps;
      EXPECT_GT(s.body(1).v[0], 0.0) << v << " " << steps;
    }
}

TEST(RigidLawFaults, ABallDoesNotFallThroughItsFloorUnderATolerance) {
  for (const char* tolerance : {"1e-3", "1e-6"}) {
    Simulation s =
        made(model("  floor: {fixed: true, shape: {box: [2, 2, 0.05]}, position: [0, 0, -0.025]}\n"
                   "  ball: {shape: {sphere: 0.1}, mass: 1, position: [0, 0, 1.05]}",
                   "", format("duration: 2, tolerance: {}", tolerance)));
    finished(s);
    EXPECT_NEAR(s.body(1).r[2], 0.05, 1e-9) << tolerance;
    EXPECT_LT(s.body(1).v.norm(), 1e-6) << tolerance;  // rounding of positions over short steps
  }
}

// A box on a smooth floor at a spring: x = a cos(w t). Contact that stays closed does not switch
// off the control of the error.
TEST(RigidLawFaults, AToleranceHoldsWhileContactsTouch) {
  double before = 1.0;
  for (const double tolerance : {1e-4, 1e-6}) {
    Simulation s = made(
        model("  floor: {fixed: true, shape: {plane: z}}\n"
              "  box: {shape: {box: [0.2, 0.2, 0.02]}, mass: 1, position: [0.5, 0, 0.01]}\n"
              "loads: {s: {type: spring_damper, bodies: [ground, box], at: [[-1.5, 0, 0.01], [0.5, "
              "0, 0.01]], stiffness: 100, free_length: 1.5}}",
              ", friction: 0", format("duration: 3, tolerance: {}", tolerance)));
    finished(s);
    const double error = std::abs(s.body(1).r[0] - 0.5 * std::cos(30.0));
    EXPECT_LT(error, 20.0 * tolerance);
    EXPECT_LT(error, 0.2 * before);
    before = error;
  }
}

// A bouncing ball under a tolerance: the law of restitution, with impacts of the wanted accuracy.
TEST(RigidLawFaults, ImpactsAreAsAccurateAsTheTolerance) {
  const double drop = 0.5, e = 0.8, t_1 = std::sqrt(2.0 * drop / kGravity), T = t_1 * (1.0 + e);
  for (const double tolerance : {1e-4, 1e-6}) {
    Simulation s = made(
        model(format("  floor: {{fixed: true, shape: {{plane: z}}}}\n"
                     "  ball: {{shape: {{sphere: 0.1}}, mass: 1, position: [0, 0, {}]}}",
                     0.05 + drop),
              format(", restitution: {}", e), format("duration: {}, tolerance: {}", T, tolerance)));
    finished(s);
    EXPECT_NEAR(s.body(1).r[2], 0.05 + e * e * drop, tolerance) << tolerance;
  }
}

// Angular momentum of a ball that spins on the spot falls by μ_t m g to zero, and stays there.
TEST(RigidLawFaults, TorsionalFrictionEndsTheRotation) {
  for (const double h : {2e-2, 5e-3, 1e-3, 1e-4}) {
    Simulation s = made(
        model("  floor: {fixed: true, shape: {plane: z}}\n"
              "  ball: {shape: {sphere: 0.2}, mass: 2, position: [0, 0, 0.1], angular_velocity: "
              "[0, 0, 20]}",
              ", friction: 0.2, torsional_friction: 0.01", format("duration: 0.9, step: {}", h)));
    finished(s);
    EXPECT_LT(s.body(1).W.norm(), 1e-9) << h;
  }
}

// A ball that rolls against rolling friction f m g: v²/(2 a) with a = f g R/(R² + 2/5 R²), and
// rest.
TEST(RigidLawFaults, RollingFrictionEndsTheMotion) {
  const double R = 0.1, f = 0.005, a = f * kGravity / (1.4 * R), way = 0.5 / a;
  for (const double h : {2e-2, 5e-3, 1e-3}) {
    Simulation s = made(
        model("  floor: {fixed: true, shape: {plane: z}}\n"
              "  ball: {shape: {sphere: 0.2}, mass: 2, position: [0, 0, 0.1], velocity: [1, 0, 0], "
              "angular_velocity: [0, 10, 0]}",
              ", friction: 0.5, rolling_friction: 0.005", format("duration: 3.2, step: {}", h)));
    finished(s);
    EXPECT_NEAR(s.body(1).r[0], way, 0.2 * h * h + 1e-9) << h;
    EXPECT_LT(s.body(1).v.norm() + s.body(1).W.norm(), 1e-9) << h;
  }
}

// Positions in a file are rounded: bodies that overlap by less than the tolerance of the start stay
// as deep as they are, without energy from nowhere.
TEST(RigidLawFaults, SmallOverlapsOfTheStartStay) {
  for (const double depth : {1e-12, 1e-10, 1e-9, 1e-7})
    for (const char* shape : {"{sphere: 0.2}", "{box: [0.2, 0.3, 0.2]}"}) {
      Simulation s = made(model(format("  floor: {{fixed: true, shape: {{plane: z}}}}\n"
                                       "  body: {{shape: {}, mass: 1, position: [0, 0, {:.17g}]}}",
                                       shape, 0.1 - depth),
                                ", friction: 0.3", "duration: 0.5, step: 5 ms"));
      finished(s);
      EXPECT_NEAR(s.body(1).r[2], 0.1, 1.01 * depth + 1e-11) << shape << depth;
      EXPECT_LT(s.body(1).v.norm() + s.body(1).W.norm(), 1e-9) << shape << depth;
    }
}

}  // namespace polhode::test::rigid_law_fault_tests
