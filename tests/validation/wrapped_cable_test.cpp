// SPDX-License-Identifier: Apache-2.0
// Cables and muscles around obstacles in motion: closed forms, conservation, order, an independent
// integration, messages.
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <polhode/simulation/simulation_details.hpp>
#include <support/run_text.hpp>

namespace polhode::test::wrapped_cable_tests {
namespace {

constexpr double kG = 9.81;

/// A forearm with a hinge at the origin, pulled by 25 N around a cylinder of 30 mm about the hinge.
const char* const kElbow = R"(
format: 1
variables: {h: 5 ms, side: -1}
bodies: {forearm: {mass: 1.5, inertia: [0.002, 0.02, 0.02], position: [0.15, 0, 0]}}
joints: {elbow: {type: revolute, bodies: [ground, forearm], at: [0, 0, 0], axis: y}}
cables:
  pull:
    through: [[ground, [-0.01, 0, 0.3]], [forearm, [-0.145, 0, -0.06]]]
    tension: 25 N
    around: {trochlea: {type: cylinder, body: ground, radius: 30 mm, axis: y, side: [side, 0, 0]}}
analysis: {type: dynamics, duration: 0.2 s, step: h}
output: {hdf5: false}
)";

/// Two weights of 3 kg and 2 kg on the ends of a rope over a wheel of 100 mm.
std::string weights(const std::string& more = "") {
  return R"(
format: 1
gravity: [0, 0, -9.81]
variables: {h: 5 ms}
bodies:
  heavy: {mass: 3, inertia: [1, 1, 1], position: [-0.1, 0, -2]}
  light: {mass: 2, inertia: [1, 1, 1], position: [0.1, 0, -2]}
joints:
  left: {type: prismatic, bodies: [ground, heavy], at: [-0.1, 0, -2], axis: z}
  right: {type: prismatic, bodies: [ground, light], at: [0.1, 0, -2], axis: z}
cables:
  rope:
    through: [[heavy], [light]]
    slides: true
    stiffness: 4e4
    around: {wheel: {type: cylinder, body: ground, at: [0, 0, 0.2], radius: 0.1, axis: y, side: z)" +
         more + R"(}}
analysis: {type: dynamics, duration: 0.5 s, step: h}
output: {hdf5: false}
)";
}

/// Two free bodies, tied by a rope around an ellipsoid on the first and a sphere on the second.
const char* const kTied = R"(
format: 1
variables: {h: 5 ms, rho: 1}
bodies:
  one: {mass: 3, inertia: [0.1, 0.2, 0.25], angular_velocity: [1, 2, 3]}
  two: {mass: 2, inertia: [0.1, 0.05, 0.12], position: [1.5, 0.3, 0], velocity: [0, 1.2, 0.3], angular_velocity: [0, -3, 1]}
cables:
  rope:
    through: [[one, [-0.5, 0.02, 0]], [two, [-0.1, 0, 0.1]], [one, [0.1, 0.4, 0.2]]]
    slides: true
    stiffness: 60
    free_length: 3
    around:
      bone: {type: ellipsoid, body: one, at: [0.05, 0.02, 0], semi_axes: [0.2, 0.12, 0.15], after: 1}
      ball: {type: sphere, body: two, at: [-0.3, 0.05, 0.15], radius: 0.1, after: 2}
analysis: {type: dynamics, duration: 1.5 s, step: h, rho_inf: rho}
output: {hdf5: false}
)";

/// Angle by which a cable bends between its ends: from the directions of its straight parts.
double bend(const CableReport& cable, std::size_t first, std::size_t last) {
  const Vec3 in = (cable.position[first + 1] - cable.position[first]).normalized();
  const Vec3 out = (cable.position[last] - cable.position[last - 1]).normalized();
  return std::atan2(in.cross(out).norm(), in.dot(out));
}

}  // namespace

// The moment arm on a cylinder about the hinge is its radius: the moment is constant and the angle
// a parabola, on either side.
TEST(WrappedCable, HasTheRadiusOfACylinderAsMomentArm) {
  const double inertia = 0.02 + 1.5 * 0.15 * 0.15, moment = 25.0 * 0.03;
  for (const double h : {0.02, 0.005, 0.00005})
    for (const char* side : {"-1", "1"}) {
      Simulation s = made(kElbow, {"h=" + std::to_string(h), std::string("side=") + side});
      const double start = s.cable(0).whole->length;
      const RunSummary r = finished(s);
      const Quat q = s.body(0).q;
      const double angle = 2.0 * std::atan2(q.y(), q.w());
      EXPECT_NEAR(std::abs(angle), 0.5 * moment / inertia * 0.04, 0.3 * h * h + 1e-9) << h;
      EXPECT_EQ(angle > 0.0, side[0] == '-');
      EXPECT_NEAR(start - s.cable(0).whole->length, 0.03 * std::abs(angle), 1e-14);
      EXPECT_NEAR(s.balance().put_in, 25.0 * 0.03 * std::abs(angle), 1e-12);
      EXPECT_LT(r.energy_drift, 1e-12) << h;
    }
}

// Atwood's machine on a wheel without mass: a = (m1 − m2) g/(m1 + m2), and half a turn of rope on
// it.
TEST(WrappedCable, MovesAtwoodsMachineByTheClosedForm) {
  const double pi = std::acos(-1.0);
  for (const double h : {0.05, 0.005, 0.00005}) {
    Simulation s = made(weights(), {"h=" + std::to_string(h)});
    EXPECT_NEAR(s.cable(0).whole->length, 4.4 + 0.1 * pi, 1e-14);
    const RunSummary r = finished(s);
    const double stretch = 2.0 * 3.0 * 2.0 * kG / 5.0 / 4e4 * (4.4 + 0.1 * pi);
    // The rope starts without tension and vibrates: its ends are off by its stretch.
    EXPECT_NEAR(s.body(0).r[2] - s.body(1).r[2], -kG / 5.0 * 0.25, 2.5 * stretch) << h;
    EXPECT_NEAR(bend(s.cable(0), 0, s.cable(0).position.size() - 1), pi, 1e-12);
    EXPECT_LT(r.energy_drift, 1e-12) << h;
  }
}

// @tests{wrap-gradient}
TEST(WrappedCable, KeepsEnergyAndBothMomenta) {
  for (const double h : {0.02, 0.005, 0.00005}) {
    Simulation s = made(kTied, {"h=" + std::to_string(h)});
    int on = 0, off = 0;
    const RunSummary r = s.run([&](Simulation& now) {
      const CableReport cable = now.cable(0);
      (bend(cable, 0, 18) > 1e-6 ? on : off) += 1;
    });
    EXPECT_EQ(r.end, RunEnd::finished) << r.message;
    EXPECT_GT(on, 0);
    EXPECT_GT(off, 0);
    EXPECT_LT(r.energy_drift, 1e-12) << h;
    EXPECT_LT(r.linear_momentum_drift, 1e-12) << h;
    EXPECT_LT(r.angular_momentum_drift, 1e-12) << h;
  }
}

// While it neither lifts off nor touches, the composition has its order, too.
TEST(WrappedCable, HasTheOrderOfTheMethod) {
  const auto end = [](double h, int order, const char* rho) {
    Simulation s = made(kTied, {"h=" + std::to_string(h), std::string("rho=") + rho,
                                "analysis.order=" + std::to_string(order),
                                "cables.rope.tension_only=false", "analysis.duration=0.06"});
    const RunSummary r = s.run([](Simulation& now) {
      EXPECT_GT(bend(now.cable(0), 0, 18), 0.01);
      EXPECT_GT(bend(now.cable(0), 18, 36), 0.01);
    });
    EXPECT_EQ(r.end, RunEnd::finished) << r.message;
    return std::array{s.body(0).r, s.body(1).r};
  };
  const auto truth = end(0.001, 6, "1");
  const auto error = [&](double h, int order, const char* rho) {
    const auto e = end(h, order, rho);
    return (e[0] - truth[0]).norm() + (e[1] - truth[1]).norm();
  };
  EXPECT_NEAR(std::log2(error(0.01, 2, "1") / error(0.005, 2, "1")), 2.0, 0.15);
  EXPECT_NEAR(std::log2(error(0.01, 2, "0.5") / error(0.005, 2, "0.5")), 2.0, 0.25);
  EXPECT_NEAR(std::log2(error(0.02, 4, "1") / error(0.01, 4, "1")), 4.0, 0.5);
}

/// A pendulum on an elastic rope whose swing a peg bends, in the plane of x and z.
const char* const kPeg = R"(
format: 1
gravity: [0, 0, -9.81]
variables: {h: 5 ms}
bodies: {bob: {mass: 2, point_mass: true, position: [-0.6, 0, -0.8]}}
cables:
  rope:
    through: [[ground, [0, 0, 0]], [bob]]
    slides: true
    stiffness: 400
    free_length: 1
    around: {peg: {type: cylinder, body: ground, at: [0.06, 0, -0.4], radius: 50 mm, axis: y, side: -x}}
analysis: {type: dynamics, duration: 1.6 s, step: h}
output: {hdf5: false}
)";

/// Length of the pendulum's rope by tangents and arc.
double rope_length(double x, double z) {
  const double r = 0.05, a = std::hypot(0.06, 0.4), b = std::hypot(x - 0.06, z + 0.4);
  const double straight = std::hypot(x, z);
  // From the upper end around the left to the bob.
  const double turn =
      std::atan2(-0.06 * (z + 0.4) - 0.4 * (x - 0.06), -0.06 * (x - 0.06) + 0.4 * (z + 0.4));
  const double phi = turn < 0.0 ? turn + 2.0 * std::acos(-1.0) : turn;
  const double arc = phi - std::acos(r / a) - std::acos(r / b);
  return arc > 0.0 ? std::sqrt(a * a - r * r) + std::sqrt(b * b - r * r) + r * arc : straight;
}

// Against Runge-Kutta's rule with the closed form of the length; the rope comes to the peg, leaves
// it and comes again, with one energy.
TEST(WrappedCable, SwingsAroundAPeg) {
  const auto rates = [](const std::array<double, 4>& y) {
    const double d = 1e-6;
    const double N = std::max(0.0, 400.0 * (rope_length(y[0], y[1]) - 1.0));
    const double by_x = (rope_length(y[0] + d, y[1]) - rope_length(y[0] - d, y[1])) / (2.0 * d);
    const double by_z = (rope_length(y[0], y[1] + d) - rope_length(y[0], y[1] - d)) / (2.0 * d);
    return std::array{y[2], y[3], -0.5 * N * by_x, -0.5 * N * by_z - kG};
  };
  std::array<double, 4> y{-0.6, -0.8, 0.0, 0.0};
  const int steps = 64000;
  const double dt = 1.6 / steps;
  int touches = 0, lifts = 0;
  bool on = false;
  for (int i = 0; i < steps; ++i) {
    const auto plus = [&](const std::array<double, 4>& k, double by) {
      std::array<double, 4> z = y;
      for (std::size_t c = 0; c < 4; ++c) z[c] += by * k[c];
      return z;
    };
    const auto k1 = rates(y), k2 = rates(plus(k1, 0.5 * dt)), k3 = rates(plus(k2, 0.5 * dt)),
               k4 = rates(plus(k3, dt));
    for (std::size_t c = 0; c < 4; ++c)
      y[c] += dt / 6.0 * (k1[c] + 2.0 * k2[c] + 2.0 * k3[c] + k4[c]);
    const bool now = rope_length(y[0], y[1]) > std::hypot(y[0], y[1]) + 1e-9;
    touches += now && !on ? 1 : 0;
    lifts += !now && on ? 1 : 0;
    on = now;
  }
  EXPECT_GE(touches, 1);
  EXPECT_GE(lifts, 1);
  for (const double h : {0.02, 0.005, 0.00005}) {
    Simulation s = made(kPeg, {"h=" + std::to_string(h)});
    const RunSummary r = finished(s);
    const double off = std::hypot(s.body(0).r[0] - y[0], s.body(0).r[2] - y[1]);
    EXPECT_LT(off, 150.0 * h * h + 1e-7) << h;
    EXPECT_NEAR(s.cable(0).whole->length, rope_length(s.body(0).r[0], s.body(0).r[2]), 1e-13);
    EXPECT_LT(r.energy_drift, 1e-12) << h;
  }
}

// A muscle and a spring around one obstacle; pieces on it have the length of their arcs.
TEST(WrappedCable, ReportsItsLine) {
  Simulation s = made(kElbow);
  const CableReport cable = s.cable(0);
  ASSERT_EQ(cable.position.size(), 19U);
  ASSERT_EQ(cable.length.size(), 18U);
  double sum = 0.0;
  for (const double length : cable.length) sum += length;
  EXPECT_NEAR(sum, cable.whole->length, 1e-14);
  for (std::size_t i = 1; i < 18; ++i)
    EXPECT_NEAR(std::hypot(cable.position[i].x(), cable.position[i].z()), 0.03, 1e-14);
  EXPECT_LT(cable.position[9].x(), 0.0);  // its side
  for (const double tension : cable.tension) EXPECT_EQ(tension, 25.0);
}

TEST(WrappedCable, ReportsErrors) {
  const auto has = [](std::string text, const std::string& from, const std::string& to,
                      const std::string& wanted) {
    const std::size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    expect_fault(text.replace(at, from.size(), to), wanted);
  };
  has(kElbow, "radius: 30 mm", "radius: 70 mm",
      "cables.pull.around.trochlea: point 2 of the cable is inside of the obstacle, or on it. Move "
      "the point out");
  has(kElbow, "radius: 30 mm", "semi_axes: [1, 1, 1]",
      "cables.pull.around.trochlea.semi_axes: does not belong to a cylinder");
  has(kElbow, "side: [side, 0, 0]", "side: y",
      "cables.pull.around.trochlea.side: is along the axis of the cylinder");
  has(kElbow, "side: [side, 0, 0]", "after: 2",
      "cables.pull.around.trochlea.after: is 2, but the cable has 2 points");
  has(kElbow, "tension: 25 N", "stiffness: 3 N",
      "cables.pull.around: requires 'slides'. Add slides: true, a tension or a muscle");
  has(kElbow, "radius: 30 mm, ", "", "cables.pull.around.trochlea: 'radius' is missing");
  has(kTied, ", after: 2", "", "cables.rope.around.ball: 'after' is missing");
  has(kTied, "after: 2", "after: 1",
      "cables.rope.around.ball: is between the same points as 'bone'");
  has(kTied, "semi_axes: [0.2, 0.12, 0.15], ", "",
      "cables.rope.around.bone: 'semi_axes' is missing");
  has(kTied, "stiffness: 60", "stiffness: 60\n    friction: 0.2",
      "cables.rope.friction: cannot be combined with 'around'");
  has(kTied, "step: h", "step: h, order: 4, method: extrapolation",
      "the cable 'rope' runs around an obstacle");
}

// Without a side a rope through the middle of the peg would come to the other one.
TEST(WrappedCable, DoesNotPassThroughAnObstacle) {
  std::string text = kPeg;
  text.erase(text.find(", side: -x"), 10);
  Simulation s = made(text);
  const RunSummary r = s.run();
  EXPECT_NE(r.end, RunEnd::finished);
  EXPECT_NE(
      r.message.find("around 'peg') has a point inside of an obstacle, or comes to its other"),
      std::string::npos)
      << r.message;
}

// A point that is drawn into its obstacle: the message names both.
TEST(WrappedCable, EndsWhereAPointComesInside) {
  Simulation s = made(R"(
format: 1
bodies: {bead: {mass: 1, inertia: [1, 1, 1], position: [0.5, 0, 0]}}
cables:
  rope: {through: [[ground, [0, 0, 1]], [bead]], tension: 5, around: {ball: {type: sphere, body: ground, radius: 0.2}}}
loads: {push: {type: force, body: bead, force: [-30, 0, 0]}}
analysis: {type: dynamics, duration: 2 s, step: 5 ms}
output: {hdf5: false}
)");
  const RunSummary r = s.run();
  EXPECT_NE(r.end, RunEnd::finished);
  EXPECT_NE(
      r.message.find("'rope' (running cable around 'ball') has a point inside of an obstacle"),
      std::string::npos)
      << r.message;
}

}  // namespace polhode::test::wrapped_cable_tests
