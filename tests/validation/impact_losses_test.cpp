// SPDX-License-Identifier: Apache-2.0
// Energy lost in one impact of a box's corner, by the normal impulse and by friction, against an
// integration of Routh's path of the impulse with Stronge's restitution.
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include <Eigen/LU>

#include <polhode/core/format.hpp>
#include <polhode/math/exp_map.hpp>
#include <polhode/math/hat.hpp>
#include <support/run_text.hpp>

namespace polhode::test::impact_losses_tests {
namespace {

const Vec3 kSize(0.2, 0.3, 0.16), kTurn(0.5, 0.35, 0.2), kVelocity(1.5, 0.3, -2.0),
    kSpin(1.0, 2.0, -1.0);

struct Losses {
  double normal = 0.0, friction = 0.0;
};

/// Lowest corner of the box, relative to its centre.
Vec3 corner() {
  const Mat3 R = exp_map(kTurn);
  Vec3 lowest = Vec3::Zero();
  for (int k = 0; k < 8; ++k) {
    const Vec3 sign(k & 1 ? 0.5 : -0.5, k & 2 ? 0.5 : -0.5, k & 4 ? 0.5 : -0.5);
    const Vec3 r = R * kSize.cwiseProduct(sign);
    if (k == 0 || r.z() < lowest.z()) lowest = r;
  }
  return lowest;
}

/// Work of both impulses, as the normal impulse grows until restitution has returned e² of the
/// work of compression; the corner slides all the time.
Losses routh(double e, double mu) {
  const Mat3 R = exp_map(kTurn);
  const Vec3 s = kSize.cwiseProduct(kSize);
  const Mat3 J =
      R * (Vec3(s.y() + s.z(), s.x() + s.z(), s.x() + s.y()) / 12.0).asDiagonal() * R.transpose();
  const Vec3 r = corner();
  const Mat3 K = Mat3::Identity() - hat(r) * J.inverse() * hat(r);
  Vec3 u = kVelocity + kSpin.cross(r);
  Losses lost;
  const double dp = 2e-6;
  double compression = 0.0, work = 0.0;
  for (bool compresses = true;;) {
    const Vec3 slip(u.x(), u.y(), 0.0);
    const Vec3 direction = Vec3::UnitZ() - mu / slip.norm() * slip, change = dp * (K * direction);
    const Vec3 mean = u + 0.5 * change;
    work += mean.z() * dp;
    lost.friction += mu / slip.norm() * slip.dot(mean) * dp;
    u += change;
    if (compresses && u.z() >= 0.0) {
      compresses = false;
      compression = work;
    }
    if (!compresses && work >= compression * (1.0 - e * e)) break;
  }
  lost.normal = -work;
  return lost;
}

std::string model(double e, double mu, double h) {
  const double height = 1e-3 - corner().z();
  return format(
      "format: 1\nbodies:\n  floor: {{fixed: true, shape: {{plane: z}}}}\n  box: {{mass: 1, shape: "
      "{{box: [0.2, 0.3, 0.16]}}, position: [0, 0, {:.17g}], velocity: [1.5, 0.3, -2], "
      "orientation: {{rotation_vector: [0.5, 0.35, 0.2]}}, angular_velocity: [1, 2, -1]}}\n"
      "contacts: {{default: {{law: rigid, restitution: {}, friction: {}}}}}\n"
      "analysis: {{duration: 2 ms, step: {}}}\noutput: {{hdf5: false}}\n",
      height, e, mu, h);
}

}  // namespace

// @tests{velocity-problem} @tests{routh}
TEST(ImpactLosses, AreThoseAlongTheCourseOfTheImpact) {
  for (const auto& [e, mu] : {std::pair(0.9, 0.1), std::pair(0.5, 0.1), std::pair(0.9, 0.05)}) {
    const Losses exact = routh(e, mu);
    for (const double h : {1e-3, 1e-4, 1e-5}) {
      Simulation s = made(model(e, mu, h));
      const RunSummary r = finished(s);
      ASSERT_TRUE(r.contacts.has_value());
      const double total = exact.normal + exact.friction;
      const std::string what = format("e {}, mu {}, step {}", e, mu, h);
      EXPECT_NEAR(r.contacts->lost_in_impacts, exact.normal, 0.03 * total + 10.0 * h) << what;
      EXPECT_NEAR(r.contacts->lost_by_friction, exact.friction, 0.03 * total + 10.0 * h) << what;
      EXPECT_GT(r.contacts->lost_in_impacts, 0.0) << what;
    }
  }
}

}  // namespace polhode::test::impact_losses_tests
