// SPDX-License-Identifier: Apache-2.0
#include <fstream>
#include <numbers>
#include <sstream>

#include <gtest/gtest.h>

#include "contact/starts.hpp"
#include "support/paths.hpp"
#include "validation/model_scene.hpp"

namespace polhode::contact_friction_tests {
namespace {

using namespace test;

constexpr double kGravity = 9.81;

ModelScene slope(double angle) {
  return ModelScene(kGravity * Vec3(std::sin(angle), 0.0, -std::cos(angle)));
}

/// SLIDE_TO_ROLL: v = 5/7 v_0; the transition falls inside a step, which causes an error of O(Δt²)
/// [-].
TEST(ContactFriction, BowlingBallRollsInTheEnd) {
  ModelScene s;
  const int ball = s.add_ball("ball", 0.1, 1.0, at({0.0, 0.0, 0.1}, {2.0, 0.0, 0.0}));
  s.add_floor();
  s.law(0.3, 0.0);
  s.begin(2e-3);
  s.run(0.6);
  const BodyMotion m = s.motion(ball);
  EXPECT_NEAR(m.v.x(), 10.0 / 7.0, 1e-3 * 10.0 / 7.0);
  EXPECT_NEAR(m.omega().y(), 100.0 / 7.0, 1e-3 * 100.0 / 7.0);
  EXPECT_NEAR(m.r.x(), 0.912619, 1e-3 * 0.912619);
  EXPECT_GT(s.simulation().balance().dissipated, 0.5);  // ½ m v_0² (1 − 5/7) = 0.571 J
}

TEST(ContactFriction, SlippingBallOnASlope) {
  const double angle = 20.0 / 180.0 * std::numbers::pi, mu = 0.05;
  ModelScene s = slope(angle);
  const int ball = s.add_ball("ball", 0.1, 1.0, at({0.0, 0.0, 0.1}));
  s.add_floor();
  s.law(mu, 0.0);
  s.begin(5e-3);
  s.run(1.0);
  const double x = 0.5 * kGravity * (std::sin(angle) - mu * std::cos(angle));
  const double omega = mu * kGravity * std::cos(angle) * 0.1 / (0.4 * 0.01);
  EXPECT_NEAR(s.motion(ball).r.x(), x, 1e-3 * x);
  EXPECT_NEAR(s.motion(ball).omega().y(), omega, 1e-3 * omega);
}

/// SLIDE_ON_INCLINE: at 30 degrees 1.314292 m in 2 s with μ = 0.5, no motion with 0.6.
TEST(ContactFriction, BoxOnThirtyDegrees) {
  const double angle = std::numbers::pi / 6.0;
  for (const double mu : {0.5, 0.6}) {
    ModelScene s = slope(angle);
    // At rest: a quarter of the load on a corner lies at s = 0.69 of the band.
    const int box = s.add_box("box", {0.4, 0.4, 0.2}, 1.0, at({0.0, 0.0, 0.1 + 0.38e-5}));
    s.add_floor();
    s.law(mu, 0.0, 1e-5);
    s.begin(5e-3);
    s.run(0.5);
    const double settled = s.motion(box).r.x();
    s.run(1.5);
    const double x = s.motion(box).r.x();
    if (mu == 0.5) {
      EXPECT_NEAR(x, 1.314292, 1e-3 * 1.314292);
    } else {
      EXPECT_LT(std::abs(settled), 1e-4);
      EXPECT_LT(std::abs(x - settled), 1e-6);
    }
  }
}

/// A disc without thickness that rolls without slip: reference by integration of the ideal
/// equations. Tolerance: the phase of the Cayley step.
TEST(ContactFriction, CoinRollsAsTheReferenceDoes) {
  const double r = 0.01, tilt = std::numbers::pi / 180.0, tolerance = 1e-5, k = 2e9;
  const double gap = resting_gap(k, tolerance, kGravity);
  ModelScene s;
  BodyMotion start = at({0.00017452406437283512, 0.0, 0.009998476951563915 + gap});
  start.q = Quat(Eigen::AngleAxisd(tilt, Vec3::UnitY()));
  const Vec3 omega(0.0, 0.0, 31.41592653589793);
  start.v = omega.cross(start.q * Vec3(0.0, 0.0, r));
  start.W = start.q.conjugate() * omega;
  const int coin = s.add("coin", ModelScene::shape("ellipsoid", {2e-7, 2.0 * r, 2.0 * r}), 1.0,
                         {5e-5, 2.5e-5, 2.5e-5}, start);
  s.add_floor();
  s.law(1.0, 0.0, tolerance);
  s.law().stiffness = k;
  s.law().friction_stiffness = 1e7;
  s.begin(5e-4);

  std::ifstream file(test_data_dir() + "/rolling_coin.csv");
  ASSERT_TRUE(file);
  std::string line;
  double worst = 0.0;
  int compared = 0;
  while (std::getline(file, line)) {
    if (line.empty() || line[0] == '#') continue;
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream in(line);
    double t = 0.0;
    Vec3 x;
    in >> t >> x[0] >> x[1] >> x[2];
    while (s.simulation().time() < t - 1e-9) s.step();
    x.z() += gap;
    worst = std::max(worst, (s.motion(coin).r - x).lpNorm<Eigen::Infinity>());
    ++compared;
  }
  EXPECT_EQ(compared, 101);
  EXPECT_LT(worst, 2e-6);
}

/// A ball that rolls and spins about the vertical with resistance to both: 5 μ_r g/(7 R).
TEST(ContactFriction, RollingAndTorsionalFrictionStopABall) {
  const double R = 0.1, rolling = 2e-3, torsion = 3e-3;
  ModelScene s;
  BodyMotion start = at({0.0, 0.0, R}, {1.0, 0.0, 0.0});
  start.W = {0.0, 10.0, 20.0};
  const int ball = s.add_ball("ball", R, 1.0, start);
  s.add_floor();
  s.law(0.5, 0.0);
  s.law().rolling = rolling;
  s.law().torsion = torsion;
  s.begin(2e-3);
  s.run(1.0);
  const double a = 5.0 * rolling * kGravity / (7.0 * R);
  const double slowing = torsion * kGravity / (0.4 * R * R);
  EXPECT_NEAR(s.motion(ball).r.x(), 1.0 - 0.5 * a, 5e-3 * (1.0 - 0.5 * a));
  EXPECT_NEAR(s.motion(ball).omega().z(), 20.0 - slowing, 5e-3 * (20.0 - slowing));
  s.run(8.0);
  EXPECT_NEAR(s.motion(ball).r.x(), 0.5 / a, 5e-3 * 0.5 / a);
  EXPECT_LT(s.motion(ball).v.norm(), 1e-6);
  EXPECT_LT(s.motion(ball).omega().norm(), 1e-5);
}

/// Motion of the same block in metres and in millimetres.
TEST(ContactFriction, MovesTheSameInMillimetres) {
  const auto run = [](double unit) {
    ModelScene s(Vec3(1.0, 0.0, -kGravity) * unit);
    BodyMotion start = at(Vec3(0.0, 0.0, 0.2) * unit, Vec3(0.5, 0.1, 0.0) * unit);
    start.W = {0.3, -0.2, 2.0};
    const int ball = s.add_ball("ball", 0.1 * unit, 1.0, start);
    s.add_floor();
    s.law(0.3, 0.6);
    s.begin(5e-3);
    s.run(2.0);
    BodyMotion m = s.motion(ball);
    m.r /= unit;
    m.v /= unit;
    return m;
  };
  const BodyMotion metres = run(1.0), millimetres = run(1e3);
  EXPECT_LT((metres.r - millimetres.r).norm(), 1e-8 * metres.r.norm());
  EXPECT_LT((metres.W - millimetres.W).norm(), 1e-8 * metres.W.norm());
}

}  // namespace
}  // namespace polhode::contact_friction_tests
