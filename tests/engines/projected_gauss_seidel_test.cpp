// SPDX-License-Identifier: Apache-2.0
#include <vector>

#include <gtest/gtest.h>

#include <polhode/engines/compact_gauss_seidel.hpp>
#include <polhode/math/hat.hpp>

namespace polhode::projected_gauss_seidel_tests {
namespace {

/// A pile of five balls on the ground, falling, or of bodies that turn differently about each axis.
ProjectedGaussSeidel pile(bool balls, double friction) {
  ProjectedGaussSeidel s;
  const Vec3 places[] = {{0, 0, 1}, {2, 0, 1}, {1, 1.7, 1}, {1, 0.6, 2.6}, {1.2, 0.7, 4.6}};
  for (int k = 0; k < 5; ++k) {
    ProjectedGaussSeidel::Body b;
    b.inverse_mass = 1.0 / (1.0 + 0.3 * k);
    b.inverse_inertia = 2.5 * b.inverse_mass * Mat3::Identity();
    if (!balls) b.inverse_inertia.diagonal() += Vec3(0.3, 0.0, 0.9 * k);
    b.v = Vec3(0.2 * k, 0.1, -2.0 + 0.1 * k);
    b.w = Vec3(0.3, -0.2 * k, 0.5);
    s.bodies.push_back(b);
  }
  s.bodies.emplace_back();  // the ground
  const auto touch = [&](int a, int b) {
    ProjectedGaussSeidel::Point p;
    p.a = a, p.b = b;
    p.normal = b == 5 ? Vec3::UnitZ() : Vec3((places[a] - places[b]).normalized());
    p.arm_a = -p.normal;
    p.arm_b = b == 5 ? Vec3::Zero() : p.normal;
    p.least = -0.05 * a;
    p.wanted = 0.1 * p.normal.unitOrthogonal();
    p.friction = friction;
    s.points.push_back(p);
  };
  for (const auto& [a, b] : {std::pair(0, 5), std::pair(1, 5), std::pair(2, 5), std::pair(3, 0),
                             std::pair(3, 1), std::pair(3, 2), std::pair(4, 3)})
    touch(a, b);
  s.prepare();
  return s;
}

/// @tests{nonsmooth-projection}
TEST(ProjectedGaussSeidel, SatisfiesComplementarityAndCoulombsLaw) {
  for (const bool balls : {true, false}) {
    ProjectedGaussSeidel s = pile(balls, 0.3);
    double change = 1.0;
    for (int k = 0; k < 20000 && change > 1e-28; ++k) change = s.sweep(k % 2 == 1);
    EXPECT_LE(change, 1e-28);
    int slip = 0, stick = 0;
    for (const ProjectedGaussSeidel::Point& p : s.points) {
      const auto &a = s.bodies[p.a], &b = s.bodies[p.b];
      const Vec3 y = a.v + a.w.cross(p.arm_a) - b.v - b.w.cross(p.arm_b);
      const double over = p.normal.dot(y) - p.least;
      EXPECT_GE(over, -1e-12);
      EXPECT_GE(p.normal_impulse, 0.0);
      EXPECT_LT(p.normal_impulse * over, 1e-11);
      const Vec3 slips = y - p.normal.dot(y) * p.normal - p.wanted;
      EXPECT_LE(p.friction_impulse.norm(), 0.3 * p.normal_impulse * (1.0 + 1e-12));
      if (slips.norm() < 1e-10) {
        ++stick;
        continue;
      }
      ++slip;  // opposite to the slip, on the boundary of the friction cone
      EXPECT_LT((p.friction_impulse + 0.3 * p.normal_impulse * slips.normalized()).norm(), 1e-9);
    }
    EXPECT_GT(stick, 0);
    EXPECT_GT(slip, 0);
  }
}

/// Piles of balls, and of balls with one to three other bodies and with a point that is not central
/// among them.
TEST(CompactGaussSeidel, AgreesWithTheGeneralSweeps) {
  for (const std::vector<int>& other : {std::vector<int>{}, {3}, {0, 4}, {0, 1, 3}, {5}}) {
    ProjectedGaussSeidel s = pile(true, 0.3);
    for (const int b : other)
      if (b < 5) s.bodies[b].inverse_inertia.diagonal() += Vec3(0.3, 0.0, 0.9);
    if (!other.empty()) s.points[1].arm_a = {0.1, 0.0, -1.0};
    s.prepare();
    ProjectedGaussSeidel copy = s;
    CompactGaussSeidel compact;
    ASSERT_TRUE(compact.take(copy));
    for (int k = 0; k < 9; ++k) {
      const double change = s.sweep(k % 2 == 1);
      EXPECT_NEAR(compact.sweep(k % 2 == 1), change, 1e-12 * change + 1e-28);
    }
    compact.give_back();
    for (std::size_t k = 0; k < s.points.size(); ++k) {
      EXPECT_NEAR(copy.points[k].normal_impulse, s.points[k].normal_impulse, 1e-13);
      EXPECT_LT((copy.points[k].friction_impulse - s.points[k].friction_impulse).norm(), 1e-13);
    }
    for (std::size_t b = 0; b < s.bodies.size(); ++b) {
      EXPECT_LT((copy.bodies[b].v - s.bodies[b].v).norm(), 1e-13);
      EXPECT_LT((copy.bodies[b].w - s.bodies[b].w).norm(), 1e-13);
    }
  }
  ProjectedGaussSeidel others = pile(false, 0.3);
  EXPECT_FALSE(CompactGaussSeidel().take(others));
}

}  // namespace
}  // namespace polhode::projected_gauss_seidel_tests
