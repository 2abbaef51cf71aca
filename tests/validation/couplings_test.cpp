// SPDX-License-Identifier: Apache-2.0
// Rows between free coordinates of any joints: reduced equations of motion, many turns, orders,
// both engines, redundant rows, loops, equilibria and modes.
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/simulation/modal.hpp>
#include <validation/connector_runs.hpp>

namespace polhode::couplings_tests {

using namespace connectors;
using ::testing::HasSubstr;

/// Arm of 0.5 m and forearm, whose angle is r times that of the arm.
constexpr double kArm = 0.5, kRatio = -1.6;

std::string two_links(const std::string& analysis) {
  return format(R"(
format: 1
gravity: [0, -9.81, 0]
bodies:
  arm: {{mass: 2, inertia: [0.02, 0.06, 0.06], position: [0.25, 0, 0], velocity: [0, 0.25, 0], angular_velocity: [0, 0, 1]}}
  forearm: {{mass: 1, inertia: [0.01, 0.03, 0.03], position: [0.7, 0, 0], velocity: [0, 0.38, 0], angular_velocity: [0, 0, -0.6]}}
joints:
  shoulder: {{type: revolute, bodies: [ground, arm], at: [0, 0, 0], axis: z}}
  elbow: {{type: revolute, bodies: [arm, forearm], at: [{}, 0, 0], axis: z}}
loads:
  it: {{type: coupling, joints: [elbow, shoulder], factors: [{}]}}
analysis: {{duration: 1.6 s, {}}}
output: {{hdf5: false}}
)",
                kArm, kRatio, analysis);
}

/// Angle and rate of the arm at 1.6 s by Runge-Kutta: T = ½ M(q) q̇², M q̈ = −½ M' q̇² − V'.
std::array<double, 2> reduced() {
  const double s = 1.0 + kRatio, c = 0.2, g = 9.81;
  const double first = 0.06 + 2.0 * 0.0625 + kArm * kArm, second = s * s * (0.03 + c * c);
  const auto rate = [&](const std::array<double, 2>& x) -> std::array<double, 2> {
    const double q = x[0], v = x[1];
    const double M = first + second + 2.0 * kArm * c * s * std::cos(kRatio * q);
    const double dM = -2.0 * kArm * c * s * kRatio * std::sin(kRatio * q);
    const double dV = g * ((2.0 * 0.25 + kArm) * std::cos(q) + s * c * std::cos(s * q));
    return {v, -(0.5 * dM * v * v + dV) / M};
  };
  std::array<double, 2> x{0.0, 1.0};
  constexpr int kSteps = 20000;
  constexpr double h = 1.6 / kSteps;
  const auto moved = [](const std::array<double, 2>& a, const std::array<double, 2>& d, double by) {
    return std::array<double, 2>{a[0] + by * d[0], a[1] + by * d[1]};
  };
  for (int k = 0; k < kSteps; ++k) {
    const auto k1 = rate(x), k2 = rate(moved(x, k1, 0.5 * h)), k3 = rate(moved(x, k2, 0.5 * h)),
               k4 = rate(moved(x, k3, h));
    for (std::size_t i = 0; i < 2; ++i)
      x[i] += h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
  }
  return x;
}

// @tests{coupling-row}
TEST(Couplings, AnArmMovesByItsReducedEquationAtEveryOrder) {
  const std::array<double, 2> exact = reduced();
  for (const int order : {2, 4, 6, 8}) {
    const auto error = [&](double h) {
      const Outcome o = run(two_links(format("step: {}, order: {}", h, order)));
      EXPECT_LT(o.summary.energy_drift, 1e-12) << order;
      EXPECT_NEAR(o.load[1],
                  kRatio * std::atan2(o.body(0).Lambda()(1, 0), o.body(0).Lambda()(0, 0)), 1e-13)
          << order;
      return std::abs(o.body(0).W.z() - exact[1]);
    };
    const double coarse = error(0.02), fine = error(0.01);
    EXPECT_LT(fine, order == 2 ? 2e-2 : 1e-6) << order;
    if (order == 8) continue;  // round-off at both steps
    EXPECT_NEAR(std::log2(coarse / fine), order, 0.35 * order) << order;
  }
  for (const double h : {0.02, 1e-3, 2e-4}) {
    const Outcome o = run(two_links(format("step: {}", h)));
    EXPECT_NEAR(o.body(0).W.z(), exact[1], 120.0 * h * h + 1e-9) << h;
  }
}

/// Bodies of two trains that nothing else connects: a slide, and a rotor on a carriage that a
/// spring moves.
std::string two_trains(const std::string& more, const std::string& analysis) {
  return R"(
format: 1
bodies:
  slide: {mass: 2, inertia: [0.1, 0.1, 0.1], position: [0, 1, 0]}
  carriage: {mass: 4, inertia: [0.2, 0.2, 0.2], position: [0.3, 0, 0]}
  rotor: {mass: 1, inertia: [0.02, 0.02, 0.03], position: [0.3, 0, 0]}
joints:
  rail: {type: prismatic, bodies: [ground, slide], at: [0, 1, 0], axis: y}
  track: {type: prismatic, bodies: [ground, carriage], at_body: [[0, 0, 0], [0, 0, 0]], axis_body: [x, x]}
  axle: {type: revolute, bodies: [carriage, rotor], at: [0.3, 0, 0], axis: z}
loads:
  it: {type: coupling, joints: [rail, axle], factors: [50 mm/rad]}
  spring: {type: translational_spring, joint: track, stiffness: 500}
)" + more +
         "analysis: {" + analysis + "}\noutput: {hdf5: false}\n";
}

// (J + f² m) q̈ = M with f = 0.05; the slide's force is m f q̈. The carriage oscillates alone.
TEST(Couplings, ARotorOnACarriageMovesASlideElsewhere) {
  const double J = 0.03 + 0.0025 * 2.0, M = 0.7, acceleration = M / J;
  for (const char* solver : {"tree", "block_lu", "klu", "sparse_lu"})
    for (const double h : {0.02, 2e-3, 2e-4}) {
      const Outcome o = run(two_trains("  drive: {type: rotary_motor, joint: axle, moment: 0.7}\n",
                                       format("duration: 2 s, step: {}, solver: {}", h, solver)));
      const std::string what = format("{} {}", solver, h);
      EXPECT_NEAR(o.load[1], 0.05 * 0.5 * acceleration * 4.0, 200.0 * h * h + 1e-9) << what;
      EXPECT_NEAR(o.load[2], 0.05 * acceleration * 2.0, 100.0 * h * h + 1e-9) << what;
      EXPECT_NEAR(o.load[0], 2.0 * 0.05 * acceleration, 1e-9) << what;
      EXPECT_NEAR(o.body(1).r.x(), 0.3 * std::cos(10.0 * 2.0), 70.0 * h * h + 1e-9) << what;
      EXPECT_LT(o.summary.energy_drift, 1e-12) << what;
    }
}

/// Three shafts in bearings on two frames that swing; q_3 = (q_1 + q_2)/2 + 0.3.
std::string differential(const std::string& rows, const std::string& analysis) {
  return R"(
format: 1
gravity: [0, 0, -9.81]
bodies:
  left: {mass: 5, inertia: [0.3, 0.3, 0.3], position: [0, 0, -0.5], angular_velocity: [0.5, 0, 0]}
  right: {mass: 5, inertia: [0.3, 0.3, 0.3], position: [0, 3, -0.6], angular_velocity: [-0.8, 0, 0]}
  one: {mass: 1, inertia: [0.02, 0.02, 0.03], position: [0, 0, -1], angular_velocity: [0.5, 0, 40]}
  two: {mass: 1, inertia: [0.03, 0.03, 0.05], position: [0.4, 3, -1], angular_velocity: [-0.8, 0, -9]}
  three: {mass: 1, inertia: [0.02, 0.02, 0.04], position: [-0.4, 3, -1], angular_velocity: [-0.8, 0, 15.5]}
joints:
  a: {type: revolute, bodies: [ground, left], at: [0, 0, 0], axis: x}
  b: {type: revolute, bodies: [ground, right], at: [0, 3, 0], axis: x}
  q1: {type: revolute, bodies: [left, one], at: [0, 0, -1], axis: z}
  q2: {type: revolute, bodies: [right, two], at: [0.4, 3, -1], axis: z}
  q3: {type: revolute, bodies: [right, three], at: [-0.4, 3, -1], axis: z}
loads:
)" + rows +
         "analysis: {" + analysis + "}\noutput: {hdf5: false}\n";
}
constexpr const char* kDifferential =
    "  it: {type: coupling, joints: [q3, q1, q2], factors: [0.5, 0.5], offset: 0.3}\n"
    "  m1: {type: torsional_spring, joint: q1, stiffness: 1e-9}\n"
    "  m2: {type: torsional_spring, joint: q2, stiffness: 1e-9}\n";

TEST(Couplings, ADifferentialKeepsItsOffsetOverManyTurnsAtEveryOrder) {
  for (const char* solver : {"tree", "block_lu"})
    for (const int order : {2, 4, 6, 8}) {
      Simulation s(io::read_model_text(
          differential(kDifferential,
                       format("duration: 40 s, step: 20 ms, order: {}, solver: {}", order, solver)),
          "couplings.yaml"));
      const RunSummary summary = s.run();
      ASSERT_EQ(summary.end, RunEnd::finished) << summary.message;
      // q1 turns by about 1600 rad; its own rounding is 2e-13.
      const double q3 = s.load(0)[1], q1 = s.load(1)[3], q2 = s.load(2)[3];
      EXPECT_GT(std::abs(q1), 1000.0);
      EXPECT_NEAR(q3, 0.5 * (q1 + q2) + 0.3, 1e-11) << solver << ' ' << order;
      EXPECT_LT(summary.energy_drift, 2e-12) << solver << ' ' << order;
    }
}

TEST(Couplings, RedundantRowsShareTheForceOfOne) {
  const std::string analysis = "duration: 1 s, step: 2 ms, solver: ";
  for (const char* solver : {"tree", "block_lu"}) {
    const Outcome one = run(differential(kDifferential, analysis + solver));
    // The same row once more, and solved for another coordinate.
    const Outcome three = run(differential(
        std::string(kDifferential) +
            "  again: {type: coupling, joints: [q3, q1, q2], factors: [0.5, 0.5], offset: 0.3}\n"
            "  other: {type: coupling, joints: [q1, q3, q2], factors: [2, -1], offset: -0.6}\n",
        analysis + solver));
    for (int b = 0; b < 5; ++b)
      EXPECT_LT((one.body(b).W - three.body(b).W).norm(), 1e-8) << solver << ' ' << b;
    EXPECT_LT(three.summary.energy_drift, 1e-11) << solver;
    EXPECT_LT(std::abs(three.load[0]), std::abs(one.load[0])) << solver;
  }
}

/// A four-bar linkage, and a flywheel beside it that this joint of it turns.
std::string linkage(const std::string& joint, const std::string& analysis) {
  return R"(
format: 1
gravity: [0, -9.81, 0]
bodies:
  crank: {mass: 1, inertia: [0.01, 0.01, 0.02], position: [0, 0.1, 0], angular_velocity: [0, 0, -6]}
  coupler: {mass: 2, inertia: [0.05, 0.05, 0.08], position: [0.25, 0.3, 0], velocity: [1.2, 0, 0]}
  rocker: {mass: 1.5, inertia: [0.04, 0.04, 0.05], position: [0.5, 0.2, 0], angular_velocity: [0, 0, -3]}
  wheel: {mass: 1, inertia: [0.01, 0.01, 0.02], position: [2, 0, 0]}
joints:
  j1: {type: revolute, bodies: [ground, crank], at: [0, 0, 0], axis: z}
  j2: {type: revolute, bodies: [crank, coupler], at: [0, 0.2, 0], axis: z}
  j3: {type: revolute, bodies: [coupler, rocker], at: [0.5, 0.4, 0], axis: z}
  j4: {type: revolute, bodies: [ground, rocker], at: [0.5, 0, 0], axis: z}
  axle: {type: revolute, bodies: [ground, wheel], at: [2, 0, 0], axis: z}
loads:
  it: {type: coupling, joints: [axle, )" +
         joint + R"(], factors: [3]}
analysis: {)" +
         analysis + "}\noutput: {hdf5: false}\n";
}

// One of the joints is outside the spanning tree.
TEST(Couplings, EnginesAgreeAboutAFlywheelOnAnyJointOfALoop) {
  for (const char* joint : {"j1", "j2", "j3", "j4"}) {
    const std::string analysis = "duration: 1 s, step: 4 ms, solver: ";
    const Outcome tree = run(linkage(joint, analysis + "tree"));
    const Outcome sparse = run(linkage(joint, analysis + "block_lu"));
    for (int b = 0; b < 4; ++b)
      EXPECT_LT((tree.body(b).W - sparse.body(b).W).norm(), 1e-9) << joint << ' ' << b;
    EXPECT_LT(tree.summary.energy_drift, 1e-12) << joint;
    EXPECT_LT(tree.summary.newton_iterations, sparse.summary.newton_iterations + 5) << joint;
    EXPECT_NEAR(tree.load[0], sparse.load[0], 1e-7) << joint;
  }
}

TEST(Couplings, AGivenOffsetAssemblesTheStart) {
  // A row of one coordinate holds it.
  const std::string held = "  held: {type: coupling, joints: [track], offset: 0.25}\n";
  const Outcome o = run(two_trains(held, "duration: 1 s, step: 2 ms"));
  EXPECT_NEAR(o.body(1).r.x(), 0.25, 1e-14);
}

// Spring k at the rotor, force F on the slide: k q = f F, and (J + f² m) ω² = k.
TEST(Couplings, HoldInEquilibriaAndModes) {
  const std::string spring = "  k: {type: torsional_spring, joint: axle, stiffness: 3}\n";
  const Outcome at_rest = run(two_trains(
      spring + "  F: {type: force, body: slide, force: [0, 20, 0], at_body: [0, 0, 0]}\n",
      "type: statics"));
  EXPECT_NEAR(at_rest.load[1], 0.05 * 0.05 * 20.0 / 3.0, 1e-10);
  EXPECT_NEAR(at_rest.load[0], -20.0, 1e-8);
  const ModalAnalysis modes(
      io::read_model_text(two_trains(spring, "type: modes, count: 2"), "couplings.yaml"));
  EXPECT_TRUE(modes.converged()) << modes.message();
  ASSERT_EQ(modes.report().modes.size(), 2U);
  EXPECT_NEAR(modes.report().modes[0].frequency, std::sqrt(3.0 / 0.035) / (2.0 * kPi), 1e-9);
  EXPECT_NEAR(modes.report().modes[1].frequency, 10.0 / (2.0 * kPi), 1e-9);
}

std::string fault(const std::string& row, const std::string& more = "") {
  std::string text = two_trains("", "duration: 1 s, step: 2 ms") + more;
  const std::string before = "joints: [rail, axle], factors: [50 mm/rad]";
  text.replace(text.find(before), before.size(), row);
  try {
    Simulation s(io::read_model_text(text, "couplings.yaml"));
  } catch (const io::ModelErrors& errors) {
    return errors.text();
  } catch (const InputError& e) {
    return e.what();
  }
  return "none";
}

TEST(Couplings, SayWhatIsWrongInTheModel) {
  EXPECT_THAT(fault("joints: [rail, axle]"),
              HasSubstr("needs 1 factors for 2 joints, but 0 are given"));
  EXPECT_THAT(fault("joints: [rail, rail], factors: [1]"),
              HasSubstr("name a coordinate of 'rail' twice"));
  EXPECT_THAT(fault("joints: [rail, axle], coordinates: [z], factors: [1]"),
              HasSubstr("expects one for each of the 2 joints"));
  EXPECT_THAT(fault("joints: rail"), HasSubstr("expects a list of joints"));
  EXPECT_THAT(fault("joints: [rail, axle], coordinates: [rz, rz], factors: [1]"),
              HasSubstr("'rail' (prismatic) has no free coordinate 'rz'"));
  EXPECT_THAT(fault("joints: [rail, axle], factors: [2 kg]"), HasSubstr("factors"));
  const std::string row = "joints: [rail, axle], factors: [0.05]";
  EXPECT_THAT(fault(row, "events: {e: {at: 0.5, off: [axle]}}\n"),
              HasSubstr("'axle' is in the coupling 'it', so it cannot be switched or break"));
  EXPECT_THAT(fault(row, "events: {e: {at: 0.5, off: [it]}}\n"),
              HasSubstr("'it' is a coupling, which cannot be switched"));
}

}  // namespace polhode::couplings_tests
