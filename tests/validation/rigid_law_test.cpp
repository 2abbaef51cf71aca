// SPDX-License-Identifier: Apache-2.0
// Contacts that are rows of the step (law: rigid) against closed forms, conserved quantities, and
// themselves in another order. At all steps: tests/refinement/rigid_rows.py.
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <polhode/core/format.hpp>
#include <polhode/io/results/checkpoint.hpp>
#include <support/run_text.hpp>

namespace polhode::test::rigid_law_tests {
namespace {

/// A model with contacts that are rows.
std::string model(const std::string& bodies, const std::string& law, double T, double h,
                  const std::string& more = "", const char* gravity = "[0, 0, -9.81]") {
  return format(R"yaml(
format: 1
gravity: {}
bodies:
  floor: {{fixed: true, shape: {{plane: z}}}}
{}
{}
contacts: {{default: {{law: rigid{}}}}}
analysis: {{type: dynamics, duration: {}, step: {}}}
output: {{hdf5: false}}
)yaml",
                gravity, bodies, more, law, T, h);
}

RunSummary closed(Simulation& s) {
  const RunSummary r = finished(s);
  EXPECT_EQ(r.rejected_steps, 0);
  EXPECT_LT(r.energy_drift, 1e-11);
  return r;
}

constexpr const char* kDroppedBoxes =
    "  a: {shape: {box: [0.2, 0.1, 0.1]}, mass: 1, position: [0, 0, 0.051]}\n"
    "  b: {shape: {box: [0.2, 0.1, 0.1]}, mass: 3, position: [0.03, 0, 0.156], orientation: {axis: "
    "z, angle: 20 deg}}\n"
    "  c: {shape: {sphere: 0.12}, mass: 2, position: [0.02, 0.01, 0.3], velocity: [0.3, 0, -1]}";

}  // namespace

// A pendulum hits a wall at its lowest point: e of sqrt(2 g L (1 - cos)) after each impact. The
// energy between impacts is exact, so the height to which it rises again is e² of that before.
// @tests{contact-rows}
// @tests{velocity-problem}
TEST(RigidLaw, APendulumRisesByTheSquareOfItsRestitution) {
  const double L = 0.6, lift = 0.4;
  for (const double e : {0.5, 1.0})
    for (const double h : {1e-2, 1e-3, 1e-4}) {
      Simulation s = made(model(
          format("  wall: {{fixed: true, shape: {{plane: x}}, position: [-0.05, 0, 0]}}\n"
                 "  bob: {{shape: {{sphere: 0.1}}, mass: 1, position: [{}, 0, {}]}}",
                 L * std::sin(lift), 1.0 + L - L * std::cos(lift)),
          format(", restitution: {}", e), 0.5, h,
          format("joints: {{hinge: {{type: revolute, bodies: [ground, bob], at: [0, 0, {}], axis: "
                 "y}}}}",
                 1.0 + L)));
      closed(s);
      const double J = 0.4 * 0.05 * 0.05, w = s.body(2).W.norm();
      const double height = s.body(2).r[2] - 1.0;
      const double energy = 9.81 * height + 0.5 * (L * L + J) * w * w;
      // The wall's row is that of the end of the step; before, the bob was up to w h from it.
      EXPECT_NEAR(energy / (9.81 * L * (1.0 - std::cos(lift))), e * e, 20.0 * h * h + 1e-10) << h;
    }
}

// Sliding with friction that turns into rolling: 5/7 of the speed, whatever the step.
TEST(RigidLaw, ABowlingBallEndsWithFiveSeventhsOfItsSpeed) {
  for (const double h : {1e-2, 1e-3, 1e-4}) {
    Simulation s =
        made(model("  ball: {shape: {sphere: 0.2}, mass: 3, position: [0, 0, 0.1], "
                   "velocity: [2, 0, 0]}",
                   ", friction: 0.3", 0.5, h));
    closed(s);
    EXPECT_NEAR(s.body(1).v[0], 10.0 / 7.0, 1e-11) << h;
    EXPECT_NEAR(s.body(1).r[2], 0.1, 1e-13) << h;
  }
}

// Rolling resistance ρ decelerates a rolling ball by ρ g/(1.4 R); torsion stops a spinning one
// after J ω/(τ m g).
TEST(RigidLaw, RollingAndTorsionalResistanceAreRows) {
  const double R = 0.1, g = 9.81, m = 2.0, rho = 2e-3, J = 0.4 * m * R * R;
  for (const double h : {1e-2, 1e-3}) {
    Simulation rolls = made(model(
        format("  ball: {{shape: {{sphere: 0.2}}, mass: {}, position: [0, 0, 0.1], velocity: [1, "
               "0, 0], angular_velocity: [0, 10, 0]}}",
               m),
        format(", friction: 0.5, rolling_friction: {}", rho), 0.5, h));
    closed(rolls);
    EXPECT_NEAR(rolls.body(1).v[0], 1.0 - 0.5 * rho * g / (1.4 * R), 1e-9) << h;
    const double tau = 1e-2, omega = 5.0, t = J * omega / (tau * m * g);
    Simulation spins =
        made(model(format("  ball: {{shape: {{sphere: 0.2}}, mass: {}, position: [0, 0, 0.1], "
                          "angular_velocity: [0, 0, {}]}}",
                          m, omega),
                   format(", friction: 0.5, torsional_friction: {}", tau), 0.5 * t, h));
    closed(spins);
    EXPECT_NEAR(spins.body(1).W[2], 0.5 * omega, 1e-9) << h;
  }
}

// mu_s = 1.2 mu: holds at 1.19 mu, slides at 1.21 mu with the kinetic coefficient.
TEST(RigidLaw, StaticFrictionHoldsUpToItsCoefficient) {
  for (const double f : {1.19, 1.21}) {
    const double mu = 0.4, a = std::atan(f * mu), g = 9.81, h = 1e-3;
    const std::string gravity = format("[{}, 0, {}]", g * std::sin(a), -g * std::cos(a));
    Simulation s = made(model(
        "  box: {shape: {box: [0.2, 0.2, 0.1]}, mass: 2, position: [0, 0, "
        "0.05]}",
        format(", friction: {}, static_friction: {}", mu, 1.2 * mu), 1.0, h, "", gravity.c_str()));
    closed(s);
    const double slides = f > 1.2 ? g * (std::sin(a) - mu * std::cos(a)) : 0.0;
    EXPECT_NEAR(s.body(1).v[0], slides, 4.0 * h * slides + 1e-12);
  }
}

// Bodies that fall on each other askew, with friction and restitution: the balances close at any
// step, nothing overlaps, and the order of the bodies has no effect but rounding.
TEST(RigidLaw, BalancesCloseAndOrderHasNoEffect) {
  for (const double h : {5e-3, 1e-3, 2e-4}) {
    Simulation s = made(model(kDroppedBoxes, ", friction: 0.4, restitution: 0.3", 0.1, h));
    const RunSummary r = finished(s);
    EXPECT_LT(r.energy_drift, 1e-11) << h;
    EXPECT_LT(r.linear_momentum_drift, 1e-10) << h;
    EXPECT_LT(r.angular_momentum_drift, 1e-10) << h;
  }
  const std::string one =
      "  a: {shape: {sphere: 0.2}, mass: 1, position: [0, 0, 0.1]}\n"
      "  b: {shape: {sphere: 0.2}, mass: 3, position: [0.05, 0, 0.294]}\n"
      "  c: {shape: {sphere: 0.2}, mass: 2, position: [-0.04, 0.03, 0.488]}";
  const std::string other =
      "  c: {shape: {sphere: 0.2}, mass: 2, position: [-0.04, 0.03, 0.488]}\n"
      "  b: {shape: {sphere: 0.2}, mass: 3, position: [0.05, 0, 0.294]}\n"
      "  a: {shape: {sphere: 0.2}, mass: 1, position: [0, 0, 0.1]}";
  const std::string law = ", friction: 0.3, restitution: 0.2";
  Simulation s = made(model(one, law, 0.2, 2e-3)), t = made(model(other, law, 0.2, 2e-3));
  finished(s);
  finished(t);
  for (int i = 0; i < 3; ++i) EXPECT_LT((s.body(1 + i).r - t.body(3 - i).r).norm(), 1e-10) << i;
}

TEST(RigidLaw, ARestartContinuesWithTheSameBits) {
  const std::string text = model(kDroppedBoxes, ", friction: 0.4, restitution: 0.3", 0.1, 2e-3);
  Simulation whole = made(text), first = made(text);
  finished(whole);
  while (first.time() < 0.0399) ASSERT_TRUE(first.step(0.04).accepted);
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / "polhode_rigid_law.pst";
  io::write_checkpoint(file.string(), first.model(), first.system(), first.state());
  Simulation second(first.model(),
                    io::read_checkpoint(file.string(), first.model(), first.system()));
  std::filesystem::remove(file);
  finished(second);
  EXPECT_EQ(second.state_hash(), whole.state_hash());
}

// A square bar on edge falls across the edge of another: one row, e of its speed at every step.
TEST(RigidLaw, ABarReboundsFromAnEdgeAcrossIt) {
  const double g = 9.81, drop = 0.05, e = 0.5, top = 0.1 * std::sqrt(2.0);
  // Edges are rounded off by 1e-3 of half the thickness.
  const double rounded = top - 2.0 * 0.05e-3 * (std::sqrt(2.0) - 1.0);
  for (const double h : {1e-2, 1e-3, 1e-4}) {
    const double T = std::sqrt(2.0 * drop / g) * (1.0 + e);  // at its highest again
    Simulation s = made(model(
        format("  anvil: {{fixed: true, shape: {{box: [1, 0.1, 0.1]}}, orientation: {{axis: "
               "x, angle: 45 deg}}, position: [0, 0, 1]}}\n"
               "  bar: {{shape: {{box: [0.1, 1, 0.1]}}, mass: 2, orientation: {{axis: y, angle: "
               "45 deg}}, position: [0, 0, {}]}}",
               1.0 + rounded + drop),
        format(", friction: 0.3, restitution: {}", e), std::round(T / h) * h, h));
    const RunSummary r = closed(s);
    ASSERT_TRUE(r.contacts);
    EXPECT_NEAR(r.contacts->least_gap, 0.0, 1e-10);
    const double height = s.body(2).r[2] - 1.0 - rounded, v = s.body(2).v[2];
    EXPECT_NEAR(height + 0.5 * v * v / g, e * e * drop, 0.3 * h * drop + 1e-9) << h;
    EXPECT_LT(s.body(2).W.norm(), 1e-9);
  }
}

// Two planks across each other: the corners of the area of contact are crossings of edges.
TEST(RigidLaw, PlanksAcrossEachOtherRest) {
  for (const double h : {1e-2, 1e-3}) {
    Simulation s =
        made(model("  low: {shape: {box: [1, 0.2, 0.1]}, mass: 5, position: [0, 0, 0.05]}\n"
                   "  high: {shape: {box: [0.2, 1, 0.1]}, mass: 3, position: [0.1, 0, 0.152]}",
                   ", friction: 0.3", 0.5, h));
    closed(s);
    EXPECT_NEAR(s.body(2).r[2], 0.15, 1e-9);
    EXPECT_LT(s.body(2).v.norm() + s.body(2).W.norm(), 1e-9);
  }
}

// 550 balls at rest have three rows each.
TEST(RigidLaw, SaysThatThereAreTooManyRows) {
  std::string balls;
  for (int i = 0; i < 550; ++i)
    balls += format("  b{}: {{shape: {{sphere: 0.2}}, mass: 1, position: [{}, 0, 0.1]}}\n", i, i);
  Simulation s = made(model(balls, ", friction: 0.3", 0.1, 1e-2));
  const RunSummary r = s.run();
  EXPECT_EQ(r.end, RunEnd::not_converged);
  EXPECT_NE(r.message.find("contacts have 1650 rows, more than the 1500 of law: rigid; use law: "
                           "barrier"),
            std::string::npos)
      << r.message;
}

TEST(RigidLaw, RefusesWhatItDoesNotHave) {
  const std::string ball = "  ball: {shape: {sphere: 0.2}, mass: 1, position: [0, 0, 0.2]}";
  EXPECT_TRUE(expect_fault(model(ball, ", stiffness: 1e5", 0.1, 1e-2),
                           "stiffness: cannot be combined with the law rigid"));
  EXPECT_TRUE(expect_fault(
      model(ball, "", 0.1, 1e-2, "solids: {pad: {mesh: {block: {size: [1, 1, 1]}}, material: m}}"),
      "rigid is not available with deformable solids and cables yet"));
  std::string damped = model(ball, "", 0.1, 1e-2);
  damped.replace(damped.find("step: 0.01"), 10, "step: 0.01, rho_inf: 0.8");
  EXPECT_TRUE(expect_fault(damped, "the law rigid uses the midpoint rule"));
}

}  // namespace polhode::test::rigid_law_tests
