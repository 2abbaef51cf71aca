// SPDX-License-Identifier: Apache-2.0
// Gaps of straight round sides that cross or are parallel, and of tubes and bodies inside them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include <polhode/contact/gap_parts.hpp>

#include "contact/shapes_for_tests.hpp"

namespace polhode::round_gap_tests {
namespace {

using namespace contact;
using namespace test;

/// A shape with a straight side about z.
struct Sided {
  std::string name;
  double radius, half;
  geometry::Shape shape;
  [[nodiscard]] bool is_capsule() const { return name == "capsule"; }
};

/// Stout ones and slender ones, of a length of 200 diameters.
std::vector<Sided> sided_shapes() {
  return {{"cylinder", 0.35, 0.45, cylinder("cylinder", 0.7, 0.9)},
          {"rod", 0.01, 2.0, cylinder("rod", 0.02, 4.0)},
          {"tube", 0.3, 0.4, round_tube(0.6, 0.5, 0.8)},
          {"pipe", 0.01, 2.0, round_tube(0.02, 0.016, 4.0)},
          {"capsule", 0.05, 0.8, geometry::capsule("capsule", 0.1, 1.6)}};
}

/// Rotation of z to a unit vector.
Mat3 along(const Vec3& axis) {
  Mat3 L;
  L.col(2) = axis;
  L.col(0) = axis.unitOrthogonal();
  L.col(1) = axis.cross(L.col(0));
  return L;
}

// @tests{contact-round-support}
TEST(RoundGap, OfCrossingSidesIsThatOfTheirAxes) {
  Random random(41);
  int compared = 0;
  for (const Sided& a : sided_shapes())
    for (const Sided& b : sided_shapes()) {
      if (a.is_capsule()) continue;
      for (int trial = 0; trial < 60; ++trial) {
        const Vec3 on_a = random.direction(), on_b = random.direction();
        if (on_a.cross(on_b).norm() < 0.1) continue;
        const Vec3 n = on_a.cross(on_b).normalized() * (trial % 2 == 0 ? 1.0 : -1.0);
        const double distance = std::pow(10.0, -1.0 - trial % 5) * a.radius;
        // Places of nearest approach along the axes.
        const double s = 0.9 * a.half * random.vector(1.0).x(),
                     t = 0.9 * b.half * random.vector(1.0).y();
        const Vec3 r_a = t * on_b - s * on_a + (a.radius + b.radius + distance) * n;
        const Mat3 L_a = along(on_a), L_b = along(on_b);
        const Placement<double> at_a(r_a, L_a, 0), at_b(Vec3::Zero(), L_b, 6);
        const GapKind kind = b.is_capsule() ? GapKind::round_edge : GapKind::round_round;
        const Gap<double> g = gap({kind, 0, 0, Fade::parallel}, a.shape, b.shape, at_a, at_b);
        EXPECT_NEAR(g.distance, distance, 2e-6 * (a.half + b.half)) << a.name << " " << b.name;
        EXPECT_LT((value(g.normal) - n).norm(), 1e-4) << a.name << " " << b.name;
        EXPECT_LT((value(g.point) - t * on_b - (b.radius + 0.5 * distance) * n).norm(),
                  1e-4 * (a.half + b.half))
            << a.name << " " << b.name;
        ++compared;
      }
    }
  EXPECT_GT(compared, 900);
}

/// Parallel sides touch with the discs at their ends: where they overlap in part, and where their
/// ends are flush or nearly so.
TEST(RoundGap, OfParallelSidesIsThatOfTheirAxes) {
  Random random(42);
  for (const Sided& a : sided_shapes())
    for (const Sided& b : sided_shapes()) {
      if (a.is_capsule()) continue;
      for (int trial = 0; trial < 16; ++trial) {
        const Vec3 axis = random.direction(), n = axis.unitOrthogonal();
        const double distance = 1e-3 * a.radius;
        // Distance of the upper end of a below that of b.
        const double below = trial == 0  ? 0.0
                             : trial < 6 ? std::pow(10.0, 1 - trial) * a.radius
                                         : 0.9 * b.half * (1.0 + random.vector(1.0).x());
        const Mat3 L = along(axis);
        // The straight side of the core ends below the end of the shape.
        const double end = b.is_capsule()     ? b.half - b.radius
                           : is_tube(b.shape) ? hull_of_tube(b.shape).half[2]
                                              : b.shape.half[2];
        const double shift = end - below - a.half;
        const Placement<double> at_b(Vec3::Zero(), L, 6),
            at_a(shift * axis + (a.radius + b.radius + distance) * n, L, 0);
        const Gap<double> g =
            gap({GapKind::end_round, 1, 0, Fade::none}, a.shape, b.shape, at_a, at_b);
        EXPECT_NEAR(g.distance, distance, 5e-5 * (a.radius + b.radius) + 2e-6 * (a.half + b.half))
            << a.name << " " << b.name << " " << below;
        EXPECT_LT((value(g.normal) - n).norm(), 2e-2) << a.name << " " << b.name;
      }
    }
}

/// Rods that cross in their middle: at any angle something touches whose gap is near that of the
/// axes.
TEST(RoundGap, OfNearlyParallelSidesIsThatOfTheirAxes) {
  for (const double length : {0.04, 0.4, 4.0})
    for (double angle = 1e-6; angle < 0.3; angle *= 1.5) {
      const geometry::Shape rod = cylinder("rod", 0.02, length);
      const double distance = -1e-6;
      const Mat3 L_a = along({std::sin(angle), 0.0, std::cos(angle)}), L_b = Mat3::Identity();
      const Placement<double> at_a(Vec3(0.0, 0.02 + distance, 0.0), L_a, 0),
          at_b(Vec3::Zero(), L_b, 6);
      std::vector<OrderedPair> found;
      near_feature_pairs(rod, rod, at_a, at_b, 1e-3, found);
      double least = std::numeric_limits<double>::infinity();
      for (const OrderedPair& p : found) {
        const double x = std::sin(angle) * std::sin(angle) / p.pair.fade_square;
        if (p.pair.fade == Fade::parallel && x * (2.0 - x) < 0.5 && x < 1.0) continue;
        least = std::min(least, (p.swapped ? gap(p.pair, rod, rod, at_b, at_a)
                                           : gap(p.pair, rod, rod, at_a, at_b))
                                    .distance);
      }
      EXPECT_NEAR(least, distance, 2e-6 + 1e-3 * 0.02) << length << " " << angle;
    }
}

/// Gap of a tube's outer side to rods and an ellipsoid in the tube, in its mouth, and outside it.
TEST(RoundGap, KeepsTheMouthOfATubeOpen) {
  Random random(43);
  const geometry::Shape tube = round_tube(0.6, 0.5, 0.8);
  const double R = tube.half[0], H = hull_of_tube(tube).half[2], wall = 0.05;
  const Mat3 still = Mat3::Identity();
  const Placement<double> at_tube(Vec3::Zero(), still, 6);
  int within = 0, outside = 0;
  for (const geometry::Shape& b :
       {cylinder("rod", 0.1, 1.2), ellipsoid("egg", {0.3, 0.2, 0.4}), cylinder("coin", 0.4, 0.02)})
    for (int trial = 0; trial < 600; ++trial) {
      const Mat3 L = random.frame();
      const Vec3 r = Vec3(0.5 * random.vector(1.0).x(), 0.5 * random.vector(1.0).y(),
                          0.7 * random.vector(1.0).z());
      const Placement<double> at_b(r, L, 0);
      double least = std::numeric_limits<double>::infinity(), inner = least;
      for (int k = 0; k < 240; ++k)
        for (int h = -40; h <= 40; ++h) {
          const double u = std::numbers::pi * k / 120.0;
          const Vec3 across(std::cos(u), std::sin(u), 0.0), up = H / 40.0 * h * Vec3::UnitZ();
          const auto to = [&](const Vec3& x) {
            return point_over_solid(v3(x), tube.rounding, b, at_b).distance;
          };
          least = std::min(least, to(R * across + up));
          inner = std::min(inner, to((R - wall) * across + up));
        }
      // The tube's wall is not penetrated.
      if (least < 0.0 || inner < 0.0) continue;
      const Gap<double> g = gap({GapKind::round_round, 0, 0, Fade::none}, b, tube, at_b, at_tube);
      EXPECT_GT(g.distance, -1e-3) << r.transpose();  // the samples are 8 mm apart
      if (g.feature == kInMouth) {
        ++within;
        EXPECT_NEAR(g.distance, least, 0.05 * R) << r.transpose();
      } else {
        ++outside;
        EXPECT_NEAR(g.distance, least, 0.02 * R) << r.transpose();
      }
    }
  EXPECT_GT(within, 100);
  EXPECT_GT(outside, 200);
}

}  // namespace
}  // namespace polhode::round_gap_tests
