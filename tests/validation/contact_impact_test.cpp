// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "contact/starts.hpp"
#include "validation/model_scene.hpp"

namespace polhode::contact_impact_tests {
namespace {

using namespace test;

/// F = 721.3 N and t = 5.10 ms for 1 kg at 1 m/s against a Hertz spring of 1e7 N/m^{3/2}:
/// δ = (5 m v²/(4 K))^{2/5}, F = K δ^{3/2}, t = 2.9432 δ/v.
TEST(ContactImpact, HertzImpactHasItsForceAndDuration) {
  const double K = 1e7, deepest = std::pow(5.0 / (4.0 * K), 0.4);
  const double force = K * std::pow(deepest, 1.5), time = 2.9432 * deepest;
  ModelScene s(Vec3::Zero());
  const int ball = s.add_ball("ball", 0.1, 1.0, at({0.0, 0.0, 0.1 + 1e-9}, {0.0, 0.0, -1.0}));
  s.add_floor();
  s.law().potential = "hertz";
  s.law().stiffness = K;
  s.law().restitution = 1.0;
  s.begin(time / 20.0);
  double largest = 0.0;
  int touching = 0;
  for (int k = 0; k < 40; ++k) {
    s.step();
    const auto reports = s.simulation().contact_set()->reports();
    const double f = reports.empty() ? 0.0 : reports[0].normal_force;
    largest = std::max(largest, f);
    touching += f > 0.0 ? 1 : 0;
  }
  EXPECT_NEAR(largest, force, 0.01 * force);
  EXPECT_NEAR(touching * time / 20.0, time, time / 20.0);
  EXPECT_NEAR(s.motion(ball).v.z(), 1.0, 1e-10);
}

/// Five balls with gaps: impacts in sequence, the last ball leaves with the whole speed.
TEST(ContactImpact, CradleWithGaps) {
  const double R = 0.05, gap = 2e-3;
  ModelScene s(Vec3::Zero());
  for (int i = 0; i < 5; ++i)
    s.add_ball("ball " + std::to_string(i), R, 1.0,
               at({i * (2.0 * R + gap) - (i == 0 ? 0.01 : 0.0), 0.0, 0.0},
                  {i == 0 ? 1.0 : 0.0, 0.0, 0.0}));
  s.law(0.0, 1.0);
  s.begin(1e-3);
  s.run(0.1);
  for (int i = 0; i < 4; ++i) EXPECT_LT(s.motion(i).v.norm(), 1e-6) << i;
  EXPECT_NEAR(s.motion(4).v.x(), 1.0, 1e-6);
}

/// Touching balls with Hertz springs: 0.9888 for the last, −0.0711 for the first, by integration
/// of the chain.
TEST(ContactImpact, CradleThatTouchesIsAHertzChain) {
  const double R = 0.05;
  ModelScene s(Vec3::Zero());
  for (int i = 0; i < 5; ++i)
    s.add_ball("ball " + std::to_string(i), R, 1.0,
               at({i * 2.0 * R - (i == 0 ? 1e-5 : 0.0), 0.0, 0.0}, {i == 0 ? 1.0 : 0.0, 0.0, 0.0}));
  s.law().potential = "hertz";
  s.law().stiffness = 1e9;
  s.law().restitution = 1.0;
  s.begin(1e-5);
  s.run(0.01);
  const double expected[5] = {-0.0711, -0.0303, -0.0145, 0.1271, 0.9888};
  for (int i = 0; i < 5; ++i) EXPECT_NEAR(s.motion(i).v.x(), expected[i], 1e-3) << i;
}

/// The damper of Gonthier, Carvalho and Martins gives the restitution e where the impact is
/// resolved by the steps; published figures (two balls at 10 m/s, 1e6 N/m) 0.101, 0.304, 0.500,
/// 0.700, 0.900.
/// @tests{contact-damped}
TEST(ContactImpact, DampedImpactHasThePublishedRestitution) {
  const double published[5] = {0.10099, 0.30423, 0.50018, 0.69997, 0.90001};
  for (int i = 0; i < 5; ++i) {
    ModelScene s(Vec3::Zero());
    const int ball = s.add_ball("ball", 0.1, 1.6, at({-0.201, 0.0, 0.0}, {10.0, 0.0, 0.0}));
    s.add_fixed("target", ModelScene::shape("sphere", {0.2}));
    s.law().potential = "linear";
    s.law().stiffness = 1e6;
    s.law().restitution = 0.1 + 0.2 * i;
    s.law().rebound = "damped";
    s.begin(1e-5);
    s.run(0.02);
    EXPECT_NEAR(-s.motion(ball).v.x() / 10.0, published[i], 5e-3) << i;
  }
}

}  // namespace
}  // namespace polhode::contact_impact_tests
