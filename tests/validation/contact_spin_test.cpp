// SPDX-License-Identifier: Apache-2.0
#include <numbers>

#include <gtest/gtest.h>

#include <polhode/contact/round_solids/ellipsoid.hpp>

#include "contact/scene.hpp"

namespace polhode::contact_spin_tests {
namespace {

using namespace test;

/// A ball whose centre of mass lies below its middle, spinning fast: it turns over. The component
/// of the angular momentum along the arm to the point of contact (Jellett) is conserved.
TEST(ContactSpin, TippeTopTurnsOver) {
  const double m = 6e-3, R = 1.5e-2, a = 0.3 * R;
  Scene s;
  BodyMotion start = at({0.0, 0.0, R});
  start.q = Quat(Eigen::AngleAxisd(0.1, Vec3::UnitX()));
  start.W = start.q.conjugate() * Vec3(0.0, 0.0, 155.0);
  // The middle of the ball is at +a on the axis of the body, whose origin is the centre of mass.
  start.r = Vec3(0.0, 0.0, R) - start.q * Vec3(0.0, 0.0, a);
  const double J = 131.0 / 350.0 * m * R * R;
  const int top = s.add("top", geometry::sphere("top", 2.0 * R, {{0.0, 0.0, a}, Mat3::Identity()}),
                        m, {J, J, 0.4 * m * R * R}, start);
  s.add_floor();
  contact::ContactLaw law;
  law.friction.mu = 0.3;
  law.tolerance = 1e-4;
  law.stiffness = 2e3;
  s.contacts->set_default(law);
  s.begin(1e-3);
  const auto jellett = [&] {
    const BodyMotion now = s.motion(top);
    const Vec3 L = now.q * (Vec3(J, J, 0.4 * m * R * R).cwiseProduct(now.W));
    return -L.dot(now.q * Vec3(0.0, 0.0, a) - Vec3(0.0, 0.0, R));
  };
  const double first = jellett();
  double drift = 0.0, energy = s.energy(), rise = 0.0;
  for (int k = 0; k < 2500; ++k) {
    ASSERT_TRUE(s.step()) << s.last.text();
    drift = std::max(drift, std::abs(jellett() / first - 1.0));
    rise = std::max(rise, s.energy() - energy);
    energy = s.energy();
  }
  const double tilt = std::acos((s.motion(top).q * Vec3::UnitZ()).z()) * 180.0 / std::numbers::pi;
  EXPECT_GT(tilt, 90.0);
  EXPECT_LT(drift, 0.01);
  EXPECT_LT(rise, 1e-12 * s.state.ledger.energy_scale);
  EXPECT_LT(s.iterations, 5 * s.steps);
}

/// An ellipsoid whose principal axes of inertia are rotated relative to its shape: in one direction
/// it continues to spin, in the other one it rattles and reverses.
TEST(ContactSpin, RattlebackReversesOneWayOnly) {
  for (const double sign : {-1.0, 1.0}) {
    Scene s;
    BodyData data;
    data.name = "stone";
    data.mass = 1.0;
    data.inertia << 2e-4, -2e-5, 0.0, -2e-5, 1.6e-3, 0.0, 0.0, 0.0, 1.7e-3;
    contact::ContactLaw law;
    law.friction.mu = 2.0;
    law.restitution = 1.0;
    law.tolerance = 2.5e-4;
    law.stiffness = 1e5;
    law.friction.stiffness = 1e6;
    law.friction.damping = 200.0;
    s.contacts->set_default(law);
    BodyMotion start;
    start.q = Quat(Eigen::AngleAxisd(0.5 / 180.0 * std::numbers::pi, Vec3::UnitX()));
    // Lowest point of the ellipsoid, whose middle lies 0.01 above the centre of mass.
    const Vec3 axes(0.2, 0.03, 0.02), n = start.q.conjugate() * Vec3::UnitZ();
    const double height = axes.cwiseProduct(n).norm();
    start.r = {0.0, 0.0, height - 0.01 * n.z() + resting_gap(1e5, 2.5e-4, 9.81)};
    start.W = start.q.conjugate() * Vec3(0.0, 0.0, 5.0 * sign);
    const int stone = s.system.add_body(data, start);
    s.contacts->add_shape(
        {stone, "stone",
         contact::ellipsoid("stone", 2.0 * axes, {{0.0, 0.0, 0.01}, Mat3::Identity()})});
    s.add_floor();
    s.begin(2e-3);
    double least = 5.0, largest = -5.0;
    for (int k = 0; k < 5000; ++k) {
      ASSERT_TRUE(s.step()) << s.last.text();
      const double spin = s.motion(stone).omega().z();
      least = std::min(least, spin);
      largest = std::max(largest, spin);
    }
    if (sign < 0.0) {
      EXPECT_GT(largest, 1.0) << "did not reverse";
    } else {
      EXPECT_GT(least, 4.0) << "lost its spin in the direction in which it should continue";
    }
  }
}

/// A rod pushed along a rough floor under an angle at which no finite friction force solves the
/// rigid equations: the step is accepted, the tip stops, and no energy is gained.
TEST(ContactSpin, PainleveRodIsArrested) {
  for (const double v : {-1.0, 1.0})
    for (const double dt : {2e-3, 5e-4}) {
      Scene s;
      const double half = 1.0, angle = 1.0;
      BodyMotion start = at({0.0, 0.0, half * std::sin(angle) + 4.9e-4}, {v, 0.0, 0.0});
      start.q = Quat(Eigen::AngleAxisd(-angle, Vec3::UnitY()));
      const int rod =
          s.add("rod",
                geometry::capsule(
                    "rod", 1e-4, 2.0 * half,
                    {Vec3::Zero(),
                     Quat::FromTwoVectors(Vec3::UnitZ(), Vec3::UnitX()).toRotationMatrix()}),
                1.0, {1e-3, 1.0 / 3.0, 1.0 / 3.0}, start);
      s.add_floor();
      contact::ContactLaw law;
      law.friction.mu = 2.0;
      law.tolerance = 5e-4;
      law.stiffness = 1e6;
      law.friction.stiffness = 1e6;
      law.friction.damping = 500.0;
      s.contacts->set_default(law);
      s.begin(dt);
      const double energy = s.energy();
      double slowest = 10.0;
      while (s.state.t < 0.15 - 1e-9) {
        ASSERT_TRUE(s.step()) << s.last.text();
        const BodyMotion m = s.motion(rod);
        const Vec3 tip = m.v + m.omega().cross(m.q * Vec3(-half, 0.0, 0.0));
        slowest = std::min(slowest, std::abs(tip.x()));
        ASSERT_LE(s.energy(), energy * (1.0 + 1e-12));
      }
      EXPECT_LT(slowest, 0.05) << v << " " << dt;
    }
}

}  // namespace
}  // namespace polhode::contact_spin_tests
