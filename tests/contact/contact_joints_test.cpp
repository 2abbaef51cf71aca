// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "contact/scene.hpp"

namespace polhode::contact_joints_tests {
namespace {

using namespace test;

/// Chain of boxes along x, joined at the middle of their ends.
std::vector<int> add_chain(Scene& s, int links, const Vec3& first, const std::string& type) {
  std::vector<int> bodies;
  for (int i = 0; i < links; ++i) {
    bodies.push_back(s.add_box("link " + std::to_string(i), {0.3, 0.1, 0.08}, 1.0,
                               at(first + Vec3(0.34 * i, 0.0, 0.0))));
    if (i > 0) s.add_joint(type, bodies[i - 1], bodies[i], first + Vec3(0.34 * i - 0.17, 0.0, 0.0));
  }
  return bodies;
}

// @tests{contact-quotient}
TEST(ContactJoints, PendulumBouncesOffAWallForEver) {
  Scene s;
  const int rod = s.add_box("rod", {1.0, 0.1, 0.1}, 1.0, at({0.8, 0.0, 0.0}));
  s.add_joint("revolute", kGround, rod, {0.3, 0.0, 0.0});  // about z: gravity acts across
  s.system.set_gravity({0.0, -9.81, 0.0});
  s.add_floor(Vec3::UnitX());
  s.law(0.0, 1.0);
  s.begin(1e-2);
  int bounces = 0;
  double before = 0.0;
  for (int k = 0; k < 3000; ++k) {
    ASSERT_TRUE(s.step()) << s.last.text();
    const double spin = s.motion(rod).omega().z();
    if (before < -1.0 && spin > 1.0) ++bounces;
    before = spin;
  }
  EXPECT_GT(bounces, 10);
  EXPECT_LT(s.drift(), 1e-10 * s.state.ledger.energy_scale);
  EXPECT_LT(s.state.ledger.constraint_max, 1e-10);
}

/// Four links in free flight meet a ball: without friction and losses, energy and momenta are
/// conserved.
TEST(ContactJoints, ChainInFreeFlightKeepsEnergyAndMomenta) {
  Scene s(Vec3::Zero());
  const auto links = add_chain(s, 4, Vec3::Zero(), "spherical");
  s.add_ball("ball", 0.15, 2.0, at({0.45, 0.05, 1.0}, {0.0, 0.0, -3.0}));
  s.add_ball("other", 0.15, 2.0, at({0.75, -0.05, -1.5}, {0.0, 0.0, 3.0}));
  s.law(0.0, 1.0);
  s.begin(5e-3);
  ASSERT_TRUE(s.run(5.0)) << s.last.text();
  const Ledger& l = s.state.ledger;
  EXPECT_GT(s.motion(links[1]).v.norm(), 0.1) << "there was no impact";
  EXPECT_LT(s.drift(), 1e-10 * l.energy_scale);
  EXPECT_LT(l.p_drift, 1e-10 * l.p_scale);
  EXPECT_LT(l.l_drift, 1e-10 * l.l_scale);
  EXPECT_LT(l.constraint_max, 1e-10);
}

// @tests{turn-law}
TEST(ContactJoints, FallingChainComesToRestAndImpactsDoNotTearItsJoints) {
  for (const double e : {0.0, 0.6}) {
    Scene s;
    add_chain(s, 4, {0.0, 0.0, 0.5}, "spherical");
    s.add_floor(Vec3(0.1, 0.05, 1.0).normalized());
    s.law(1.0, e);
    s.begin(5e-3);
    double energy = s.energy(), rise = 0.0;
    for (int k = 0; k < 800; ++k) {
      ASSERT_TRUE(s.step()) << s.last.text();
      const double now = s.energy();
      rise = std::max(rise, now - energy);
      energy = now;
    }
    EXPECT_LT(rise, 1e-12 * s.state.ledger.energy_scale);
    EXPECT_LT(s.drift(), 1e-10 * s.state.ledger.energy_scale);
    EXPECT_LT(s.state.ledger.constraint_max, 1e-10);
    EXPECT_LT(s.motion(0).v.norm(), 1e-3) << e;
    EXPECT_LT(s.parting(), 1e-3) << e;
  }
}

}  // namespace
}  // namespace polhode::contact_joints_tests
