// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include <polhode/geometry/nearest.hpp>
#include <support/random_steps.hpp>

namespace polhode::contact::nearest_tests {
namespace {

using polhode::test::Random;

/// Checks that the root gives a point of the ellipsoid whose normal passes through y.
void expect_nearest(const Vec3& half, const Vec3& y) {
  const double t = geometry::nearest_on_ellipsoid(half, y);
  const Vec3 square = half.cwiseAbs2(), share = y.cwiseQuotient((square.array() + t).matrix());
  const Vec3 nearest = square.cwiseProduct(share);
  const double on = nearest.cwiseQuotient(half).squaredNorm();
  // Change by the last digits of the root.
  const double per_root =
      2.0 *
      nearest.cwiseQuotient(half).cwiseAbs2().cwiseQuotient((square.array() + t).matrix()).sum();
  const double least = square.minCoeff();
  EXPECT_NEAR(on, 1.0, 1e-14 + 4e-15 * per_root * (least + std::abs(t)))
      << half.transpose() << " from " << y.transpose();
  EXPECT_LT((nearest + t * share - y).norm(), 1e-12 * (y.norm() + half.maxCoeff()));
}

TEST(NearestOnEllipsoid, IsOnTheSurfaceAlongTheNormal) {
  Random random(1);
  for (int k = 0; k < 200000; ++k) {
    Vec3 half;
    for (int i = 0; i < 3; ++i) half[i] = std::pow(10.0, random.number(1.5));
    const Vec3 on = half.cwiseProduct(random.direction());
    const double far = k % 3 == 0 ? 1e-6 : k % 3 == 1 ? 1e-2 : 1.0;
    expect_nearest(half, on * (1.0 + far * (1.0 + random.number())));
  }
}

/// Discs as for the ends of cylinders, seen from beside their rims.
TEST(NearestOnEllipsoid, OfAThinDiscIsOnTheSurfaceAlongTheNormal) {
  Random random(2);
  for (int k = 0; k < 200000; ++k) {
    const Vec3 half(0.14, 0.14, 0.14 * 2e-3);
    const double angle = random.number(3.2), far = std::pow(10.0, -3.0 + random.number(2.0));
    expect_nearest(half, {0.14 * (1.0 + far) * std::cos(angle),
                          0.14 * (1.0 + far) * std::sin(angle), random.number(4e-4)});
  }
  // A case in which rounding once made the search end away from the root.
  const Vec3 x(0.060236423364245714, 0.11811966652213449, -0.026462139274297684),
      v(0.030904699064131139, -0.00024138331097249381, 0.055750083040403735);
  expect_nearest({0.13959279111980452, 0.13959279111980452, 0.00027918558223960906},
                 x + 0.47078410734669857 * v);
}

}  // namespace
}  // namespace polhode::contact::nearest_tests
