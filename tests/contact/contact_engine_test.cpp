// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <polhode/system/state_archive.hpp>

#include "contact/scene.hpp"
#include "contact/shapes_for_tests.hpp"

namespace polhode::contact_engine_tests {
namespace {

using namespace test;

/// Energy of a rounding error of the height, 1.4e-17 m, where a fall of a metre is stopped: the
/// barrier stores 10 J at s = 1e-4 of its band, with a force of 5e8 N [J].
constexpr double kRounding = 7e-9;

// @tests{contact-stiffness} @tests{contact-filter}
TEST(ElasticBall, ReturnsToItsHeightAHundredTimes) {
  Scene s;
  const int ball = s.add_ball("ball", 0.1, 1.0, at({0.0, 0.0, 1.1}));
  s.add_floor();
  s.law(0.0, 1.0);
  s.begin(1e-2);
  int bounces = 0;
  double apex = 0.0, before = 0.0;
  while (bounces < 100) {
    ASSERT_TRUE(s.step()) << s.last.text();
    const BodyMotion m = s.motion(ball);
    // Largest height of the flight, if the ball flies.
    if (m.r.z() > 0.15) apex = m.r.z() + m.v.z() * m.v.z() / (2.0 * 9.81);
    if (before < 0.0 && m.v.z() > 0.0) ++bounces;
    before = m.v.z();
    if (m.r.z() > 0.15) {
      ASSERT_NEAR(apex, 1.1, 1e-6) << bounces;
    }
    ASSERT_GT(m.r.z(), 0.1 - 1e-4) << "penetration above the tolerance";
  }
  EXPECT_LT(s.drift(), 100 * kRounding);
  EXPECT_LT(s.iterations, 4 * s.steps);
}

// @tests{turn-law}
TEST(BouncingBall, LosesSpeedByItsRestitution) {
  for (const double e : {0.5, 0.8, 0.9})
    for (const double dt : {1e-2, 2e-3}) {
      Scene s;
      const int ball = s.add_ball("ball", 0.1, 1.0, at({0.0, 0.0, 1.1}));
      s.add_floor();
      s.law(0.0, e);
      s.begin(dt);
      // Speeds at the surface from the energies of two flights, as long as a flight takes 4 steps.
      const double surface = 0.1;  // where the force ends
      double last = std::sqrt(2.0 * 9.81 * (1.1 - surface));
      bool down = true;
      int bounces = 0;
      for (int k = 0; k < 40000 && bounces < 10; ++k) {
        ASSERT_TRUE(s.step()) << s.last.text();
        const BodyMotion m = s.motion(ball);
        if (m.v.z() < 0.0) down = true;
        if (down && m.v.z() > 0.0 && m.r.z() > surface) {
          down = false;
          const double now = std::sqrt(m.v.z() * m.v.z() + 2.0 * 9.81 * (m.r.z() - surface));
          if (2.0 * e * last / 9.81 < 4.0 * dt) break;
          EXPECT_NEAR(now / last, e, 1e-3) << "e " << e << " dt " << dt << " bounce " << bounces;
          last = now;
          ++bounces;
        }
      }
      EXPECT_GE(bounces, 3);
      EXPECT_LT(s.drift(), 10 * kRounding);  // with the losses of impacts
    }
}

/// Height of the centre of a 1 kg block of half height 0.05 m that rests on four corners: a quarter
/// of the load on each lies at s = 0.69 of the band, (2 s − 1) of the tolerance.
constexpr double kRestingHeight = 0.05 + 0.38 * 1.5e-4;

TEST(Incline, HoldsABlockWithoutCreep) {
  const double mu = 0.5, slope = std::atan(0.9 * mu);
  Scene s(9.81 * Vec3(std::sin(slope), 0.0, -std::cos(slope)));
  const int block = s.add_box("block", {0.2, 0.2, 0.1}, 1.0, at({0.0, 0.0, kRestingHeight}));
  s.add_floor();
  s.law(mu, 0.0);
  s.begin(1e-2);
  for (int k = 0; k < 50; ++k) ASSERT_TRUE(s.step()) << s.last.text();
  const Vec3 start = s.motion(block).r;
  for (int k = 0; k < 950; ++k) ASSERT_TRUE(s.step()) << s.last.text();
  EXPECT_LT((s.motion(block).r - start).norm(), 1e-6);
  EXPECT_LT(s.drift(), 1e-10);
  EXPECT_LT(s.iterations, 4 * s.steps);
}

TEST(Incline, LetsABlockSlide) {
  const double mu = 0.3, slope = 0.5235987755982988, g = 9.81;
  Scene s(g * Vec3(std::sin(slope), 0.0, -std::cos(slope)));
  const int block =
      s.add_box("block", {0.2, 0.2, 0.1}, 1.0, at({0.0, 0.0, kRestingHeight}, {0.5, 0.0, 0.0}));
  s.add_floor();
  s.law(mu, 0.0);
  s.begin(5e-3);
  for (int k = 0; k < 200; ++k) ASSERT_TRUE(s.step()) << s.last.text();
  const double expected = 0.5 + 0.5 * g * (std::sin(slope) - mu * std::cos(slope));
  EXPECT_NEAR(s.motion(block).r.x(), expected, 1e-3 * expected);
}

// @tests{contact-bristle}
TEST(RollingBall, AcceleratesDownAnInclineByTheClosedForm) {
  const double slope = 0.3490658503988659, g = 9.81;
  Scene s(g * Vec3(std::sin(slope), 0.0, -std::cos(slope)));
  const int ball = s.add_ball("ball", 0.1, 1.0, at({0.0, 0.0, 0.1}));
  s.add_floor();
  s.law(0.5, 0.0);
  s.begin(5e-3);
  for (int k = 0; k < 200; ++k) ASSERT_TRUE(s.step()) << s.last.text();
  const double x = 5.0 / 7.0 * g * std::sin(slope) / 2.0;
  EXPECT_NEAR(s.motion(ball).r.x(), x, 1e-3 * x);
  EXPECT_NEAR(s.motion(ball).omega().y(), 2.0 * x / 0.1, 1e-3 * 2.0 * x / 0.1);
}

TEST(Stack, OfTenBoxesStands) {
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
  for (int k = 0; k < 50; ++k) ASSERT_TRUE(s.step()) << s.last.text();
  std::vector<Vec3> start;
  for (int k = 0; k < 10; ++k) start.push_back(s.motion(k).r);
  for (int k = 0; k < 100; ++k) ASSERT_TRUE(s.step()) << s.last.text();
  for (int k = 0; k < 10; ++k) EXPECT_LT((s.motion(k).r - start[k]).norm(), 1e-5) << k;
  EXPECT_LT(s.drift(), 1e-9);
}

TEST(FreeCollision, OfEveryPairOfShapesKeepsEnergyAndMomenta) {
  const auto& all = every_shape();
  for (std::size_t i = 0; i < all.size(); ++i)
    for (std::size_t j = i; j < all.size(); ++j) {
      if (!all[i].shape.bounded() || !all[j].shape.bounded()) continue;  // overlaps at the start
      SCOPED_TRACE(all[i].name + " and " + all[j].name);
      Random random(static_cast<unsigned>(1 + i + all.size() * j));
      Scene s(Vec3::Zero());
      BodyMotion m = random.motion();
      m.r.setZero();
      m.v = random.vector(0.2);
      const int a = s.add("a", all[i].shape, 1.0, {0.05, 0.06, 0.08}, m);
      m = random.motion();
      m.r = 1.6 * random.direction();
      m.v = -2.0 * m.r.normalized() + random.vector(0.2);
      s.add("b", all[j].shape, 1.5, {0.08, 0.09, 0.1}, m);
      s.law(0.0, 1.0);
      s.begin(1e-2);
      const Vec3 v_before = s.motion(a).v;
      for (int k = 0; k < 90; ++k) ASSERT_TRUE(s.step()) << s.last.text();
      const Ledger& l = s.state.ledger;
      EXPECT_LT(s.drift(), 1e-10 * l.energy_scale);
      EXPECT_LT(l.p_drift, 1e-10 * l.p_scale);
      EXPECT_LT(l.l_drift, 1e-10 * l.l_scale);
      EXPECT_GT((s.motion(a).v - v_before).norm(), 0.1) << "they do not meet";
    }
}

TEST(Contacts, ContinueBitForBitFromASavedState) {
  Scene s;
  Random random(4);
  for (int k = 0; k < 3; ++k) {
    BodyMotion m = random.motion();
    m.r = {0.05 * k, 0.0, 0.3 + 0.3 * k};
    s.add_box("box", {0.3, 0.2, 0.15}, 1.0, m);
  }
  s.add_floor();
  s.law(0.4, 0.3);
  s.begin(5e-3);
  for (int k = 0; k < 40; ++k) ASSERT_TRUE(s.step()) << s.last.text();
  const std::string middle = state_bytes(s.system, s.state);
  for (int k = 0; k < 15; ++k) ASSERT_TRUE(s.step()) << s.last.text();
  const std::string end = state_hash(s.system, s.state);
  s.state = state_from_bytes(s.system, middle, "test");
  s.restart();
  for (int k = 0; k < 15; ++k) ASSERT_TRUE(s.step()) << s.last.text();
  EXPECT_EQ(state_hash(s.system, s.state), end);
}

}  // namespace
}  // namespace polhode::contact_engine_tests
