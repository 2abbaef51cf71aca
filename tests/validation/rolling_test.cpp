// SPDX-License-Identifier: Apache-2.0
// Wheels and balls that roll without slip, in complete models.
#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <support/convergence.hpp>
#include <support/reference.hpp>
#include <validation/connector_runs.hpp>

namespace polhode::rolling_tests {

using namespace connectors;
using test::Deviation;
using test::Reference;

namespace {

/// The coin of the reference: tilted by 1 degree about y, axle along x, 5 turns a second about z.
std::string coin(int order) {
  return R"(
format: 1
variables: {h: 0.5 ms}
gravity: [0, 0, -9.81]
bodies:
  coin:
    mass: 1
    inertia: [5e-5, 2.5e-5, 2.5e-5]
    position: [0.00017452406437283512, 0, 0.009998476951563915]
    orientation: {axis: y, angle: 1 deg}
    velocity: [0, 0.005482834846, 0]
    angular_velocity: [0, 0, 31.41592653589793]
loads:
  it: {type: rolling, bodies: [ground, coin], at: [[0, 0, 0], [0.00017452406437283512, 0, 0.009998476951563915]], axle: [0.99984769515639127, 0, -0.01745240643728351], radius: 0.01}
analysis: {type: dynamics, duration: 0.5 s, step: h, order: )" +
         std::to_string(order) + R"(}
output: {hdf5: false}
)";
}

Vec observed(const Simulation& s) {
  const BodyMotion b = s.body(0);
  Vec x(6);
  x << b.r, 0.01 * b.omega();
  return x;
}

Deviation coin_deviation(int order, const std::string& h) {
  return test::deviation_from(Reference::read("rolling_coin"),
                              io::read_model_text(coin(order), "coin.yaml", {"variables.h=" + h}),
                              0.5, [](const Simulation& s) {
                                Vec x = observed(s);
                                x.tail<3>() *= 100.0;
                                return x;
                              });
}

}  // namespace

// Positions to a millionth of the radius; angular velocities of 30 rad/s. @tests{rolling-height}
// @tests{rolling-slip}
TEST(Rolling, FollowsTheReferenceSolutionOfACoin) {
  const Deviation coarse = coin_deviation(2, "0.5 ms"), fine = coin_deviation(2, "0.1 ms");
  EXPECT_GE(fine.samples, 100);
  EXPECT_LT(fine.largest, 2e-2);
  EXPECT_NEAR(coarse.largest / fine.largest, 25.0, 3.0);
  const Deviation sixth = coin_deviation(6, "1 ms");
  EXPECT_LT(sixth.largest, 1e-5);
  for (const Deviation& d : {coarse, fine, sixth}) {
    EXPECT_LT(d.summary.energy_drift, 1e-11);
    EXPECT_LT(d.summary.constraint_residual_max, 1e-13);
  }
}

TEST(Rolling, ConvergesWithEachOrder) {
  const Simulation exact = [] {
    Simulation s(io::read_model_text(coin(6), "coin.yaml",
                                     {"variables.h=0.5 ms", "analysis.duration=0.2 s"}));
    (void)s.run();
    return s;
  }();
  for (const int order : {2, 4, 6}) {
    const auto error = [&](int n) {
      Simulation s(io::read_model_text(
          coin(order), "coin.yaml",
          {"variables.h=" + std::to_string(200.0 / n) + " ms", "analysis.duration=0.2 s"}));
      const RunSummary summary = s.run();
      EXPECT_LT(summary.energy_drift, 1e-11);
      return (observed(s) - observed(exact)).norm();
    };
    test::expect_order(error,
                       order == 2   ? std::vector<int>{200, 400}
                       : order == 4 ? std::vector<int>{50, 100}
                                    : std::vector<int>{25, 50},
                       order, 0.4, "order " + std::to_string(order));
  }
}

namespace {

/// A ball or wheel on a slope of 0.3 rad: the plane is horizontal, gravity is inclined.
std::string slope(const std::string& body, const std::string& load, const std::string& more = "") {
  return R"(
format: 1
variables: {h: 5 ms}
gravity: [2.8990, 0, -9.3718]
bodies: {it: )" +
         body + "}\n" + more + "loads: {it: " + load + R"(}
analysis: {type: dynamics, duration: 1 s, step: h}
output: {hdf5: false}
)";
}

}  // namespace

// s̈ = g sin α/(1 + J/(m r²)): 5/7 of it for a ball, 2/3 for a disc; the rest is the friction
// force. The way is that of the angle, of which a step h takes 2 atan(ωh/2) for ωh: at most the
// part (ωh)²/12 of it is missing.
TEST(Rolling, AcceleratesDownASlope) {
  struct Case {
    const char* body;
    const char* load;
    double part;
  };
  const Case cases[] = {
      {"{mass: 3, inertia: [0.012, 0.012, 0.012], position: [0, 0, 0.1]}",
       "{type: rolling, bodies: [ground, it], at: [[0, 0, 0], [0, 0, 0.1]], radius: 0.1, "
       "edge_radius: 0.1}",
       5.0 / 7.0},
      {"{mass: 2, inertia: [0.005, 0.01, 0.005], position: [0, 0, 0.1]}",
       "{type: rolling, bodies: [ground, it], at: [[0, 0, 0], [0, 0, 0.1]], radius: 0.1}",
       2.0 / 3.0},
      {"{mass: 2, inertia: [0.005, 0.01, 0.005], position: [0, 0, 0.1]}",
       "{type: rolling, bodies: [ground, it], at: [[0, 0, 0], [0, 0, 0.1]], radius: 0.1, "
       "edge_radius: 0.03}",
       2.0 / 3.0},
  };
  for (const Case& c : cases)
    for (const Step& step : kSteps) {
      const Outcome o = run(slope(c.body, c.load), {step_of(step)});
      const double a = c.part * 2.8990, m = c.part < 0.7 ? 2.0 : 3.0;
      const double missing = std::pow(a / 0.1 * step.h, 2) / 12.0 + 1e-9;
      EXPECT_NEAR(o.body(0).r.x(), 0.5 * a, missing * 0.5 * a) << step.text;
      EXPECT_NEAR(o.body(0).W.y(), a / 0.1, missing * a / 0.1) << step.text;
      EXPECT_NEAR(o.load[0], -(1.0 - c.part) * m * 2.8990, 1e-6) << step.text;
      EXPECT_NEAR(o.load[6], m * 9.3718, 1e-6) << step.text;
      EXPECT_NEAR(o.load[3], o.body(0).r.x(), 1e-9) << step.text;  // contact point
      EXPECT_LT(o.summary.energy_drift, 1e-12) << step.text;
    }
}

// The way is the radius times the angle to round-off: by a radian, a tenth and a thousandth of it a
// step.
TEST(Rolling, GoesByItsRadiusTimesItsAngleInStepsOfAnyLength) {
  for (const char* step : {"100 ms", "10 ms", "0.1 ms"}) {
    Simulation s(io::read_model_text(std::string(R"(
format: 1
bodies: {w: {mass: 2, inertia: [0.03, 0.05, 0.03], position: [0, 0, 0.2], velocity: [2, 0, 0], angular_velocity: [0, 10, 0]}}
joints: {j: {type: generic, bodies: [ground, w], at: [0, 0, 0.2], free: [x, z, ry]}}
loads: {r: {type: rolling, bodies: [ground, w], at: [[0, 0, 0], [0, 0, 0.2]], radius: 0.2, axle: y}}
analysis: {type: dynamics, duration: 1 s, step: )") +
                                         step + "}\noutput: {hdf5: false}\n",
                                     "wheel.yaml"));
    const RunSummary summary = s.run();
    EXPECT_EQ(summary.end, RunEnd::finished) << summary.message;
    const JointReport j = s.joint(0);
    if (std::string(step) == "0.1 ms") {
      EXPECT_NEAR(s.body(0).r.x(), 2.0, 1e-6);
    }
    EXPECT_NEAR(s.body(0).r.x(), 0.2 * j.coordinates.back(), 1e-12) << step;
    EXPECT_LT(summary.energy_drift, 1e-12) << step;
  }
}

// A ball on a turntable runs in circles, with 2/7 of the table's speed (Earnshaw): in the ground
// frame v̇ = (2/7) Ω ẑ × v. The body of the plane is driven.
TEST(Rolling, CirclesOnATurntable) {
  const double Omega = 6.0, v = 0.4, T = 2.0 * kPi / (2.0 / 7.0 * Omega),
               R = v / (2.0 / 7.0 * Omega);
  for (const double h : {0.02, 0.005, 0.001}) {
    const int n = static_cast<int>(std::ceil(0.5 * T / h));
    Simulation s(io::read_model_text(R"(
format: 1
bodies:
  table: {mass: 5, inertia: [1, 1, 1], angular_velocity: [0, 0, 6]}
  ball: {mass: 3, inertia: [0.012, 0.012, 0.012], position: [0, 0, 0.1], velocity: [0.4, 0, 0], angular_velocity: [0, 4, 0]}
joints: {axle: {type: revolute, bodies: [ground, table], at: [0, 0, 0], axis: z}}
loads:
  drive: {type: rotary_motor, joint: axle, speed: 6 rad/s}
  it: {type: rolling, bodies: [table, ball], at: [[0, 0, 0], [0, 0, 0.1]], radius: 0.1, edge_radius: 0.1}
analysis: {type: dynamics, duration: )" + std::to_string(0.5 * T) +
                                         " s, step: " + std::to_string(0.5 * T / n) + R"( s}
output: {hdf5: false}
)",
                                     "table.yaml"));
    const RunSummary summary = s.run();
    // Half a circle of radius R to the left: at (0, 2R), moving in the opposite direction.
    const BodyMotion ball = s.body(1);
    EXPECT_NEAR(ball.r.x(), 0.0, 40.0 * h * h + 2e-6) << h;
    EXPECT_NEAR(ball.r.y(), 2.0 * R, 40.0 * h * h + 2e-6) << h;
    EXPECT_NEAR(ball.v.x(), -v, 40.0 * h * h + 2e-6) << h;
    EXPECT_LT(summary.energy_drift, 1e-11) << h;
  }
}

// A wheel on a plane of another free body: both momenta are conserved.
TEST(Rolling, KeepsMomentaOnAFreePlane) {
  for (const int order : {2, 4, 6}) {
    const Outcome o = run(R"(
format: 1
bodies:
  raft: {mass: 5, inertia: [1, 1, 2], angular_velocity: [0.1, 0.2, 0.3]}
  wheel: {mass: 2, inertia: [0.005, 0.01, 0.005], position: [0, 0, 0.1], velocity: [1, 0.02, 0], angular_velocity: [0.1, 10, 1]}
loads:
  it: {type: rolling, bodies: [raft, wheel], at: [[0, 0, 0], [0, 0, 0.1]], radius: 0.1, edge_radius: 0.02}
analysis: {type: dynamics, duration: 1 s, step: 5 ms, order: )" +
                          std::to_string(order) + R"(}
output: {hdf5: false}
)");
    EXPECT_LT(o.summary.energy_drift, 1e-11) << order;
    EXPECT_LT(o.summary.linear_momentum_drift, 1e-12) << order;
    EXPECT_LT(o.summary.angular_momentum_drift, 1e-12) << order;
  }
}

TEST(Rolling, ContinuesAfterARestartBitForBit) {
  const auto model = [] {
    return io::read_model_text(coin(2), "coin.yaml", {"analysis.duration=0.1 s"});
  };
  Simulation straight(model());
  for (int k = 0; k < 100; ++k) ASSERT_TRUE(straight.step(1e3).accepted);
  Simulation again(model(), straight.state());
  for (int k = 0; k < 100; ++k) {
    ASSERT_TRUE(straight.step(1e3).accepted);
    ASSERT_TRUE(again.step(1e3).accepted);
  }
  EXPECT_EQ(straight.body(0).r, again.body(0).r);
  EXPECT_EQ(straight.body(0).W, again.body(0).W);
}

// A coin that falls flat on its side.
TEST(Rolling, EndsWhereAWheelFallsFlat) {
  Simulation s(io::read_model_text(R"(
format: 1
gravity: [0, 0, -9.81]
bodies: {coin: {mass: 1, inertia: [2.5e-3, 5e-3, 2.5e-3], position: [0, 0.05, 0.0866025], orientation: {axis: x, angle: -30 deg}}}
loads: {it: {type: rolling, bodies: [ground, coin], at: [[0, 0, 0], [0, 0.05, 0.0866025]], axle: [0, 0.8660254, -0.5], radius: 0.1}}
analysis: {type: dynamics, duration: 2 s, step: 1 ms}
output: {hdf5: false}
)",
                                   "coin.yaml"));
  const RunSummary summary = s.run();
  EXPECT_EQ(summary.end, RunEnd::not_converged);
  EXPECT_THAT(summary.message, testing::HasSubstr("'it'"));
  // An upright wheel of a slim disc falls in some sqrt(R/g).
  EXPECT_GT(s.time(), 0.1);
  EXPECT_LT(s.time(), 1.0);
}

}  // namespace polhode::rolling_tests
