// SPDX-License-Identifier: Apache-2.0
// Shortest lines around spheres, cylinders and ellipsoids: closed forms, independent integrations.
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include <polhode/geometry/wrapping.hpp>
#include <support/derivative.hpp>

namespace polhode::test::wrapping_tests {
namespace {

using geometry::follow_geodesic;
using geometry::GeodesicEnd;
using geometry::Roller;
using geometry::wrap;
using geometry::Wrapping;

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kPi = std::numbers::pi;

Roller cylinder(double radius) { return {{radius, radius, kInfinite}}; }
Roller sphere(double radius) { return {Vec3::Constant(radius)}; }

/// Length of tangents and arc around a circle, points at distances a and b, angle φ between them.
double around_circle(double radius, double a, double b, double phi) {
  return std::sqrt(a * a - radius * radius) + std::sqrt(b * b - radius * radius) +
         radius * (phi - std::acos(radius / a) - std::acos(radius / b));
}

}  // namespace

// @tests{wrap-length}
TEST(Wrapping, HasTheLengthOfTangentsAndArcOnASphere) {
  const Vec3 p(0.3, -0.4, 0.2), q(-0.35, 0.3, -0.3);
  const double phi = std::acos(p.normalized().dot(q.normalized()));
  const auto w = wrap(sphere(0.25), p, q, false);
  ASSERT_TRUE(w && w->touches);
  EXPECT_NEAR(w->length, around_circle(0.25, p.norm(), q.norm(), phi), 1e-15);
  EXPECT_NEAR(w->from.norm(), 0.25, 1e-15);
  EXPECT_NEAR(w->from.dot(w->from - p), 0.0, 1e-15);  // a tangent
  EXPECT_NEAR(w->angle, phi, 1e-14);
}

// A helix between tangents: the unrolled line is straight.
TEST(Wrapping, HasTheLengthOfAHelixOnACylinder) {
  const double r = 0.1, a = 0.3, b = 0.22, phi = 2.6, rise = 0.37;
  const Vec3 p(a, 0.0, -0.05), q(b * std::cos(phi), b * std::sin(phi), rise - 0.05);
  const auto w = wrap(cylinder(r), p, q, false);
  ASSERT_TRUE(w && w->touches);
  EXPECT_NEAR(w->length, std::hypot(around_circle(r, a, b, phi), rise), 1e-15);
  // The other way, where a direction between the points is behind. @tests{wrap-side}
  Roller other = cylinder(r);
  other.side = Vec3(-std::cos(1.3), -std::sin(1.3), 5.0);
  const auto v = wrap(other, p, q, false);
  ASSERT_TRUE(v && v->touches);
  EXPECT_NEAR(v->length, std::hypot(around_circle(r, a, b, 2.0 * kPi - phi), rise), 1e-15);
  EXPECT_NEAR(v->angle, phi - 2.0 * kPi, 1e-15);
}

TEST(Wrapping, IsStraightWhereTheRollerIsNotInTheWay) {
  for (const Roller& roller : {cylinder(0.1), sphere(0.1), Roller{{0.1, 0.08, 0.12}}}) {
    const Vec3 p(0.2, 0.12, 0.0), q(-0.3, 0.13, 0.1);
    const auto w = wrap(roller, p, q, true);
    ASSERT_TRUE(w);
    EXPECT_FALSE(w->touches);
    EXPECT_EQ(w->length, (q - p).norm());
  }
  // The point is outside of the end of the line, not beside it.
  EXPECT_FALSE(wrap(sphere(0.1), {0.2, 0.0, 0.0}, {0.5, 0.01, 0.0}, false)->touches);
}

// Numbers of another program: DOP853 of SciPy 1.x for the geodesic, MINPACK for its tangency.
// @tests{wrap-geodesic} @tests{wrap-tangency}
TEST(Wrapping, HasTheLengthOfAnIndependentIntegrationOnEllipsoids) {
  struct Case {
    Vec3 semi_axes, p, q;
    double length, arc;
  };
  for (const Case& c : {Case{{0.3, 0.2, 0.15},
                             {-0.5, 0.1, 0.05},
                             {0.4, -0.25, 0.2},
                             0.9779746531866756,
                             0.03507974849952205},
                        Case{{0.3, 0.2, 0.15},
                             {-0.35, 0.1, 0.05},
                             {0.33, 0.05, -0.1},
                             0.7360231091834394,
                             0.3036469292423422},
                        Case{{0.1, 0.3, 0.2},
                             {-0.15, 0.1, 0.05},
                             {0.12, 0.15, -0.1},
                             0.41713641906012355,
                             0.1140405693819294}}) {
    const auto w = wrap({c.semi_axes}, c.p, c.q, false);
    ASSERT_TRUE(w && w->touches);
    EXPECT_NEAR(w->length, c.length, 2e-14);
    EXPECT_NEAR(w->arc, c.arc, 1e-11);
  }
}

// An ellipsoid whose axes differ in the last digits is a sphere, found by the iteration.
TEST(Wrapping, HasTheLimitOfASphere) {
  const Vec3 p(0.3, -0.4, 0.2), q(-0.35, 0.3, -0.3);
  const auto round = wrap(sphere(0.25), p, q, true);
  const auto nearly = wrap({Vec3(0.25, 0.25 + 1e-12, 0.25 - 1e-12)}, p, q, true);
  ASSERT_TRUE(round && nearly);
  EXPECT_NEAR(round->length, nearly->length, 1e-11);
  EXPECT_LT((round->by_p - nearly->by_p).norm() + (round->by_q - nearly->by_q).norm(), 1e-10);
  EXPECT_LT((round->second - nearly->second).norm(), 1e-9);
}

// The equator is a geodesic that closes; Jacobi fields on a sphere are cos and sin.
TEST(Wrapping, FollowsGeodesics) {
  const double r = 0.7;
  const GeodesicEnd round =
      follow_geodesic({{r, r, 0.2}}, {r, 0.0, 0.0}, {0.0, 1.0, 0.0}, 2.0 * kPi * r);
  EXPECT_LT((round.x - Vec3(r, 0.0, 0.0)).norm(), 1e-14);
  EXPECT_LT((round.t - Vec3(0.0, 1.0, 0.0)).norm(), 1e-14);
  const GeodesicEnd on_sphere =
      follow_geodesic(sphere(r), {r, 0.0, 0.0}, Vec3(0.0, 0.6, 0.8), 1.3 * r);
  EXPECT_NEAR(on_sphere.across, std::cos(1.3), 1e-15);
  EXPECT_NEAR(on_sphere.turned, r * std::sin(1.3), 1e-15);
  // An ellipsoid: it stays on the surface, and Clairaut's constant of a surface of revolution.
  const Vec3 semi(0.3, 0.3, 0.12), start(0.3, 0.0, 0.0), along(0.0, 0.6, 0.8);
  for (const double length : {0.3, 1.0, 4.0}) {
    const GeodesicEnd e = follow_geodesic({semi}, start, along, length);
    EXPECT_NEAR(e.x.cwiseQuotient(semi).norm(), 1.0, 1e-13);
    EXPECT_NEAR(e.t.norm(), 1.0, 1e-13);
    EXPECT_NEAR(e.x.x() * e.t.y() - e.x.y() * e.t.x(), 0.3 * 0.6, 1e-13);
  }
}

// First derivatives are unit vectors, those of the length; second ones those of the first.
TEST(Wrapping, HasItsDerivatives) {
  std::mt19937 generator(3);
  std::uniform_real_distribution<double> number(-2.0, 2.0);
  int found = 0;
  for (const Roller& roller : {sphere(1.0), cylinder(1.0), Roller{{1.0, 1.3, 0.8}}})
    for (int k = 0; k < 200; ++k) {
      Vec6 x;
      for (double& one : x) one = number(generator);
      const auto w = wrap(roller, x.head<3>(), x.tail<3>(), true);
      if (!w || !w->touches || w->arc < 0.05 || w->angle > 2.9) continue;
      if (roller.depth(x.head<3>()) < 1.1 || roller.depth(x.tail<3>()) < 1.1) continue;
      ++found;
      EXPECT_NEAR(w->by_p.norm(), 1.0, 1e-14);
      EXPECT_NEAR(w->by_q.norm(), 1.0, 1e-14);
      EXPECT_LT((w->second - w->second.transpose()).norm(), 1e-12);
      Mat both(7, 6);
      both << w->by_p.transpose(), w->by_q.transpose(), w->second;
      expect_derivative(
          both,
          [&](const Vec& d) -> Vec {
            const auto there =
                wrap(roller, x.head<3>() + d.head<3>(), x.tail<3>() + d.tail<3>(), false);
            Vec all(7);
            all << there->length, there->by_p, there->by_q;
            return all;
          },
          "wrapping", 1e-7);
    }
  EXPECT_GT(found, 50);
}

// The length and its first derivative are continuous where the line lifts off.
TEST(Wrapping, LiftsOffWithoutAJump) {
  for (const Roller& roller : {cylinder(0.1), sphere(0.1), Roller{{0.13, 0.1, 0.12}}}) {
    const auto at = [&](double height) {
      return *wrap(roller, {-0.3, height, 0.0}, {0.4, height, 0.0}, false);
    };
    const Wrapping below = at(0.1 - 1e-7), above = at(0.1 + 1e-7);
    EXPECT_TRUE(below.touches);
    EXPECT_FALSE(above.touches);
    EXPECT_NEAR(below.length, above.length, 1e-12);
    EXPECT_LT((below.by_p - above.by_p).norm(), 2e-6);
  }
}

TEST(Wrapping, HasNoLineFromInside) {
  EXPECT_FALSE(wrap(sphere(0.1), {0.05, 0.0, 0.0}, {0.5, 0.0, 0.0}, false));
  EXPECT_FALSE(wrap(cylinder(0.1), {0.5, 0.0, 0.0}, {0.05, 0.05, 3.0}, false));
}

}  // namespace polhode::test::wrapping_tests
