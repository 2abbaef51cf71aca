// SPDX-License-Identifier: Apache-2.0
// Distances to the round faces of a tube, in closed form.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <polhode/contact/gap.hpp>

#include "contact/shapes_for_tests.hpp"

namespace polhode::tube_tests {
namespace {

using namespace contact;
using namespace test;

constexpr double kOuter = 0.6, kInner = 0.5, kHalf = 0.4;

/// Distance of a point from the tube about z, whose section is a rectangle.
double distance_from(const Vec3& x) {
  const double q = std::hypot(x.x(), x.y());
  const double across = std::max(q - kOuter, kInner - q), along = std::abs(x.z()) - kHalf;
  if (across > 0.0 && along > 0.0) return std::hypot(across, along);
  return std::max(across, along);
}

TEST(Tube, HasRoundSidesForBalls) {
  const geometry::ShapePlace place{{0.3, -0.2, 0.1}, Random(5).frame()};
  const geometry::Shape tube = round_tube(2.0 * kOuter, 2.0 * kInner, 2.0 * kHalf, place);
  const geometry::Shape ball = geometry::sphere("ball", 0.02);
  const Mat3 upright = Mat3::Identity();
  const Placement<double> at_tube(Vec3::Zero(), upright, 6);
  Random random(7);
  for (int k = 0; k < 2000; ++k) {
    const Vec3 x = random.vector(0.8);
    const Vec3 y = place.origin + place.axes * x;
    const Gap<double> g = gap({GapKind::point_solid, 0, 0, Fade::none}, ball, tube,
                              Placement<double>(y, upright, 0), at_tube);
    // Before its edges, which are rounded off, the sharp ones lie nearer by √2 - 1 of the rounding.
    EXPECT_NEAR(g.distance, distance_from(x) - 0.01, (std::sqrt(2.0) - 1.0) * tube.rounding + 1e-14)
        << x.transpose();
    if (std::abs(x.z()) < kHalf - 1e-3) {
      EXPECT_NEAR(g.distance, distance_from(x) - 0.01, 1e-14) << x.transpose();
    }
  }
}

/// Disc at the end of a rod within the tube: it touches the inner side at its point farthest from
/// the axis.
TEST(Tube, HasARoundBoreForTheEndsOfRods) {
  const geometry::Shape tube = round_tube(2.0 * kOuter, 2.0 * kInner, 2.0 * kHalf);
  const geometry::Shape rod = cylinder("rod", 0.2, 0.3);
  const Mat3 upright = Mat3::Identity();
  Random random(9);
  for (int k = 0; k < 200; ++k) {
    const Vec3 r(random.vector(0.2).x(), random.vector(0.2).y(), random.vector(0.1).z());
    BodyMotion m;
    m.q = Quat(Eigen::AngleAxisd(random.vector(0.5).x(), random.direction()));
    const Mat3 L = m.Lambda();
    for (const int which : {0, 1}) {
      const Gap<double> g =
          gap({GapKind::part_solid, which, 0, Fade::none}, rod, tube, Placement<double>(r, L, 0),
              Placement<double>(Vec3::Zero(), upright, 6));
      const geometry::Shape part = part_of(rod, which);
      double farthest = 0.0;
      for (int i = 0; i < 400; ++i)
        for (int j = 0; j <= 40; ++j) {
          const double u = 2.0 * std::numbers::pi * i / 400, v = std::numbers::pi * j / 40;
          const Vec3 on(std::cos(u) * std::sin(v), std::sin(u) * std::sin(v), std::cos(v));
          const Vec3 x = r + L * (part.centre + part.axes * part.half.cwiseProduct(on));
          farthest = std::max(farthest, std::hypot(x.x(), x.y()));
        }
      EXPECT_NEAR(g.distance, kInner - farthest - rod.rounding, 1e-4 * 0.1);
      EXPECT_LE(g.distance, kInner - farthest - rod.rounding + 1e-12);
    }
  }
}

}  // namespace
}  // namespace polhode::tube_tests
