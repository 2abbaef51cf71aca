// SPDX-License-Identifier: Apache-2.0
// Contact between bodies that carry deformable solids, with and without joints.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <polhode/system/state_archive.hpp>

#include "contact/scene.hpp"

namespace polhode::contact_solids_tests {
namespace {

using namespace test;

/// A cart with a rigid buffer in front and a deformable bar behind it or on its roof. All move
/// along x towards a wall at x = 0.
struct Cart {
  Scene s{Vec3::Zero()};
  int body = 0;
  double carried = 0.0;

  Cart(double e, double stiffness, double dt, double speed = 1.0) {
    body = s.add_ball("cart", 0.1, 2.0, at({0.3, 0.0, 0.0}, {-speed, 0.0, 0.0}));
    carried = s.add_bar(
        body,
        {.from = {0.1, 0.0, 0.0}, .cells = {2, 1, 1}, .density = 500.0, .stiffness = stiffness});
    s.add_floor(Vec3::UnitX());
    s.law(0.0, e);
    s.begin(dt);
  }
  /// Steps until the cart's surface leaves the wall. @returns false if it never does.
  bool rebound() {
    for (int k = 0; k < 4000; ++k) {
      if (!s.step()) return false;
      if (s.motion(body).v.x() > 0.0 && s.motion(body).r.x() > 0.1 + 1e-4) return true;
    }
    return false;
  }
  [[nodiscard]] double mean_speed() const {
    return s.balance().linear_momentum.x() / (2.0 + carried);
  }
  /// Effective mass of the cart for an impulse along x, from the mass matrix [kg].
  [[nodiscard]] double struck() const {
    const Nodes& nodes = s.system.nodes();
    const int n = nodes.count();
    Mat M = Mat::Zero(n, n);
    for (int i = 0; i < n; ++i)
      for (int b = nodes.row_start()[i]; b < nodes.row_start()[i + 1]; ++b)
        M(i, nodes.column()[b]) += nodes.mass()[b];
    std::vector<Eigen::Index> bonded, free;
    for (int i = 0; i < n; ++i) (nodes.bonded(i) ? bonded : free).push_back(i);
    const Mat S =
        M(bonded, bonded) - M(bonded, free) * M(free, free).ldlt().solve(Mat(M(free, bonded)));
    return 2.0 + S.sum();
  }
};

/// Rebound in one step of many periods of vibration: a stiff solid rebounds with its body as if
/// both were rigid. The change of speed that the law of restitution gives to the body alone is
/// distributed by vibrations that the step does not resolve.
// @tests{turn-law}
TEST(ContactSolids, StiffCartReboundsTogetherWithItsSolid) {
  for (const double e : {0.3, 0.5, 0.8, 1.0}) {
    Cart c(e, 1e10, 2e-2);
    ASSERT_TRUE(c.rebound()) << c.s.last.text();
    const double total = 2.0 + c.carried;
    EXPECT_NEAR(c.mean_speed(), 1.0 - (1.0 - e) * c.struck() / total, 2e-3) << e;
    EXPECT_GE(c.s.state.ledger.dissipated.value(), 0.0);
  }
}

/// Rebound in steps that are short relative to the vibrations: at the end of the impact only the
/// effective mass rebounds, with e times its speed; the rest of the solid continues.
TEST(ContactSolids, BodyOfASoftCartReboundsWithItsRestitution) {
  for (const double e : {0.3, 0.8, 1.0}) {
    Cart c(e, 2e3, 1e-3);
    ASSERT_TRUE(c.rebound()) << c.s.last.text();
    EXPECT_NEAR(c.s.motion(c.body).v.x(), e, 5e-3) << e;
    EXPECT_NEAR(c.mean_speed(), -1.0 + (1.0 + e) * c.struck() / (2.0 + c.carried), 5e-3) << e;
    EXPECT_LT(c.s.drift(), 1e-10 * c.s.state.ledger.energy_scale);
  }
}

/// Two carts in free flight, each with a bar, and a third body hanging from one on a joint.
struct Flight {
  Scene s{Vec3::Zero()};
  int a = 0, b = 0, tail = -1;

  Flight(double mu, double e, bool joint) {
    BodyMotion m = at({-0.8, 0.03, 0.0}, {1.5, 0.0, 0.1});
    if (!joint) m.W = {0.4, -0.2, 1.0};
    a = s.add_box("a", {0.4, 0.3, 0.2}, 1.0, m);
    b = s.add_ball("b", 0.2, 1.5, at({0.4, 0.05, 0.02}, {-1.0, 0.0, 0.0}));
    s.add_bar(a, {.from = {-0.1, 0.0, 0.1}, .size = {0.4, 0.1, 0.1}, .stiffness = 3e4});
    if (joint) {
      tail = s.add_box("tail", {0.1, 0.1, 0.1}, 0.5, at({0.8, 0.05, 0.02}, {-1.0, 0.0, 0.0}));
      s.add_joint("spherical", b, tail, {0.7, 0.05, 0.02});
    } else {
      tail = s.add_ball("tail", 0.1, 0.5, at({1.0, 0.05, 0.02}, {-1.0, 0.0, 0.0}));
    }
    s.add_bar(b, {.from = {0.1, 0.0, 0.0},
                  .size = {0.5 - (joint ? 0.2 : 0.0), 0.05, 0.05},
                  .stiffness = 3e4,
                  .far = tail});
    s.law(mu, e);
    s.begin(1e-3);
  }
};

// @tests{turn-law}
TEST(ContactSolids, ImpactsInFreeFlightKeepMomentaAndNeverAddEnergy) {
  for (const bool joint : {false, true})
    for (const auto& [mu, e] : {std::pair(0.0, 0.0), {0.0, 0.6}, {0.4, 0.3}}) {
      Flight f(mu, e, joint);
      const Balance start = f.s.balance();
      const double scale = start.kinetic, p = f.s.state.ledger.p_scale;
      double energy = start.kinetic + start.potential;
      for (int k = 0; k < 1000; ++k) {
        ASSERT_TRUE(f.s.step()) << f.s.last.text();
        const Balance now = f.s.balance();
        ASSERT_LT(now.kinetic + now.potential - energy, 1e-12 * scale) << "step " << k;
        energy = now.kinetic + now.potential;
        ASSERT_LT((now.linear_momentum - start.linear_momentum).norm(), 1e-10 * p) << k;
        ASSERT_LT((now.angular_momentum - start.angular_momentum).norm(), 1e-10 * p) << k;
      }
      EXPECT_LT(energy, (1.0 - 1e-2) * scale) << "there was no impact";
      EXPECT_LT(f.s.drift(), 1e-10 * scale);
    }
}

/// A body with a bar along its roof rests on the floor: four corners of its rigid box carry the
/// weight of both.
TEST(ContactSolids, RestsOnTheFloorWithTheWeightOfBodyAndSolid) {
  Scene s;
  const double half = 0.05;
  const int box = s.add_box("box", {0.4, 0.3, 2.0 * half}, 1.0, at({0.0, 0.0, half}));
  const double carried = s.add_bar(box, {.from = {-0.2, 0.0, 0.2},
                                         .size = {0.4, 0.1, 0.1},
                                         .cells = {2, 1, 1},
                                         .density = 200.0,
                                         .stiffness = 1e6,
                                         .relaxation_time = 5e-3,
                                         .far = box});
  s.add_floor();
  s.law(0.5, 0.0, 1e-4);
  s.begin(1e-2);
  ASSERT_TRUE(s.run(4.0)) << s.last.text();
  double force = 0.0;
  for (const auto& r : s.contacts->reports()) force += r.normal_force;
  const double weight = (1.0 + carried) * 9.81;
  EXPECT_NEAR(force, weight,
              1e-5 * weight);  // an increment of 1e-12 m times the contact's stiffness
  EXPECT_LT(s.motion(box).v.norm(), 1e-6);
  const double k = 373.0 * weight / 1e-4;  // which carries it at a twentieth of the band
  EXPECT_NEAR(s.motion(box).r.z(), half + resting_gap(k, 1e-4, 0.25 * weight), 1e-8);
  EXPECT_LT(s.drift(), 1e-9);
}

/// Two jointed links with a bar between them fall on a slope.
TEST(ContactSolids, ChainWithASolidFallsAndItsJointsHold) {
  for (const double e : {0.0, 0.6}) {
    Scene s;
    const auto link = [&](const char* name, double x) {
      return s.add_box(name, {0.3, 0.1, 0.08}, 1.0, at({x, 0.0, 0.5}));
    };
    const int one = link("one", 0.0), two = link("two", 0.5), three = link("three", 0.84);
    s.add_bar(
        one,
        {.from = {0.15, 0.0, 0.0}, .size = {0.2, 0.05, 0.05}, .relaxation_time = 1e-3, .far = two});
    s.add_joint("spherical", two, three, {0.67, 0.0, 0.5});
    s.contacts->exclude(one, two);
    s.add_floor(Vec3(0.1, 0.05, 1.0).normalized());
    s.law(1.0, e);
    s.begin(5e-3);
    double energy = s.energy(), rise = 0.0;
    for (int k = 0; k < 600; ++k) {
      ASSERT_TRUE(s.step()) << s.last.text();
      rise = std::max(rise, s.energy() - energy);
      energy = s.energy();
    }
    EXPECT_LT(rise, 1e-12 * s.state.ledger.energy_scale) << e;
    EXPECT_LT(s.drift(), 1e-10 * s.state.ledger.energy_scale);
    EXPECT_LT(s.state.ledger.constraint_max, 1e-10);
    EXPECT_LT(s.motion(one).v.norm(), 1e-2) << e;
  }
}

TEST(ContactSolids, ContinueBitForBitFromASavedState) {
  Flight f(0.4, 0.5, true);
  ASSERT_TRUE(f.s.run(0.15)) << f.s.last.text();
  const std::string middle = state_bytes(f.s.system, f.s.state);
  ASSERT_TRUE(f.s.run(0.2)) << f.s.last.text();
  const std::string end = state_hash(f.s.system, f.s.state);
  f.s.state = state_from_bytes(f.s.system, middle, "test");
  f.s.restart();
  ASSERT_TRUE(f.s.run(0.2)) << f.s.last.text();
  EXPECT_EQ(state_hash(f.s.system, f.s.state), end);
}

/// Report of a step that does not converge: the contact with the largest residual.
TEST(ContactSolids, NamesTheContactThatDoesNotConverge) {
  Cart c(0.5, 1e5, 2e-2);
  c.s.max_iterations = 1;
  std::string worst;
  c.s.watch = [&](double) {
    const std::string text = c.s.last.text();
    if (!c.s.last.converged && worst.empty() && text.find("contact of") != std::string::npos)
      worst = text;
  };
  while (c.s.step() && c.s.motion(c.body).v.x() < 0.0) {
  }
  EXPECT_THAT(worst, testing::AllOf(testing::HasSubstr("contact of"), testing::HasSubstr("'cart'")))
      << worst;
}

}  // namespace
}  // namespace polhode::contact_solids_tests
