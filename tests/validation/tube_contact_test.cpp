// SPDX-License-Identifier: Apache-2.0
// Contact with the round faces of tubes: rolling within them, tubes rolling and standing on a
// plane.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "contact/scene.hpp"
#include "contact/shapes_for_tests.hpp"

namespace polhode::tube_contact_tests {
namespace {

using namespace contact;
using namespace test;

/// Rotation of z to y.
Mat3 along_y() { return (Mat3() << 1, 0, 0, 0, 0, 1, 0, -1, 0).finished(); }

enum class Rolling { ball, capsule, cylinder };

struct Inside {
  Rolling body;
  double dt;
};

std::string name_of(const Inside& c) {
  const char* const body = c.body == Rolling::ball      ? "ball"
                           : c.body == Rolling::capsule ? "capsule"
                                                        : "cylinder";
  return std::string(body) + "_at_" + std::to_string(std::lround(1e6 * c.dt)) + "_us";
}

class RollingInATube : public testing::TestWithParam<Inside> {};

/// Oscillation about the bottom with ω² = g/((1 + k)(R − ρ)), k = I/(m ρ²): the displacement of the
/// centre is ρ times the rotation. With a polygon of 48 sides the error would be 2e-3 of R.
TEST_P(RollingInATube, SwingsOnItsOwnRadius) {
  const auto [kind, dt] = GetParam();
  const double R = 0.5, rho = 0.1, A = 0.1, k = kind == Rolling::ball ? 0.4 : 0.5;
  Scene s;
  const BodyMotion start = at({(R - rho) * std::sin(A), 0.003, -(R - rho) * std::cos(A)});
  const ShapePlace lies{Vec3::Zero(), along_y()};
  const int body = kind == Rolling::ball
                       ? s.add_ball("ball", rho, 1.0, start)
                       : s.add("rod",
                               kind == Rolling::capsule ? capsule("rod", 2.0 * rho, 0.4, lies)
                                                        : cylinder("rod", 2.0 * rho, 0.4, lies),
                               1.0, {0.02, 0.5 * rho * rho, 0.02}, start);
  s.contacts->add_shape({kGround, "tube", round_tube(1.2, 2.0 * R, 1.0, lies)});
  s.law(0.5, 0.0);
  s.begin(dt);
  const double period =
      2.0 * std::numbers::pi * std::sqrt((1.0 + k) * (R - rho) / 9.81) * (1.0 + A * A / 16.0);
  std::vector<double> crossings;
  double turn = 0.0, angle = A;
  std::array<double, 2> turns{}, angles{A, A};
  for (double t = dt; t < 2.6 * period; t += dt) {
    const BodyMotion before = s.motion(body);
    ASSERT_TRUE(s.step()) << s.last.text();
    const BodyMotion m = s.motion(body);
    if (before.r.x() * m.r.x() < 0.0)
      crossings.push_back(t - dt * m.r.x() / (m.r.x() - before.r.x()));
    turn += 2.0 * std::asin((m.q * before.q.conjugate()).y());
    angle = std::atan2(m.r.x(), -m.r.z());
    turns = {std::min(turns[0], turn), std::max(turns[1], turn)};
    angles = {std::min(angles[0], angle), std::max(angles[1], angle)};
    EXPECT_NEAR(std::hypot(m.r.x(), m.r.z()), R - rho, 1e-4 * rho);
  }
  ASSERT_GE(crossings.size(), 5u);
  EXPECT_NEAR((crossings[4] - crossings[0]) / (2.0 * period), 1.0, 1e-4);
  EXPECT_NEAR((turns[1] - turns[0]) * rho / ((angles[1] - angles[0]) * (R - rho)), 1.0, 1e-4);
  EXPECT_NEAR(s.motion(body).r.y(), 0.003, 1e-9);
}

INSTANTIATE_TEST_SUITE_P(
    Steps, RollingInATube,
    testing::Values(Inside{Rolling::ball, 5e-3}, Inside{Rolling::ball, 1e-3},
                    Inside{Rolling::ball, 1e-4}, Inside{Rolling::capsule, 5e-3},
                    Inside{Rolling::capsule, 1e-3}, Inside{Rolling::capsule, 1e-4},
                    Inside{Rolling::cylinder, 5e-3}, Inside{Rolling::cylinder, 1e-3},
                    Inside{Rolling::cylinder, 1e-4}),
    [](const auto& given) { return name_of(given.param); });

class TubeOnAPlane : public testing::TestWithParam<double> {};

TEST_P(TubeOnAPlane, RollsOnItsOwnRadius) {
  const double R = 0.3, v = 2.0, dt = GetParam();
  Scene s;
  BodyMotion start = at({0.0, 0.0, R}, {v, 0.0, 0.0});
  start.W = {0.0, v / R, 0.0};
  const int wheel = s.add("wheel", round_tube(2.0 * R, 0.4, 0.1, {Vec3::Zero(), along_y()}), 1.0,
                          {0.03, 0.05, 0.03}, start);
  s.add_floor();
  s.law(0.5, 0.0);
  s.begin(dt);
  double turn = 0.0;
  for (double t = 0.0; t < 0.5; t += dt) {
    const Quat before = s.motion(wheel).q;
    ASSERT_TRUE(s.step()) << s.last.text();
    turn += 2.0 * std::asin((s.motion(wheel).q * before.conjugate()).y());
    EXPECT_NEAR(s.motion(wheel).r.z(), R, 1e-4 * R);
  }
  // The Cayley rotation of a step has the angle 2 atan(θ/2).
  const double cayley = v / R * dt * v / R * dt / 12.0;
  EXPECT_NEAR(s.motion(wheel).r.x() / (R * turn), 1.0, 1e-4 + cayley);
  EXPECT_NEAR(s.motion(wheel).v.x(), v, 1e-4 * v);
}

TEST_P(TubeOnAPlane, SlidesOnItsFaceToAHalt) {
  const double v = 1.0, mu = 0.3;
  Scene s;
  const int tube = s.add("tube", round_tube(0.3, 0.2, 0.2), 1.0, {0.01, 0.01, 0.015},
                         at({0.0, 0.0, 0.1}, {v, 0.0, 0.0}));
  s.add_floor();
  s.law(mu, 0.0);
  s.begin(GetParam());
  ASSERT_TRUE(s.run(0.6)) << s.last.text();
  const BodyMotion m = s.motion(tube);
  EXPECT_NEAR(m.r.x(), v * v / (2.0 * mu * 9.81), 1e-4);
  EXPECT_NEAR(m.r.z(), 0.1, 5e-6);
  EXPECT_LT((m.q * Vec3::UnitZ()).head<2>().norm(), 1e-6);
  EXPECT_LT(m.v.norm(), 1e-3);
}

INSTANTIATE_TEST_SUITE_P(Steps, TubeOnAPlane, testing::Values(5e-3, 1e-3, 1e-4),
                         [](const auto& given) {
                           return std::to_string(std::lround(1e6 * given.param)) + "_us";
                         });

}  // namespace
}  // namespace polhode::tube_contact_tests
