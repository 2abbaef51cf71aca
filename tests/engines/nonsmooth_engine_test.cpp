// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <polhode/contact/round_solids/cone.hpp>
#include <polhode/contact/round_solids/cylinder.hpp>
#include <polhode/contact/round_solids/ellipsoid.hpp>
#include <polhode/core/error.hpp>
#include <polhode/engines/nonsmooth_engine.hpp>
#include <polhode/system/state_archive.hpp>

#include "contact/scene.hpp"

namespace polhode::nonsmooth_engine_tests {
namespace {

using namespace test;

constexpr ImpulseOptions kExact{20000, 1e-6};

/// Balls and boxes of different masses that fall into a corner of two walls and a floor.
struct Heap : Scene {
  explicit Heap(const ImpulseOptions& options, double mu = 0.4, double restitution = 0.0) {
    for (int i = 0; i < 24; ++i) {
      const Vec3 r(0.25 * (i % 3) + 0.13 + 0.004 * std::sin(13.0 * i),
                   0.25 * ((i / 3) % 2) + 0.13 + 0.004 * std::sin(78.0 * i), 0.14 + 0.26 * (i / 6));
      if (i % 5 == 4)
        add_box("box " + std::to_string(i), {0.16, 0.18, 0.2}, 1.2, at(r));
      else
        add_ball("ball " + std::to_string(i), 0.1, 1.0, at(r));
    }
    add_floor();
    add_floor(Vec3::UnitX());
    add_floor(Vec3::UnitY());
    law(mu, restitution);
    contacts->set_impulses(options);
    begin(2e-3);
  }
};

/// @tests{nonsmooth-step}
TEST(NonsmoothEngine, KeepsTheEnergyOfElasticBounces) {
  for (const double dt : {1e-2, 1e-3}) {
    Scene s;
    const int ball = s.add_ball("ball", 0.1, 1.0, at({0.0, 0.0, 1.1}));
    s.add_floor();
    s.law(0.0, 1.0);
    s.contacts->set_impulses({});
    s.begin(dt);
    const double energy = s.energy();
    double drift = 0.0, lowest = 1.0, apex = 0.0;
    for (int k = 0; k < std::lround(18.0 / dt); ++k) {
      ASSERT_TRUE(s.step()) << s.last.text();
      drift = std::max(drift, std::abs(s.energy() / energy - 1.0));
      lowest = std::min(lowest, s.motion(ball).r.z() - 0.1);
      if (s.state.t > 16.0) apex = std::max(apex, s.motion(ball).r.z() - 0.1);
    }
    EXPECT_LT(drift, 1e-11);  // rounding of 18,000 steps
    EXPECT_GT(lowest, -1e-12);
    EXPECT_NEAR(apex, 1.0, 9.81 * dt * dt);  // the apex lies between two steps
  }
}

/// Balls without gravity rebound with e times their speed, e of the pair of materials; with e = 0
/// they stop at the surface. @tests{nonsmooth-exit}
TEST(NonsmoothEngine, ReboundsWithTheRestitutionOfThePair) {
  Scene s(Vec3::Zero());
  const double restitution[] = {0.0, 0.5, 0.9};
  const int plate = s.contacts->add_material({"plate", 0.0, 1.0});
  s.contacts->add_shape({kGround, "plate", geometry::plane(), plate});
  for (int k = 0; k < 3; ++k) {
    BodyData data;
    data.name = "ball";
    data.mass = 1.0 + k;
    const int body = s.system.add_body(data, at({1.0 * k, 0.0, 0.5}, {0.0, 0.0, -2.0}));
    const int material = s.contacts->add_material({"m", 0.0, restitution[k]});
    contact::ContactLaw law;
    law.restitution = restitution[k];
    s.contacts->set_law(material, plate, law);
    s.contacts->add_shape({body, "ball", geometry::sphere("ball", 0.2), material});
  }
  s.contacts->set_impulses({});
  s.begin(3e-3);
  double least = 1.0;
  for (int k = 0; k < 100; ++k) {
    ASSERT_TRUE(s.step());
    least = std::min(least, s.least_gap());
  }
  EXPECT_GT(least, -1e-15);
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(s.motion(k).v.z(), 2.0 * restitution[k], 1e-12);
  EXPECT_NEAR(s.motion(0).r.z(), 0.1, 1e-12);
  // ½ m v² (1 − e²), all of it in the energy balance.
  const Ledger& l = s.state.ledger;
  EXPECT_NEAR(l.dissipated.value(), 2.0 * 1.0 + 4.0 * 0.75 + 6.0 * 0.19, 1e-11);
  EXPECT_LT(s.drift(), 1e-12);
}

/// @tests{nonsmooth-step}
TEST(NonsmoothEngine, KeepsMomentaWithoutConvergence) {
  for (const int sweeps : {1, 3, 1000}) {
    Scene s(Vec3::Zero());
    BodyMotion left = at({-0.4, 0.01, 0.02}, {1.5, 0.1, 0.0});
    left.q = Quat(Eigen::AngleAxisd(0.7, Vec3(1.0, 2.0, -1.0).normalized()));
    left.W = {3.0, -4.0, 5.0};
    BodyMotion right = at({0.4, -0.02, 0.0}, {-1.0, 0.0, 0.2});
    right.q = Quat(Eigen::AngleAxisd(-0.4, Vec3(0.0, 1.0, 1.0).normalized()));
    right.W = {-1.0, 6.0, 2.0};
    s.add_box("left", {0.3, 0.2, 0.4}, 1.3, left);
    s.add_box("right", {0.2, 0.5, 0.3}, 2.1, right);
    s.law(0.5, 0.4);
    s.contacts->set_impulses({sweeps, 1e-10});
    s.begin(2e-3);
    bool touched = false;
    for (int k = 0; k < 400; ++k) {
      ASSERT_TRUE(s.step()) << s.last.text();
      touched = touched || !s.contacts->touching().empty();
    }
    ASSERT_TRUE(touched);
    const Ledger& l = s.state.ledger;
    EXPECT_LT(l.p_drift, 1e-13 * l.p_scale) << sweeps;
    EXPECT_LT(l.l_drift, 1e-13 * l.l_scale) << sweeps;
    // Energy lost by contact is exact in the balance, too, except with few sweeps, which may add
    // energy.
    if (sweeps > 3) {
      EXPECT_LT(s.drift(), 1e-12 * l.energy_scale);
    }
    EXPECT_GT(l.dissipated.value(), 0.0);
  }
}

/// @tests{nonsmooth-energy} @tests{nonsmooth-projection}
TEST(NonsmoothEngine, NeverGainsEnergyOnceConverged) {
  for (const double e : {0.0, 0.6}) {
    Heap s(kExact, 0.0, e);
    double energy = s.energy(), rise = 0.0;
    int solved = 0;  // steps that converge; wedged balls need too many sweeps for this test
    for (int k = 0; k < 300; ++k) {
      ASSERT_TRUE(s.step()) << s.last.text();
      if (s.search().converged) {
        ++solved;
        rise = std::max(rise, s.energy() - energy);
      }
      energy = s.energy();
    }
    EXPECT_GT(solved, 280) << e;
    EXPECT_LT(rise, 1e-9 * s.state.ledger.energy_scale) << e;
    EXPECT_GT(s.state.ledger.dissipated.value(), 0.0);
  }
}

TEST(NonsmoothEngine, SolvesAHeapWithFewSweeps) {
  Heap s({100, 1e-3});
  double energy = s.energy(), rise = 0.0, least = 1.0;
  for (int k = 0; k < 1000; ++k) {
    ASSERT_TRUE(s.step()) << s.last.text();
    rise = std::max(rise, s.energy() - energy);
    energy = s.energy();
    least = std::min(least, s.least_gap());
  }
  EXPECT_LT(rise, 1e-3);  // of 100 J
  EXPECT_GT(least, -1e-3);
  const Ledger& l = s.state.ledger;
  EXPECT_LT(l.p_drift, 1e-11 * l.p_scale);
}

TEST(NonsmoothEngine, ContinuesBitForBitFromASavedState) {
  Heap s({50, 1e-3});
  ASSERT_TRUE(s.run(0.4));
  const std::string middle = state_bytes(s.system, s.state);
  ASSERT_TRUE(s.run(0.2));
  const std::string end = state_hash(s.system, s.state);
  s.state = state_from_bytes(s.system, middle, "test");
  s.restart();
  ASSERT_TRUE(s.run(0.2));
  EXPECT_EQ(state_hash(s.system, s.state), end);
}

/// A ball that moves 0.4 m in a step, towards a plate of 1 cm.
TEST(NonsmoothEngine, LetsNothingPassThroughAThinPlate) {
  Scene s(Vec3::Zero());
  const int ball = s.add_ball("ball", 0.05, 1.0, at({-1.03, 0.01, 0.0}, {200.0, 0.0, 0.0}));
  const int plate = s.add_box("plate", {0.01, 1.0, 1.0}, 100.0, at(Vec3::Zero()));
  s.law(0.3, 0.0);
  s.contacts->set_impulses({});
  s.begin(2e-3);
  ASSERT_TRUE(s.run(0.02));
  EXPECT_LT(s.motion(ball).r.x(), s.motion(plate).r.x() - 0.05);
  EXPECT_LT(s.state.ledger.p_drift, 1e-13 * s.state.ledger.p_scale);
}

/// A ball that slides over the triangles of level ground, past the edges between them.
TEST(NonsmoothEngine, SlidesOverTheEdgesOfCoplanarTriangles) {
  Scene s;
  const int ball = s.add_ball("ball", 0.1, 1.0, at({-0.93, -0.21, 0.1}, {2.0, 0.7, 0.0}));
  const std::vector<double> heights(21 * 21, 0.0);
  s.contacts->add_shape({kGround, "ground", geometry::height_field("ground", 21, 0.1, heights)});
  s.law(0.0, 0.0);
  s.contacts->set_impulses({});
  s.begin(2e-3);
  ASSERT_TRUE(s.run(0.8));
  EXPECT_LT((s.motion(ball).v - Vec3(2.0, 0.7, 0.0)).norm(), 1e-9);
  EXPECT_NEAR(s.motion(ball).r.z(), 0.1, 1e-9);
}

/// Shapes of all kinds that come to rest on a fixed plate.
TEST(NonsmoothEngine, SupportsEveryShapeOnAPlate) {
  Scene s;
  std::vector<int> bodies;
  const auto drop = [&](const std::string& name, const geometry::Shape& shape, double x) {
    BodyMotion start = at({x, 0.0, 0.24});
    bodies.push_back(s.add(name, shape, 1.0, Vec3::Constant(2e-3), start));
  };
  const Vec3 corners[] = {
      {-0.1, -0.1, -0.1}, {0.1, -0.1, -0.1}, {0.0, 0.12, -0.1}, {0.0, 0.0, 0.1}};
  drop("capsule", geometry::capsule("capsule", 0.2, 0.04), 0.0);
  drop("cylinder", contact::cylinder("cylinder", 0.2, 0.24), 0.6);
  drop("cone", contact::cone("cone", 0.2, 0.24), 1.2);
  drop("ellipsoid", contact::ellipsoid("ellipsoid", {0.3, 0.3, 0.2}), 1.8);
  drop("hull", geometry::hull("hull", corners), 2.4);
  drop("box", geometry::box("box", {0.2, 0.2, 0.2}), 3.0);
  s.contacts->add_shape({kGround, "plate", geometry::box("plate", {10.0, 2.0, 0.2})});
  s.law(0.5, 0.0);
  s.contacts->set_impulses({300, 1e-6});
  s.begin(2e-3);
  ASSERT_TRUE(s.run(2.0)) << s.last.text();
  for (const int b : bodies) {
    EXPECT_GT(s.motion(b).r.z(), 0.15) << b;
    EXPECT_LT(s.motion(b).v.norm(), 2e-3) << b;
  }
  EXPECT_GT(s.least_gap(), -1e-4);
}

TEST(NonsmoothEngine, RefusesJoints) {
  Scene s;
  const int ball = s.add_ball("ball", 0.1, 1.0, at({0.0, 0.0, 0.5}));
  s.add_joint("spherical", kGround, ball, {0.0, 0.0, 1.0});
  s.contacts->set_impulses({});
  EXPECT_THROW(s.begin(1e-3), InputError);
}

}  // namespace
}  // namespace polhode::nonsmooth_engine_tests
