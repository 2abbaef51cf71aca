// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <gtest/gtest.h>

#include <polhode/engines/impulse_newton.hpp>

namespace polhode::impulse_newton_tests {
namespace {

constexpr double kFall = 9.81e-3;  ///< Velocity added by gravity in a step [m/s].

/// A column of balls on the ground, after one step of free fall, that slides along x.
ProjectedGaussSeidel column(const std::vector<double>& masses, double along) {
  ProjectedGaussSeidel s;
  const double R = 0.05;
  for (const double m : masses) {
    ProjectedGaussSeidel::Body b;
    b.inverse_mass = 1.0 / m;
    b.inverse_inertia = Mat3::Identity() / (0.4 * m * R * R);
    b.v = Vec3(along, 0.0, -kFall);
    s.bodies.push_back(b);
  }
  s.bodies.emplace_back();
  for (std::size_t k = 0; k < masses.size(); ++k) {
    ProjectedGaussSeidel::Point p;
    p.a = static_cast<int>(k);
    p.b = static_cast<int>(k == 0 ? masses.size() : k - 1);
    p.normal = Vec3::UnitZ();
    p.arm_a = Vec3(0.0, 0.0, -R);
    p.arm_b = Vec3(0.0, 0.0, k == 0 ? 0.0 : R);
    p.friction = 0.3;
    s.points.push_back(p);
  }
  s.prepare();
  return s;
}

/// A ton on a gram: the error of sweeps decreases by 1e-6 only, Newton's method converges to the
/// weights.
TEST(ImpulseNewton, ConvergesForATonOnAGram) {
  ProjectedGaussSeidel s = column({1e-3, 1e3}, 0.0);
  for (int k = 0; k < 100; ++k) s.sweep(k % 2 == 1);
  EXPECT_LT(s.points[1].normal_impulse, 1e-3);  // of 9.81 N s
  ASSERT_TRUE(solve_impulses(s, 1e-6 * kFall, 1e-6 * kFall));
  EXPECT_NEAR(s.points[1].normal_impulse, 1e3 * kFall, 3e-3);
  EXPECT_NEAR(s.points[0].normal_impulse - s.points[1].normal_impulse, 1e-3 * kFall, 1e-8);
  for (int b = 0; b < 2; ++b) EXPECT_NEAR(s.bodies[b].v.z(), 0.0, 3e-4 * kFall);
}

/// Slipping and sticking points, against the limit of very many sweeps.
/// @tests{nonsmooth-projection}
TEST(ImpulseNewton, FindsTheLimitOfManySweeps) {
  for (const double along : {0.0, 1e-3, 0.05}) {
    ProjectedGaussSeidel swept = column({2.0, 0.5, 1.0, 3.0}, along), found = swept;
    for (int k = 0; k < 20000; ++k) swept.sweep(k % 2 == 1);
    for (int k = 0; k < 5; ++k) found.sweep(k % 2 == 1);
    ASSERT_TRUE(solve_impulses(found, 1e-7 * kFall, 1e-7 * kFall)) << along;
    for (std::size_t k = 0; k < found.points.size(); ++k) {
      EXPECT_NEAR(found.points[k].normal_impulse, swept.points[k].normal_impulse, 1e-7)
          << along << ' ' << k;
      EXPECT_LT((found.points[k].friction_impulse - swept.points[k].friction_impulse).norm(), 1e-6)
          << along << ' ' << k;
    }
    for (int b = 0; b < 4; ++b)
      EXPECT_LT((found.bodies[b].v - swept.bodies[b].v).norm(), 1e-6) << along << ' ' << b;
  }
}

/// Rolling and torsional friction that holds and that slips, against the limit of very many sweeps.
/// @tests{nonsmooth-projection}
TEST(ImpulseNewton, FindsRollingAndTorsionalFriction) {
  int hold = 0, slip = 0;
  for (const double spin : {0.0, 1e-2, 1.0}) {
    ProjectedGaussSeidel swept = column({2.0, 0.5, 1.0, 3.0}, 0.01);
    for (std::size_t k = 0; k < swept.points.size(); ++k) {
      swept.bodies[k].w = spin * Vec3(0.3, -0.5, k % 2 == 0 ? 1.0 : -0.2);
      swept.turns.push_back({static_cast<int>(k), 1e-3, 2e-3, Vec3::Zero(), Vec3::Zero()});
    }
    swept.prepare();
    ProjectedGaussSeidel found = swept;
    for (int k = 0; k < 200000; ++k) swept.sweep(k % 2 == 1);
    for (int k = 0; k < 5; ++k) found.sweep(k % 2 == 1);
    ASSERT_TRUE(solve_impulses(found, 1e-8 * kFall, 1e-8 * kFall)) << spin;
    for (std::size_t k = 0; k < found.turns.size(); ++k) {
      EXPECT_NEAR(found.points[k].normal_impulse, swept.points[k].normal_impulse, 1e-7) << spin;
      EXPECT_LT((found.turns[k].impulse - swept.turns[k].impulse).norm(), 1e-8) << spin << ' ' << k;
      const Vec3& turning = found.turns[k].impulse;
      const double normal_impulse = found.points[k].normal_impulse,
                   roll = turning.head<2>().norm() / (1e-3 * normal_impulse);
      roll < 0.999 ? ++hold : ++slip;
      EXPECT_LT(roll, 1.0 + 1e-9) << spin << ' ' << k;
      EXPECT_LT(std::abs(turning.z()), 2e-3 * normal_impulse * (1.0 + 1e-9)) << spin << ' ' << k;
    }
    for (int b = 0; b < 4; ++b) {
      EXPECT_LT((found.bodies[b].v - swept.bodies[b].v).norm(), 1e-7) << spin << ' ' << b;
      EXPECT_LT((found.bodies[b].w - swept.bodies[b].w).norm(), 1e-5) << spin << ' ' << b;
    }
  }
  EXPECT_GT(hold, 0);
  EXPECT_GT(slip, 0);
}

/// A box of 1 kg on its four corners, whose impulses are not unique, under one of 100 kg.
TEST(ImpulseNewton, DistributesALoadOverRedundantPoints) {
  ProjectedGaussSeidel s;
  const double a = 0.1;
  for (const double m : {1.0, 100.0}) {
    ProjectedGaussSeidel::Body b;
    b.inverse_mass = 1.0 / m;
    b.inverse_inertia = Mat3::Identity() * (6.0 / (m * 4.0 * a * a));
    b.v = Vec3(0.02, 0.0, -kFall);
    s.bodies.push_back(b);
  }
  s.bodies.emplace_back();
  for (int k = 0; k < 8; ++k) {
    ProjectedGaussSeidel::Point p;
    p.a = k / 4;
    p.b = k < 4 ? 2 : 0;
    p.normal = Vec3::UnitZ();
    p.arm_a = Vec3(k % 2 == 0 ? a : -a, k % 4 < 2 ? a : -a, -a);
    p.arm_b = k < 4 ? Vec3(Vec3::Zero()) : Vec3(p.arm_a.x(), p.arm_a.y(), a);
    p.friction = 0.1;
    s.points.push_back(p);
  }
  s.prepare();
  for (int k = 0; k < 3; ++k) s.sweep(k % 2 == 1);
  ASSERT_TRUE(solve_impulses(s, 1e-9 * kFall, 1e-9 * kFall));
  double on_floor = 0.0, on_box = 0.0, across = 0.0;
  for (int k = 0; k < 8; ++k) {
    EXPECT_GE(s.points[k].normal_impulse, 0.0);
    (k < 4 ? on_floor : on_box) += s.points[k].normal_impulse;
    if (k < 4) across += s.points[k].friction_impulse.x();
  }
  EXPECT_NEAR(on_floor, 101.0 * kFall, 1e-8);
  EXPECT_NEAR(on_box, 100.0 * kFall, 1e-8);
  EXPECT_NEAR(across, -0.1 * on_floor, 1e-8);  // slides: 2 μ g Δt < 0.02 m/s
  for (int b = 0; b < 2; ++b) EXPECT_NEAR(s.bodies[b].v.z(), 0.0, 1e-9);
}

}  // namespace
}  // namespace polhode::impulse_newton_tests
