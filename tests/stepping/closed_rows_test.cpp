// SPDX-License-Identifier: Apache-2.0
// Accelerations and reactions at instants at which stops and contacts carry load, against closed
// forms, at any step: forces of the step are means over it.
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <polhode/core/format.hpp>
#include <support/run_text.hpp>

namespace polhode::test::closed_rows_tests {
namespace {

constexpr double kG = 9.81;
const std::vector<std::string> kSteps{"step: 0.2", "step: 0.01", "step: 1e-4", "tolerance: 1e-5"};

/// A lever of 1 kg on its stop at 0.5 rad, pressed by 30 t N m and lifted by none of it: its hinge
/// carries the weight alone, the stop the moments. @tests{closed-rows}
TEST(ClosedRows, ALeverOnItsStopIsAtRestAtEveryInstant) {
  for (const std::string& step : kSteps) {
    Simulation s = made(format(R"yaml(
format: 1
gravity: [0, 0, -9.81]
bodies: {{b: {{mass: 1, inertia: [0.1, 0.1, 0.1], position: [0.5, 0, 0]}}}}
joints: {{j: {{type: revolute, bodies: [ground, b], at: [0, 0, 0], axis: y, limits: {{upper: 0.5}}}}}}
loads: {{m: {{type: joint_moment, joint: j, moment: 30*t}}}}
contacts: {{default: {{law: rigid}}}}
analysis: {{duration: 2, {}}}
output: {{hdf5: false}}
)yaml",
                               step));
    const RunSummary r = finished(s);
    for (const std::string& warning : step == "step: 0.2" ? std::vector<std::string>() : r.warnings)
      EXPECT_EQ(warning.find("velocities violate"), std::string::npos) << warning;
    const JointReport j = s.joint(0);
    EXPECT_LT((j.force - Vec3(0, 0, kG)).norm(), 1e-9) << step;
    EXPECT_NEAR(j.stops.at(0), -(60.0 + kG * 0.5 * std::cos(0.5)), 1e-8) << step;
    EXPECT_LT(s.point(0, Vec3::Zero()).acceleration.norm(), 1e-9) << step;
    EXPECT_LT(s.angular_acceleration(0).norm(), 1e-9) << step;
  }
}

/// A joint that breaks at 11 N and carries 9.81 N, as its stop takes 90 N m from the start on.
TEST(ClosedRows, AJointDoesNotBreakAtTheStartByTheLoadOfItsStop) {
  for (const std::string& step : kSteps) {
    Simulation s = made(format(R"yaml(
format: 1
gravity: [0, 0, -9.81]
bodies: {{b: {{mass: 1, inertia: [0.1, 0.1, 0.1], position: [0.5, 0, 0]}}}}
joints:
  j: {{type: revolute, bodies: [ground, b], at: [0, 0, 0], axis: y, limits: {{upper: 0}}, breaks: {{force: 11}}}}
loads: {{m: {{type: moment, body: b, moment: [0, 90, 0]}}}}
contacts: {{default: {{law: rigid}}}}
analysis: {{duration: 0.4, {}}}
output: {{hdf5: false}}
)yaml",
                               step));
    (void)finished(s);
    EXPECT_LT((s.joint(0).force - Vec3(0, 0, kG)).norm(), 1e-9) << step;
  }
}

std::string box(const std::string& pull, const std::string& step) {
  return format(R"yaml(
format: 1
gravity: [0, 0, -9.81]
bodies:
  floor: {{fixed: true, shape: {{plane: z}}}}
  box: {{mass: 2, inertia: [0.1, 0.1, 0.1], position: [0, 0, 0.2], shape: {{box: [0.4, 0.4, 0.4]}}}}
  load: {{mass: 1, inertia: [0.1, 0.1, 0.1], position: [0, 0, 0.2]}}
joints: {{weld: {{type: fixed, bodies: [box, load], at: [0, 0, 0.2]}}}}
loads: {{pull: {{type: force, body: box, at: [0, 0, 0], force: ["{}", 0, 0]}}}}
contacts: {{default: {{law: rigid, friction: 0.5}}}}
analysis: {{duration: 1, {}}}
output: {{hdf5: false}}
)yaml",
                pull, step);
}

/// A box of 2 kg with 1 kg welded to it: it sticks under 10 t N and slides under 20 + 10 t N.
TEST(ClosedRows, ABoxWithFrictionHasTheAccelerationOfTheInstant) {
  for (const std::string& step : kSteps) {
    Simulation sticks = made(box("10*t", step));
    (void)finished(sticks);
    EXPECT_LT(sticks.point(1, Vec3::Zero()).acceleration.norm(), 1e-9) << step;
    EXPECT_LT((sticks.joint(0).force - Vec3(0, 0, kG)).norm(), 1e-8) << step;
    Simulation slides = made(box("20 + 10*t", step));
    (void)finished(slides);
    const double a = (30.0 - 0.5 * 3.0 * kG) / 3.0;
    EXPECT_LT((slides.point(1, Vec3::Zero()).acceleration - Vec3(a, 0, 0)).norm(), 1e-9) << step;
    EXPECT_LT((slides.joint(0).force - Vec3(a, 0, kG)).norm(), 1e-8) << step;
  }
}

/// A ball that slides without friction down another one, with the accelerations of its place and
/// speed: g sin θ along, v²/(R + r) towards the centre.
TEST(ClosedRows, ABallOnABallHasItsCentripetalAcceleration) {
  for (const std::string step : {"step: 0.05", "step: 0.01", "step: 1e-3"}) {
    Simulation s = made(format(R"yaml(
format: 1
gravity: [0, 0, -9.81]
bodies:
  dome: {{fixed: true, shape: {{sphere: 2}}}}
  ball: {{mass: 2, inertia: [0.01, 0.01, 0.01], position: [0, 0, 1.5], velocity: [1, 0, 0], shape: {{sphere: 1}}}}
contacts: {{default: {{law: rigid}}}}
analysis: {{duration: 0.4, {}}}
output: {{hdf5: false}}
)yaml",
                               step));
    (void)finished(s);
    const BodyMotion m = s.body(1);
    ASSERT_NEAR(m.r.norm(), 1.5, 1e-9) << step;
    const Vec3 n = m.r.normalized(), g(0, 0, -kG);
    // Velocities of a step have a normal part of second order.
    const Vec3 v = m.v - n.dot(m.v) * n;
    const Vec3 a = g - n.dot(g) * n - v.squaredNorm() / 1.5 * n;
    EXPECT_LT((s.point(1, Vec3::Zero()).acceleration - a).norm(), 1e-8) << step;
  }
}

/// A ball of 2 kg that rolls under 7 t N at its centre: a = F/(m + I/r²), by friction at rest.
TEST(ClosedRows, ARollingBallIsDrivenByFrictionAtRest) {
  for (const std::string& step : kSteps) {
    Simulation s = made(format(R"yaml(
format: 1
gravity: [0, 0, -9.81]
bodies:
  floor: {{fixed: true, shape: {{plane: z}}}}
  ball: {{mass: 2, inertia: [0.2, 0.2, 0.2], position: [0, 0, 0.5], shape: {{sphere: 1}}}}
loads: {{pull: {{type: force, body: ball, force: [7*t, 0, 0]}}}}
contacts: {{default: {{law: rigid, friction: 0.5}}}}
analysis: {{duration: 1, {}}}
output: {{hdf5: false}}
)yaml",
                               step));
    (void)finished(s);
    const double a = 7.0 / (2.0 + 0.2 / 0.25);
    EXPECT_LT((s.point(1, Vec3::Zero()).acceleration - Vec3(a, 0, 0)).norm(), 1e-8) << step;
    EXPECT_LT((s.angular_acceleration(1) - Vec3(0, a / 0.5, 0)).norm(), 1e-8) << step;
  }
}

}  // namespace
}  // namespace polhode::test::closed_rows_tests
