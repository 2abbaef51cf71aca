// SPDX-License-Identifier: Apache-2.0
// Inner rims of tubes against bars, edges and round solids, and the ends of thick tubes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <polhode/contact/gap_parts.hpp>
#include <polhode/contact/mouth_rim.hpp>

#include "contact/shapes_for_tests.hpp"

namespace polhode::mouth_rim_tests {
namespace {

using namespace contact;
using namespace test;

constexpr double kTurn = 2.0 * std::numbers::pi;

/// Outer diameter 0.6 m, inner 0.4 m, length 0.8 m.
geometry::Shape tube_of_tests() { return round_tube(0.6, 0.4, 0.8); }

/// A place on an inner rim of the tube about z.
Vec3 on_rim(const geometry::Shape& tube, bool upper, double angle) {
  const double r = tube.half[1], h = upper ? tube.half[2] : -tube.half[2];
  return {r * std::cos(angle), r * std::sin(angle), h};
}

/// Least of a function on a circle, from samples and golden sections about the lowest ones.
template <class Function>
double least_on_circle(const Function& f) {
  const int n = 720;
  const double step = kTurn / n;
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < n; ++k) {
    double low = (k - 1) * step, high = (k + 1) * step;
    if (!(f(k * step) <= f(low)) || !(f(k * step) <= f(high))) continue;
    for (int i = 0; i < 60; ++i) {
      const double a = low + 0.382 * (high - low), b = low + 0.618 * (high - low);
      (f(a) < f(b) ? high : low) = f(a) < f(b) ? b : a;
    }
    least = std::min(least, f(0.5 * (low + high)));
  }
  return least;
}

/// Weight of a bar's contacts with halves of a rim; the rest belongs to the whole rim, or for a
/// cylinder to its short arcs.
double weight_of_halves(const Vec3& axis) {
  const double x = std::clamp((axis.head<2>().squaredNorm() - 2e-3) / 8e-3, 0.0, 1.0);
  return x * x * (3.0 - 2.0 * x);
}

/// Bars across a mouth, leaning in it, and along it: the pairs that count have the exact distance.
TEST(MouthRim, IsAsNearToBarsAsAllItsPoints) {
  Random random(71);
  const geometry::Shape tube = tube_of_tests();
  const Mat3 still = Mat3::Identity();
  const Placement<double> at_tube(Vec3::Zero(), still, 0);
  int steep = 0, flat = 0;
  for (const geometry::Shape& bar :
       {geometry::capsule("pen", 0.01, 1.0), cylinder("rod", 0.01, 1.0)})
    for (int trial = 0; trial < 600; ++trial) {
      const bool upper = trial % 2 == 0;
      Vec3 axis = random.direction();
      if (trial % 4 < 2) axis.z() *= 0.05;
      if (trial % 4 == 2) axis.head<2>() *= trial % 8 == 2 ? 0.05 : 0.0;
      axis.normalize();
      const Vec3 through = on_rim(tube, upper, kTurn * random.vector(1.0).x()) +
                           (trial % 3 == 0 ? 1e-3 : 0.03) * random.vector(1.0);
      Mat3 L;
      L.col(2) = axis, L.col(0) = axis.unitOrthogonal(), L.col(1) = axis.cross(L.col(0));
      const Placement<double> at_bar(through, L, 6);
      const double expected = least_on_circle([&](double angle) {
        return point_over_solid(v3(on_rim(tube, upper, angle)), tube.rounding, bar, at_bar)
            .distance;
      });
      if (expected < -2e-3) continue;  // deeper than half the pen: a distance of curves
      const bool halves = weight_of_halves(axis) > 0.5, round = bar.round();
      double least = std::numeric_limits<double>::infinity();
      const auto take = [&](const Gap<double>& g) { least = std::min(least, g.distance); };
      if (halves || !round) {
        for (int number = 0; number < kRimArcs; ++number)
          if (is_upper_rim(number) == upper && is_whole_rim(number) != halves)
            take(gap({round ? GapKind::rim_bar : GapKind::rim_edge, number, 0, Fade::none}, tube,
                     bar, at_tube, at_bar));
      } else {
        for (int e = 0; e < static_cast<int>(tube.edges.size()); ++e)
          if (is_rim_arc(tube, e) && (tube.corners[tube.edges[e].i].z() > 0.0) == upper)
            take(gap({GapKind::round_edge, 0, e, Fade::none}, bar, tube, at_bar, at_tube));
      }
      // The middle of an arc is preferred by a few millionths of the radius.
      EXPECT_NEAR(least, expected, 6e-6 * tube.half[1]) << trial << " " << axis.transpose();
      ++(halves ? flat : steep);
    }
  EXPECT_GT(flat, 400);
  EXPECT_GT(steep, 100);
}

/// Arcs of a rim over solids that may touch all of it at once.
TEST(MouthRim, IsAsNearToEggsAndConesAsManyPoints) {
  Random random(72);
  const geometry::Shape tube = tube_of_tests();
  const Mat3 still = Mat3::Identity();
  const Placement<double> at_tube(Vec3::Zero(), still, 6);
  for (const geometry::Shape& solid : {ellipsoid("egg", {0.5, 0.6, 0.8}), cone("cone", 0.6, 0.7)})
    for (int trial = 0; trial < 30; ++trial) {
      const Mat3 L = random.frame();
      const Vec3 r = Vec3(0.0, 0.0, tube.half[2] + 0.35) + random.vector(0.15);
      const Placement<double> at_solid(r, L, 0);
      double least = std::numeric_limits<double>::infinity(), of_arcs = least;
      for (int k = 0; k < 20000; ++k)
        least = std::min(least, point_over_solid(v3(on_rim(tube, true, kTurn * k / 20000)),
                                                 tube.rounding, solid, at_solid)
                                    .distance);
      for (int e = 0; e < static_cast<int>(tube.edges.size()); ++e)
        if (is_rim_arc(tube, e))
          of_arcs = std::min(
              of_arcs, gap({GapKind::round_edge, 0, e, Fade::none}, solid, tube, at_solid, at_tube)
                           .distance);
      // The middle of an arc is preferred by this at its ends.
      const double preferred = 1e-3 * std::pow(std::numbers::pi / 48.0, 2) * tube.half[1];
      EXPECT_LE(of_arcs, least + preferred) << trial;
      if (least > 0.0) {
        EXPECT_NEAR(of_arcs, least, 1e-6) << trial;
      }
    }
}

/// A ball that does not fit into the tube: its gap has no kink on the axis, and is exact from there
/// on; its slope and normal are the derivative of the gap.
// @tests{contact-mouth-on-axis}
TEST(MouthRim, IsSmoothToABallOnTheAxis) {
  const geometry::Shape tube = tube_of_tests(), ball = geometry::sphere("ball", 0.6);
  const double r = tube.half[1], h = 0.2;
  const Mat3 still = Mat3::Identity();
  const Placement<double> at_tube(Vec3::Zero(), still, 6);
  const auto gap_at = [&](const Vec3& x) {
    return gap({GapKind::point_solid, 0, 0, Fade::none}, ball, tube, Placement<double>(x, still, 0),
               at_tube);
  };
  const double near = 0.05 * r * h / (h + r);  // largest smoothed distance from the axis
  for (const double side : {-1.0, 1.0})
    for (const double q :
         {0.0, 1e-9, 1e-6, 0.1 * near, 0.5 * near, 0.99 * near, 1.01 * near, 2.0 * near, 0.5 * r}) {
      const Vec3 x(0.6 * q, 0.8 * q, side * (tube.half[2] + h));
      const Gap<double> g = gap_at(x);
      const double exact = std::hypot(r - q, h) - 0.3 - tube.rounding;
      if (q == 0.0 || q >= near) {
        EXPECT_NEAR(g.distance, exact, 1e-14) << q;
      }
      EXPECT_GE(g.distance, exact - 1e-14) << q;
      EXPECT_LE(g.distance, exact + 0.15 * near) << q;
      for (int i = 0; i < 3; ++i) {
        const double d = 1e-6;
        const double by_differences =
            (gap_at(x + d * Vec3::Unit(i)).distance - gap_at(x - d * Vec3::Unit(i)).distance) /
            (2.0 * d);
        EXPECT_NEAR(by_differences, g.slope * value(g.normal)[i], 2e-6) << q << " " << i;
      }
    }
}

/// On the face of a thick end a body has the gap of its plane, over the mouth it is out of reach.
TEST(MouthRim, EndsWhereTheFaceOfTheEndBegins) {
  const geometry::Shape tube = round_tube(0.6, 0.2, 0.8),
                        egg = ellipsoid("egg", {0.05, 0.04, 0.03});
  const double roundings = tube.rounding + egg.rounding;
  const Mat3 still = Mat3::Identity();
  const Placement<double> at_tube(Vec3::Zero(), still, 6);
  for (const double side : {-1.0, 1.0})
    for (const double q : {0.0, 0.05, 0.09, 0.101, 0.15, 0.2, 0.299}) {
      const Vec3 x(q, 0.0, side * (0.4 + 0.015 + 1e-5));
      const double g = gap({GapKind::part_end, 0, 0, Fade::none}, egg, tube,
                           Placement<double>(x, still, 0), at_tube)
                           .distance;
      const double across = 0.1 + tube.rounding - q;
      const double expected =
          across < 0.0 ? 1e-5 : std::hypot(across, roundings + 1e-5) - roundings;
      EXPECT_NEAR(g, expected, 1e-9) << q;
    }
}

}  // namespace
}  // namespace polhode::mouth_rim_tests
