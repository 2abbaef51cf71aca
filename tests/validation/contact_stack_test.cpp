// SPDX-License-Identifier: Apache-2.0
#include <numbers>

#include <gtest/gtest.h>

#include "contact/scene.hpp"

namespace polhode::contact_stack_tests {
namespace {

using namespace test;

/// Ten boxes, each a little smaller than the one below, for a minute.
TEST(ContactStack, OfTenBoxesStandsForAMinute) {
  Scene s;
  double z = 0.0;
  for (int k = 0; k < 10; ++k) {
    const double side = 0.2 * std::pow(0.98, k);
    s.add_box("box " + std::to_string(k), {side, side, 0.1}, 1.0, at({0.0, 0.0, z + 0.05}));
    z += 0.1;
  }
  s.add_floor();
  s.law(0.5, 0.0);
  s.begin(2e-2);
  ASSERT_TRUE(s.run(1.0)) << s.last.text();
  std::vector<Vec3> start;
  for (int k = 0; k < 10; ++k) start.push_back(s.motion(k).r);
  ASSERT_TRUE(s.run(59.0)) << s.last.text();
  for (int k = 0; k < 10; ++k) {
    EXPECT_LT((s.motion(k).r - start[k]).norm(), 1e-5) << k;
    EXPECT_LT(s.motion(k).v.norm(), 1e-6) << k;
  }
  EXPECT_LT(s.drift(), 1e-10 * s.state.ledger.energy_scale);
}

/// Two plates that lean against each other, each at an angle φ to the vertical: they stand if the
/// friction of the floor carries the thrust, μ ≥ ½ tan φ − t/(2 h) (moments about the foot), and
/// slide apart otherwise.
TEST(ContactStack, CardHouseOfTwoPlatesStandsByItsFriction) {
  const double phi = 20.0 / 180.0 * std::numbers::pi, height = 1.0, thick = 0.02;
  for (const double factor : {1.1, 0.9}) {
    Scene s;
    const double mu = (0.5 * std::tan(phi) - 0.5 * thick / height) * factor;
    for (const double sign : {-1.0, 1.0}) {
      BodyMotion start;
      start.q = Quat(Eigen::AngleAxisd(sign * phi, Vec3::UnitY()));
      // The inner upper edges touch at x = 0, the inner lower ones stand on the floor.
      const Vec3 top = start.q * Vec3(sign * 0.5 * thick, 0.0, 0.5 * height);
      const Vec3 foot = start.q * Vec3(sign * 0.5 * thick, 0.0, -0.5 * height);
      start.r = {-top.x(), 0.0, -foot.z()};
      s.add_box(sign < 0.0 ? "right" : "left", {thick, 0.6, height}, 1.0, start);
    }
    s.add_floor();
    s.law(mu, 0.0);
    s.begin(5e-3);
    ASSERT_TRUE(s.run(factor > 1.0 ? 1.0 : 3.0)) << s.last.text();
    if (factor > 1.0) {
      const Vec3 settled = s.motion(0).r;
      ASSERT_TRUE(s.run(59.0)) << s.last.text();
      EXPECT_GT(settled.z(), 0.4) << "fell";
      EXPECT_LT((s.motion(0).r - settled).norm(), 1e-5) << "creeps";
    } else {
      EXPECT_LT(s.motion(0).r.z(), 0.3) << "stands";
    }
  }
}

}  // namespace
}  // namespace polhode::contact_stack_tests
