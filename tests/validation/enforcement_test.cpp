// SPDX-License-Identifier: Apache-2.0
// Joints enforced by springs, and exact ones whose stiffnesses determine the distribution of
// redundant reactions: closed forms, balances and orders.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/simulation/modal.hpp>
#include <support/convergence.hpp>
#include <support/run_text.hpp>

namespace polhode::test::enforcement_models_tests {
namespace {

constexpr double kG = 9.81;

/// A slider of 2 kg along x, enforced by springs of 800 N/m across its rail and of 50 N m/rad.
std::string cart(const std::string& body, const std::string& analysis,
                 const std::string& more = "") {
  return R"(
format: 1
variables: {h: 5 ms}
bodies: {cart: {mass: 2, inertia: [0.1, 0.2, 0.3])" +
         body + R"(}}
joints:
  rail:
    type: prismatic
    bodies: [ground, cart]
    at: [0, 0, 0]
    axis: x
    enforcement: {type: penalty, stiffness: 800 N/m, turning_stiffness: 50 N*m/rad}
)" + more +
         "analysis: {" + analysis + "}\noutput: {hdf5: false}\n";
}

constexpr const char* kDynamics = "type: dynamics, duration: 1 s, step: h";

}  // namespace

// y = (v/ω) sin ωt across the rail with ω = 20/s; along it the cart runs freely.
// @tests{compliance-row}
TEST(Penalty, LetsAMassVibrateAcrossItsRail) {
  const std::string text = cart(", velocity: [0.3, 0.1, 0]", kDynamics);
  const auto error = [&](int steps, int order) {
    Simulation s =
        made(text, {format("h={:.17g}", 1.0 / steps), format("analysis.order={}", order)});
    const RunSummary r = finished(s);
    EXPECT_LT(r.energy_drift, 1e-12) << steps;
    EXPECT_NEAR(s.body(0).r.x(), 0.3, 1e-12);
    EXPECT_NEAR(s.joint(0).force.y(), -800.0 * s.body(0).r.y(), 1e-9) << "force of the spring";
    return std::abs(s.body(0).r.y() - 0.1 / 20.0 * std::sin(20.0));
  };
  expect_order([&](int n) { return error(n, 2); }, {100, 400, 10000}, 2.0, 0.1, "order 2");
  expect_order([&](int n) { return error(n, 4); }, {50, 100, 200}, 4.0, 0.3, "order 4");
  expect_order([&](int n) { return error(n, 6); }, {25, 50, 100}, 6.0, 0.5, "order 6");
}

// At rho_inf 0.5 as well, where the spring's force is that at t_{n+αf}.
TEST(Penalty, IsOfOrderTwoWithNumericalDamping) {
  const std::string text =
      cart(", velocity: [0.3, 0.1, 0]", std::string(kDynamics) + ", rho_inf: 0.5");
  expect_order(
      [&](int steps) {
        Simulation s = made(text, {format("h={:.17g}", 1.0 / steps)});
        finished(s);
        return std::abs(s.body(0).r.y() - 0.1 / 20.0 * std::sin(20.0));
      },
      {500, 2000, 8000}, 2.0, 0.1);
}

// Two springs of 800 N/m, three of 50 N m/rad about axes of J = 0.1, 0.2, 0.3; and the free slide.
TEST(Penalty, GivesTheFrequenciesOfItsSprings) {
  for (const double factor : {1.0, 1e4}) {  // up to nearly rigid springs
    const ModalAnalysis modes(io::read_model_text(
        cart("", "type: modes, count: 6"), "model.yaml",
        {format("joints.rail.enforcement.stiffness={:.17g}", 800.0 * factor),
         format("joints.rail.enforcement.turning_stiffness={:.17g}", 50.0 * factor)}));
    ASSERT_TRUE(modes.converged()) << modes.message();
    std::vector<double> found, expected{0.0,
                                        std::sqrt(400.0),
                                        std::sqrt(400.0),
                                        std::sqrt(500.0),
                                        std::sqrt(250.0),
                                        std::sqrt(50.0 / 0.3)};
    for (const Mode& mode : modes.report().modes)
      found.push_back(2.0 * std::numbers::pi * mode.frequency / std::sqrt(factor));
    std::sort(found.begin(), found.end());
    std::sort(expected.begin(), expected.end());
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < found.size(); ++i)
      EXPECT_NEAR(found[i], expected[i], 1e-7 * expected[i] + 1e-5) << factor;
  }
}

// 80 bodies, each on springs of its own, ω = 20 (i + 1)/s along and about all axes: 480 coordinates
// go to the sparse solver of modes.
TEST(Penalty, GivesTheFrequenciesOfManySprings) {
  constexpr int kBodies = 80;
  std::string bodies = "bodies:\n", joints = "joints:\n";
  for (int i = 0; i < kBodies; ++i) {
    const double w2 = 400.0 * (i + 1) * (i + 1);
    bodies += format("  b{}: {{mass: 2, inertia: [0.1, 0.1, 0.1], position: [{}, 0, 0]}}\n", i, i);
    joints += format(
        "  j{0}: {{type: fixed, bodies: [ground, b{0}], at: [{0}, 0, 0], enforcement: "
        "{{type: penalty, stiffness: {1:.17g}, turning_stiffness: {2:.17g}}}}}\n",
        i, 2.0 * w2, 0.1 * w2);
  }
  const ModalAnalysis modes(io::read_model_text(
      "format: 1\n" + bodies + joints + "analysis: {type: modes, count: 18}\n", "model.yaml", {}));
  ASSERT_TRUE(modes.converged()) << modes.message();
  ASSERT_EQ(modes.report().modes.size(), 18U);
  for (int k = 0; k < 18; ++k) {
    const double expected = 20.0 * (k / 6 + 1);
    EXPECT_NEAR(
        2.0 * std::numbers::pi * modes.report().modes[static_cast<std::size_t>(k)].frequency,
        expected, 1e-6 * expected)
        << k;
  }
}

// Sag in statics: m g/k of its springs.
TEST(Penalty, DeflectsInStatics) {
  Simulation s = made(
      cart("", "type: statics", "gravity: [0, 0, -9.81]\n") +
      "loads: {held: {type: spring_damper, bodies: [ground, cart], at: [[-1, 0, 0], [0, 0, 0]], "
      "stiffness: 100}}\n");
  finished(s);
  EXPECT_NEAR(s.body(0).r.z(), -2.0 * kG / 800.0, 1e-9);
  EXPECT_NEAR(s.joint(0).force.z(), 2.0 * kG, 1e-8);
}

namespace {

/// Two free bodies that fly and turn, held by one joint of springs.
std::string flying_pair(const std::string& joint) {
  return R"(
format: 1
variables: {h: 20 ms}
bodies:
  a: {mass: 1, inertia: [0.02, 0.05, 0.04], velocity: [0.2, 0, 0], angular_velocity: [2, 1, 0.5]}
  b: {mass: 2, inertia: [0.06, 0.03, 0.08], position: [0.5, 0.1, 0], angular_velocity: [-1, 0.5, 1]}
joints:
  it: {bodies: [a, b], )" +
         joint + R"(}
analysis: {type: dynamics, duration: 1 s, step: h}
output: {hdf5: false}
)";
}

constexpr const char* kBoth = "stiffness: 500 N/m, turning_stiffness: 5 N*m/rad";
constexpr const char* kForce = "stiffness: 500 N/m";
constexpr const char* kTurns = "turning_stiffness: 5 N*m/rad";

struct Flight {
  std::string joint, stiffness;
};

std::vector<Flight> flights() {
  std::vector<Flight> all;
  for (const char* type : {"revolute", "cylindrical", "prismatic", "planar"})
    all.push_back({format("type: {}, at: [0.2, 0, 0], axis: [1, 0.2, 0]", type), kBoth});
  all.push_back({"type: constant_velocity, at: [0.2, 0, 0], axis: [1, 0.2, 0]", kBoth});
  all.push_back({"type: universal, at: [0.2, 0, 0], axes: [x, y]", kBoth});
  all.push_back({"type: fixed, at: [0.2, 0, 0]", kBoth});
  all.push_back({"type: generic, at: [0.2, 0, 0], free: [x, ry]", kBoth});
  all.push_back({"type: spherical, at: [0.2, 0, 0]", kForce});
  all.push_back({"type: point_in_plane, at: [0.2, 0, 0], axis: z", kForce});
  all.push_back({"type: point_on_line, at: [0.2, 0, 0], axis: z", kForce});
  all.push_back({"type: distance, at: [[0.1, 0, 0], [0.4, 0.1, 0]]", kForce});
  all.push_back({"type: revolute_spherical, at: [[0.1, 0, 0], [0.4, 0.1, 0]], axis: z", kForce});
  all.push_back({"type: universal_spherical, at: [[0.1, 0, 0], [0.4, 0.1, 0]]", kForce});
  all.push_back({"type: parallel_axes, axis: z", kTurns});
  return all;
}

std::string text_of(const Flight& f) {
  return flying_pair(format("{}, enforcement: {{type: penalty, {}}}", f.joint, f.stiffness));
}

}  // namespace

// Soft springs with deflections of centimetres: energy and both momenta at every step and order.
// @tests{compliance-row}
TEST(Penalty, KeepsEnergyAndMomentaOfEveryJoint) {
  for (const Flight& flight : flights())
    for (const int order : {2, 4, 6})
      for (const char* h : {"20 ms", "2 ms", "0.2 ms"}) {
        if (order > 2 && std::string(h) == "0.2 ms") continue;  // order 2 within it
        Simulation s =
            made(text_of(flight), {std::string("h=") + h, format("analysis.order={}", order)});
        const RunSummary r = finished(s);
        const std::string what = format("{}, order {}, {}", flight.joint, order, h);
        const double composed = std::string(h) == "2 ms" ? 1e-8 : 1e-4;
        EXPECT_LT(r.energy_drift, order == 2 ? 1e-11 : composed) << what;
        EXPECT_LT(r.linear_momentum_drift, 1e-12) << what;
        EXPECT_LT(r.angular_momentum_drift, order == 2 ? 1e-11 : composed) << what;
      }
}

// Orders of all joints, against a fine run of order 8.
TEST(Penalty, IsOfItsOrderForEveryJoint) {
  for (const Flight& flight : flights()) {
    const auto end = [&](int steps, int order) {
      Simulation s = made(text_of(flight),
                          {format("h={:.17g}", 1.0 / steps), format("analysis.order={}", order)});
      finished(s);
      Vec6 motion;
      motion << s.body(0).r, s.body(0).omega();
      return motion;
    };
    const Vec6 exact = end(800, 8);
    for (const int order : {2, 4, 6}) {
      const std::vector<int> steps =
          order == 2 ? std::vector{500, 1000, 4000} : std::vector{100, 200};
      expect_order([&](int n) { return (end(n, order) - exact).norm(); }, steps, order,
                   order == 2 ? 0.1 : 0.7, format("{} order {}", flight.joint, order));
    }
  }
}

namespace {

/// A four-bar that falls, with a load; the enforcement of its last hinge is given.
std::string four_bar(const std::string& enforcement) {
  std::string text = R"(
format: 1
gravity: [0, -9.81, 0]
variables: {h: 2 ms}
bodies:
  crank: {mass: 1, inertia: [0.001, 0.1, 0.1], position: [0, 0.5, 0], orientation: {axis: z, angle: 90 deg}}
  coupler: {mass: 1, inertia: [0.001, 0.1, 0.1], position: [0.5, 1, 0]}
  rocker: {mass: 1, inertia: [0.001, 0.1, 0.1], position: [1, 0.4, 0], orientation: {axis: z, angle: 90 deg}}
joints:
  A: {type: revolute, bodies: [ground, crank], at: [0, 0, 0], axis: z}
  B: {type: revolute, bodies: [crank, coupler], at: [0, 1, 0], axis: z}
  C: {type: revolute, bodies: [coupler, rocker], at: [1, 1, 0], axis: z}
  D: {type: revolute, bodies: [rocker, ground], at: [1, -0.2, 0], axis: z)";
  return text + enforcement + R"(}
loads: {push: {type: force, body: coupler, force: [3, 0, 0]}}
analysis: {type: dynamics, duration: 0.4 s, step: h}
output: {hdf5: false}
)";
}

}  // namespace

// Difference from the exact joint: inversely proportional to the stiffness at each step, also where
// steps are far longer than a period of the springs.
TEST(Penalty, TendsToTheExactJoint) {
  for (const char* rho : {"1", "0.5"})
    for (const char* h : {"2 ms", "0.5 ms", "0.1 ms"}) {
      const io::Overrides at{std::string("h=") + h, std::string("analysis.rho_inf=") + rho};
      Simulation exact = made(four_bar(""), at);
      finished(exact);
      const auto error = [&](double k) {
        Simulation s = made(four_bar(format(", enforcement: {{type: penalty, stiffness: {:.17g}, "
                                            "turning_stiffness: {:.17g}}}",
                                            k, k)),
                            at);
        const RunSummary r = finished(s);
        EXPECT_LT(r.energy_drift, *rho == '1' ? 1e-11 : 1e-3) << k;
        EXPECT_LT(r.constraint_residual_max, 1e-14) << k;
        return (s.body(1).r - exact.body(1).r).norm();
      };
      const double soft = error(1e7), stiff = error(1e9), rigid = error(1e12);
      // Undamped springs vibrate about it.
      EXPECT_NEAR(std::log10(soft / stiff), 2.0, *rho == '1' ? 0.5 : 0.2) << rho << " " << h;
      EXPECT_LT(rigid, 2e-9) << rho << " " << h;
    }
}

// Results of all solvers agree.
TEST(Penalty, AgreesWithTreeAndBlockSolvers) {
  const std::string text =
      four_bar(", enforcement: {type: penalty, stiffness: 1e6, turning_stiffness: 1e5}");
  Simulation tree = made(text, {"analysis.solver=tree"});
  Simulation blocks = made(text, {"analysis.solver=block_lu"});
  finished(tree);
  finished(blocks);
  for (int b = 0; b < 3; ++b) EXPECT_LT((tree.body(b).r - blocks.body(b).r).norm(), 1e-9) << b;
}

namespace {

/// A gate of 40 kg on two hinges one above the other: along their axis one redundant row.
std::string gate(const std::string& type, const std::string& analysis) {
  return R"(
format: 1
gravity: [0, 0, -9.81]
variables: {h: 5 ms}
bodies: {gate: {mass: 40, inertia: [4, 8, 4], position: [0.8, 0, 0.9], angular_velocity: [0, 0, 0.5], velocity: [0, 0.4, 0]}}
joints:
  low:
    {type: revolute, bodies: [ground, gate], at: [0, 0, 0.2], axis: z, enforcement: {type: )" +
         type + R"(, stiffness: 3e7, turning_stiffness: 3e6}}
  high:
    {type: revolute, bodies: [ground, gate], at: [0, 0, 1.6], axis: z, enforcement: {type: )" +
         type + R"(, stiffness: 1e7, turning_stiffness: 1e6}}
analysis: {)" +
         analysis + R"(}
output: {hdf5: false}
)";
}

}  // namespace

// With exact joints the weight is divided in the ratio of the stiffnesses, 3 to 1, at each step.
// @tests{augmented-rows}
TEST(Augmented, DistributesTheWeightByStiffnessAndIsExact) {
  for (const char* solver : {"tree", "block_lu"})
    for (const char* h : {"20 ms", "5 ms", "0.05 ms"}) {
      Simulation s = made(gate("augmented", "type: dynamics, duration: 0.2 s, step: h"),
                          {std::string("h=") + h, std::string("analysis.solver=") + solver});
      const RunSummary r = finished(s);
      const double weight = 40.0 * kG;
      EXPECT_NEAR(s.joint(0).force.z(), 0.75 * weight, 1e-5 * weight) << h;
      EXPECT_NEAR(s.joint(1).force.z(), 0.25 * weight, 1e-5 * weight) << h;
      EXPECT_LT(s.joint(0).residual, 1e-13) << h;
      EXPECT_LT(s.joint(1).residual, 1e-13) << h;
      EXPECT_LT(r.energy_drift, 1e-11) << h;
    }
}

// The same in equilibrium, where a spring about its axis holds the gate.
TEST(Augmented, DistributesTheWeightInStatics) {
  std::string text = gate("augmented", "type: statics") +
                     "loads: {closer: {type: torsional_spring, joint: low, stiffness: 100}}\n";
  const std::string moves = ", angular_velocity: [0, 0, 0.5], velocity: [0, 0.4, 0]";
  text.erase(text.find(moves), moves.size());
  Simulation s = made(text);
  finished(s);
  const double weight = 40.0 * kG;
  EXPECT_NEAR(s.joint(0).force.z(), 0.75 * weight, 5e-5 * weight);
  EXPECT_NEAR(s.joint(1).force.z(), 0.25 * weight, 5e-5 * weight);
  EXPECT_LT(s.joint(0).residual, 1e-12);
  EXPECT_LT(s.joint(1).residual, 1e-12);
}

// Springs of the same stiffnesses, damped by rho_inf 0, carry the same forces.
TEST(Augmented, DistributesLoadsAsSpringsDo) {
  Simulation springs =
      made(gate("penalty", "type: dynamics, duration: 0.5 s, step: h, rho_inf: 0"));
  Simulation exact =
      made(gate("augmented", "type: dynamics, duration: 0.5 s, step: h, rho_inf: 0"));
  finished(springs);
  finished(exact);
  for (int j = 0; j < 2; ++j) {
    const JointReport a = springs.joint(j), b = exact.joint(j);
    EXPECT_LT((a.force - b.force).norm(), 1e-3 * b.force.norm()) << j;
    EXPECT_LT((a.moment - b.moment).norm(), 1e-3 * b.force.norm()) << j;
  }
}

// x = A sin 5t + B sin ωt follows a frame with the motion 0.1 m sin 5t, by springs of ω = 20/s; the
// supplied work is the energy.
TEST(Penalty, FollowsAFrameThatMoves) {
  const std::string text = R"yaml(
format: 1
variables: {h: 5 ms}
bodies: {cart: {mass: 2, inertia: [1, 1, 1]}}
joints:
  lead:
    type: fixed
    bodies: [ground, cart]
    at: [0, 0, 0]
    motion: {x: "0.1*sin(5*t)"}
    enforcement: {type: penalty, stiffness: 800 N/m, turning_stiffness: 50 N*m/rad}
analysis: {type: dynamics, duration: 1 s, step: h}
output: {hdf5: false}
)yaml";
  const double w = 20.0, A = 0.1 * w * w / (w * w - 25.0), B = -A * 5.0 / w;
  expect_order(
      [&](int steps) {
        Simulation s = made(text, {format("h={:.17g}", 1.0 / steps)});
        const RunSummary r = finished(s);
        EXPECT_LT(r.energy_drift, 1e-10) << steps;
        return std::abs(s.body(0).r.x() - A * std::sin(5.0) - B * std::sin(w));
      },
      {100, 400, 10000}, 2.0, 0.1);
}

// A ball of 1 kg hits a wall at 2 m/s with e = 0.5; a body connected to it by springs continues at
// first.
TEST(Penalty, TransmitsNoImpulse) {
  for (const char* h : {"2 ms", "0.5 ms", "0.02 ms"}) {
    const auto end = [&](const std::string& enforcement) {
      Simulation s = made(R"(
format: 1
variables: {h: 2 ms}
bodies:
  wall: {fixed: true, shape: {plane: x}}
  ball: {shape: {sphere: 0.2}, mass: 1, position: [0.12, 0, 0], velocity: [-2, 0, 0]}
  load: {mass: 3, inertia: [0.1, 0.1, 0.1], position: [0.6, 0, 0], velocity: [-2, 0, 0]}
joints: {tie: {type: fixed, bodies: [ball, load], at: [0.12, 0, 0])" +
                              enforcement + R"(}}
contacts: {default: {restitution: 0.5}}
analysis: {type: dynamics, duration: 16 ms, step: h}
output: {hdf5: false}
)",
                          {std::string("h=") + h});
      finished(s);
      return Eigen::Vector2d(s.body(1).v.x(), s.body(2).v.x());
    };
    // 6 ms after the impact springs of 10 N/m have changed the speeds by 10 N/m 18 mm 6 ms / 2 m.
    const Eigen::Vector2d soft =
        end(", enforcement: {type: penalty, stiffness: 10, turning_stiffness: 10}");
    EXPECT_NEAR(soft.x(), 1.0, 1e-3) << h;
    EXPECT_NEAR(soft.y(), -2.0, 1e-3) << h;
    const Eigen::Vector2d rigid = end("");
    EXPECT_NEAR(rigid.x(), 1.0, 1e-3) << h;
    EXPECT_NEAR(rigid.y(), 1.0, 1e-3) << h;
  }
}

// Released while its springs are deflected, and held again at its position then: the energy of the
// springs is in the balance, and the cart continues with its velocity.
TEST(Penalty, IsSwitchedWithItsStoredEnergy) {
  std::string text =
      cart(", velocity: [0, 0.1, 0]", kDynamics,
           "events: {go: {at: 0.05 s, off: [rail]}, hold: {at: 0.5 s, on: [rail]}}\n");
  text.replace(text.find("prismatic"), 9, "fixed");
  text.replace(text.find("    axis: x\n"), 12, "");
  const double y = 0.005 * std::sin(1.0), v = 0.1 * std::cos(1.0), lost = 0.5 * 800.0 * y * y;
  for (const double h : {0.02, 0.002, 0.0001}) {
    Simulation s = made(text, {format("h={}", h)});
    const RunSummary r = finished(s);
    ASSERT_EQ(r.events.size(), 2U);
    EXPECT_LT(r.energy_drift, 1e-11) << h;
    const double held = y + 0.45 * v;
    EXPECT_NEAR(s.body(0).r.y(), held + v / 20.0 * std::sin(10.0), 5.0 * h * h + 1e-9) << h;
    EXPECT_NEAR(s.balance().dissipated, lost, 80.0 * h * h * lost + 1e-12) << h;
  }
}

TEST(Enforcement, LocatesErrorsInTheFile) {
  const auto hinge = [](const std::string& enforcement) {
    return R"(
format: 1
bodies: {a: {mass: 1, inertia: [1, 1, 1]}}
joints:
  hinge: {type: revolute, bodies: [ground, a], at: [0, 0, 0], axis: z, enforcement: {)" +
           enforcement + R"(}}
analysis: {type: dynamics, duration: 1 s, step: 1 ms}
)";
  };
  expect_fault(
      hinge("type: penalty, stiffness: 1e6"),
      "'turning_stiffness' is missing. The joint constrains rotations: give their stiffness.");
  expect_fault(hinge("type: penalti, stiffness: 1e6, turning_stiffness: 1"), "penalty");
  expect_fault(hinge("type: penalty, stiffness: -1, turning_stiffness: 1"), "stiffness");
  std::string ball = hinge("type: penalty, stiffness: 1e6, turning_stiffness: 1");
  ball.replace(ball.find("revolute"), 8, "spherical");
  expect_fault(ball, "the joint constrains no rotations. Leave it out.");
  std::string apart = hinge("type: augmented, stiffness: 1e9, turning_stiffness: 1");
  expect_fault(apart, "augmented joints have stiffnesses from 1 to 1e+09");
}

}  // namespace polhode::test::enforcement_models_tests
