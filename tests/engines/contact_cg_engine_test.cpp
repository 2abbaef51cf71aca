// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <limits>

#include <polhode/core/error.hpp>
#include <polhode/system/state_archive.hpp>

#include "contact/scene.hpp"

namespace polhode::contact_cg_engine_tests {
namespace {

using namespace test;

/// Initial position of the i-th body of a heap.
Vec3 place(int i) {
  return {0.25 * (i % 3) + 0.13 + 0.004 * std::sin(13.0 * i),
          0.25 * ((i / 3) % 2) + 0.13 + 0.004 * std::sin(78.0 * i), 0.14 + 0.26 * (i / 6)};
}

/// Balls and a few boxes that fall into a corner of two walls and a floor.
struct Heap : Scene {
  explicit Heap(double residual, const std::function<void(Scene&)>& more = {}, double dt = 2e-3) {
    cg_residual = residual;
    for (int i = 0; i < 24; ++i) {
      const Vec3 r = place(i);
      if (i % 5 == 4)
        add_box("box " + std::to_string(i), {0.16, 0.18, 0.2}, 1.2, at(r));
      else
        add_ball("ball " + std::to_string(i), 0.1, 1.0, at(r));
    }
    if (more) more(*this);
    add_floor();
    add_floor(Vec3::UnitX());
    add_floor(Vec3::UnitY());
    law(0.4, 0.0);
    begin(dt);
  }
};

/// Mean number of iterations of the steps up to a time; infinite if a step fails.
double iterations_to(Scene& s, double end) {
  int steps = 0, iterations = 0;
  for (; s.state.t < end; ++steps) {
    if (!s.step()) {
      ADD_FAILURE() << s.last.text();
      return std::numeric_limits<double>::infinity();
    }
    iterations += s.last.iterations;
  }
  return static_cast<double>(iterations) / steps;
}

TEST(ContactCgEngine, AgreesWithTheDirectEngineForAHeap) {
  Heap iterative(1e-9), direct(0.0);
  // A heap of impacts is chaotic: later the motions of the engines diverge.
  ASSERT_TRUE(iterative.run(0.14)) << iterative.last.text();
  ASSERT_TRUE(direct.run(0.14)) << direct.last.text();
  for (int b = 0; b < 24; ++b)
    EXPECT_LT((iterative.motion(b).r - direct.motion(b).r).norm(), 1e-6) << b;
}

// The remaining residual acts as a force for the time of the run; at steps below 1 ms it is
// proportionally smaller.
TEST(ContactCgEngine, BalancesMomentaToItsToleranceAtAnyStep) {
  for (const double dt : {2e-3, 2e-4, 1e-5}) {
    Heap s(1e-6, {}, dt);
    const int steps = dt > 1e-4 ? 300 : 3000;
    for (int k = 0; k < steps; ++k) ASSERT_TRUE(s.step()) << s.last.text();
    const Ledger& l = s.state.ledger;
    EXPECT_LT(l.p_drift, 1e-6 * std::min(1.0, dt / 1e-3) * l.p_scale) << dt;
    EXPECT_LT(l.l_drift, 1e-6 * std::min(1.0, dt / 1e-3) * l.l_scale) << dt;
  }
}

TEST(ContactCgEngine, NeverGainsEnergyAndBalancesMomentum) {
  Heap s(1e-8);
  double energy = s.energy(), rise = 0.0;
  for (int k = 0; k < 300; ++k) {
    ASSERT_TRUE(s.step()) << s.last.text();
    rise = std::max(rise, s.energy() - energy);
    energy = s.energy();
  }
  const Ledger& l = s.state.ledger;
  EXPECT_LT(rise, 1e-12 * l.energy_scale);
  // Residuals of 1e-8 of the weight act for 0.6 s, on momenta of some 2 N s a body.
  EXPECT_LT(l.p_drift, 1e-6 * l.p_scale);
  for (const auto& r : s.contacts->reports()) EXPECT_GT(r.gap, -2e-4);
}

/// Two balls far from the others that would pass through each other in one step: the predictor
/// starts where their impact stops them. @tests{contact-predictor}
TEST(ContactCgEngine, FindsTheEndOfAnImpactInFewIterations) {
  for (const double speed : {0.1, 1.0, 10.0, 200.0}) {
    Scene s(Vec3::Zero());
    s.cg_residual = 1e-6;
    const int a = s.add_ball("a", 0.1, 1.0, at({-0.1003, 0.0, 0.0}, {speed, 0.0, 0.0}));
    s.add_ball("b", 0.1, 3.0, at({0.1003, 0.0, 0.0}, {-speed, 0.0, 0.0}));
    s.add_ball("c", 0.1, 1.0, at({5.0, 0.0, 0.0}, {0.0, speed, 0.0}));
    s.law(0.0, 0.0);
    s.begin(2e-3);
    ASSERT_TRUE(s.step()) << s.last.text();
    EXPECT_EQ(s.cuts, 0);
    EXPECT_LE(s.last.iterations, 10) << speed;
    EXPECT_NEAR(s.motion(2).v.y(), speed, 1e-10 * speed);
    ASSERT_TRUE(s.run(4e-3));
    EXPECT_LT(s.motion(a).v.x(), 0.0);  // rebound
    EXPECT_NEAR(s.motion(a).v.x() + 3.0 * s.motion(1).v.x(), -2.0 * speed, 1e-8 * speed);
  }
}

/// A ball with backspin that falls on the floor without rebound and slides until it rolls, and a
/// ball that falls on another: the predictor has the friction and rotation of the step, so that
/// Newton's method only corrects what the predictor neglects. @tests{contact-predictor}
TEST(ContactCgEngine, StartsCloseToTheSolution) {
  for (const double dt : {5e-3, 1e-3, 1e-4}) {
    Scene s;
    s.cg_residual = 1e-6;
    BodyMotion spinning = at({0.0, 0.0, 0.102}, {1.0, 0.0, 0.0});
    spinning.W = {0.0, -20.0, 0.0};
    s.add_ball("spinning", 0.1, 1.0, spinning);
    s.add_ball("below", 0.1, 1.0, at({1.0, 0.0, 0.1}));
    s.add_ball("above", 0.1, 2.0, at({1.02, 0.0, 0.31}, {0.0, 0.0, -1.0}));
    s.add_floor();
    s.law(0.3, 0.0);
    s.begin(dt);
    const double iterations = iterations_to(s, 0.2);
    EXPECT_EQ(s.cuts, 0);
    EXPECT_LT(iterations, dt > 1e-3 ? 5 : 2) << dt;
  }
}

/// Layers of boxes that fall on each other without rebound, some joined: gaps and rows are linear
/// in the predictor and, for boxes, corrected. @tests{contact-predictor}
TEST(ContactCgEngine, StartsCloseToTheSolutionWithBoxesAndJoints) {
  for (const double dt : {5e-3, 1e-3, 1e-4}) {
    Scene s;
    s.cg_residual = 1e-6;
    for (int i = 0; i < 18; ++i)
      s.add_box("box " + std::to_string(i), {0.18, 0.16, 0.14}, 1.0,
                at({0.22 * (i % 3) + 0.005 * std::sin(13.0 * i),
                    0.22 * ((i / 3) % 3) + 0.005 * std::sin(78.0 * i),
                    0.08 + 0.16 * (i / 9) + 0.005 * std::sin(38.0 * i)}));
    s.add_joint("spherical", 0, 1, {0.11, 0.0, 0.08});
    s.add_joint("revolute", 12, 13, {0.0, 0.33, 0.24});
    s.add_joint("fixed", 3, 4, {0.11, 0.22, 0.08});
    s.add_floor();
    s.law(0.5, 0.0);
    s.begin(dt);
    const double iterations = iterations_to(s, dt > 5e-4 ? 0.3 : 0.08);
    EXPECT_LE(s.cuts, 2) << dt;
    EXPECT_LT(iterations, dt > 1e-3 ? 10 : 4) << dt;
  }
}

/// A ball that falls on the face or over the edge of a turning paddle on a hinge: the gap at the
/// end of the step changes along another normal than that of its force, and the hinge opposes a
/// stiff contact. @tests{contact-spring}
TEST(ContactCgEngine, FindsTheEndOfAnImpactOnAHingedBody) {
  for (const double dt : {5e-3, 2e-3, 1e-4})
    for (const double beside : {0.0, 0.03, 0.055, 0.06, 0.065}) {
      Scene s;
      s.cg_residual = 1e-6;
      BodyMotion turning = at({0.0, 0.0, 0.0});
      turning.W = {0.0, 0.0, 3.0};
      const int paddle = s.add_box("paddle", {0.6, 0.06, 0.2}, 2.0, turning);
      const int ball = s.add_ball("ball", 0.1, 1.0, at({0.25, beside, 0.21}, {0.0, 0.0, -2.5}));
      s.add_joint("revolute", kGround, paddle, {0.0, 0.0, 0.0});
      s.law(0.5, 0.0);
      s.begin(dt);
      const double iterations = iterations_to(s, 0.03);
      EXPECT_LE(s.cuts, 2) << dt << ", " << beside;
      EXPECT_LT(iterations, 12) << dt << ", " << beside;
      EXPECT_GT(s.motion(ball).v.z(),
                beside == 0.0 ? -0.1 : -2.0);  // after contact with the paddle
    }
}

/// A ball that rolls and slides along the face of a heavy turning paddle: the gap is a small part
/// of the band while the ball moves on a curve relative to the paddle. @tests{contact-filter}
TEST(ContactCgEngine, FollowsABallOnARotatingFace) {
  for (const double dt : {10e-3, 8e-3, 5e-3, 1e-3, 1e-4}) {
    Scene s;
    s.cg_residual = 1e-6;
    BodyMotion turning = at({0.0, 0.0, 0.15});
    turning.W = {0.0, 0.0, 3.0};
    const int paddle = s.add_box("paddle", {0.6, 0.06, 0.2}, 200.0, turning);
    const int ball = s.add_ball("ball", 0.1, 1.0, at({0.15, 0.1301, 0.1}));
    s.add_joint("revolute", kGround, paddle, {0.0, 0.0, 0.15});
    s.add_floor();
    s.law(0.5, 0.0);
    s.begin(dt);
    const double iterations = iterations_to(s, 0.2);
    // At 10 ms and more a few steps are rejected, also with exact solutions of the equations.
    EXPECT_LE(s.cuts, dt > 8e-3 ? 3 : 0) << dt;
    EXPECT_LT(iterations, dt > 5e-3 ? 15 : dt > 5e-4 ? 8 : 4) << dt;
    const BodyMotion m = s.motion(ball), p = s.motion(paddle);
    EXPECT_GT(std::hypot(m.r.x(), m.r.y()), 0.22) << dt;  // farther from the axis than at the start
    const Vec3 seen = p.Lambda().transpose() * (m.r - p.r);
    EXPECT_NEAR(seen.y(), 0.13, 1e-3) << dt;
  }
}

/// A layer of balls that falls on another without rebound, with the narrow band of the default and
/// friction: impacts far longer than the band, and points between floor and neighbours that slide.
/// @tests{contact-slide-damping}
TEST(ContactCgEngine, NeedsFewIterationsForImpactsWithoutRebound) {
  Scene s;
  s.cg_residual = 1e-6;
  constexpr int kRow = 5;
  for (int i = 0; i < 3 * kRow * kRow; ++i)
    s.add_ball("ball " + std::to_string(i), 0.1, 1.0,
               at({0.22 * (i % kRow) + 0.005 * std::sin(13.0 * i),
                   0.22 * ((i / kRow) % kRow) + 0.005 * std::sin(78.0 * i),
                   0.12 + 0.22 * (i / (kRow * kRow)) + 0.005 * std::sin(38.0 * i)}));
  s.add_floor();
  s.law(0.5, 0.0);
  s.begin(2e-3);
  int steps = 0, iterations = 0;
  for (; steps < 200; ++steps) {
    ASSERT_TRUE(s.step()) << s.last.text();
    iterations += s.last.iterations;
  }
  EXPECT_LE(s.cuts, 2);
  EXPECT_LT(iterations, 4 * steps);
}

TEST(ContactCgEngine, ContinuesBitForBitFromASavedState) {
  Heap s(1e-6);
  ASSERT_TRUE(s.run(0.2));
  const std::string middle = state_bytes(s.system, s.state);
  ASSERT_TRUE(s.run(0.1));
  const std::string end = state_hash(s.system, s.state);
  s.state = state_from_bytes(s.system, middle, "test");
  s.restart();
  ASSERT_TRUE(s.run(0.1));
  EXPECT_EQ(state_hash(s.system, s.state), end);
}

/// Contact forces where few bodies moved: those between other bodies are not evaluated again.
TEST(ContactCgEngine, EvaluatesOnlyForcesOfBodiesThatMoved) {
  Heap s(1e-6);
  ASSERT_TRUE(s.run(0.4));
  const int n = s.system.body_count();
  std::vector<BodyStep> steps(static_cast<std::size_t>(n) + 1);
  StepContext context;
  context.dt = 2e-3;
  for (int b = 0; b < n; ++b) {
    steps[b] = s.system.instant(s.state, b);
    steps[b].alpha_f = 0.5;
  }
  steps.back() = BodyStep::ground(0.5);
  s.contacts->begin_step(s.state, steps, context);
  const auto forces = [&](const std::vector<char>& moved) {
    const auto points = s.contacts->evaluate_pointwise(steps, context, moved);
    return std::vector<ActingPoint>(points.begin(), points.end());
  };
  const std::vector<ActingPoint> before = forces({});
  ASSERT_GT(before.size(), 20U);
  std::vector<char> moved(steps.size(), 0);
  for (const int b : {2, 11, 12, 20}) {
    moved[b] = 1;
    steps[b].u = Vec3(1e-5 * b, -2e-5, -3e-5);
    steps[b].r_n1 = steps[b].r_n + steps[b].u;
  }
  const std::vector<ActingPoint> part = forces(moved), all = forces({});
  ASSERT_EQ(part.size(), all.size());
  int others = 0, same = 0;
  for (std::size_t k = 0; k < all.size(); ++k) {
    EXPECT_EQ(part[k].point, all[k].point);
    EXPECT_EQ(part[k].force, all[k].force);
    EXPECT_EQ(part[k].moment_a, all[k].moment_a);
    EXPECT_EQ(part[k].moment_b, all[k].moment_b);
    // The part of the friction slope of a sliding point depends on earlier evaluations.
    const bool slides = !all[k].spring.friction_slope.isZero(0.0);
    EXPECT_TRUE(slides || part[k].spring.C == all[k].spring.C);
    const auto was = std::find_if(before.begin(), before.end(),
                                  [&](const ActingPoint& p) { return p.point == all[k].point; });
    const bool equal = was != before.end() && was->force == all[k].force;
    equal ? ++same : ++others;
  }
  EXPECT_GT(others, 4);
  EXPECT_GT(same, 4);
}

/// Balls in flight converge before the heap does and take no part in its further iterations: they
/// move on parabolas and do not affect the heap.
TEST(ContactCgEngine, SkipsConvergedBodies) {
  Heap s(1e-6);
  Heap both(1e-6, [](Scene& scene) {
    for (int k = 0; k < 40; ++k)
      scene.add_ball("flies " + std::to_string(k), 0.1, 1.0,
                     at({5.0 + k, 5.0, 6.0}, {0.3, 0.1, 2.0}));
  });
  const double T =
      0.1;  // a heap of impacts is chaotic: residuals of 1e-6 separate the motions later
  ASSERT_TRUE(s.run(T));
  ASSERT_TRUE(both.run(T));
  for (int k = 24; k < 64; ++k) {  // up to 1e-6 of gravity
    EXPECT_LT((both.motion(k).v - Vec3(0.3, 0.1, 2.0 - 9.81 * T)).norm(), 2e-6) << k;
    EXPECT_NEAR(both.motion(k).r.z(), 6.0 + 2.0 * T - 0.5 * 9.81 * T * T, 2e-7) << k;
  }
  for (int b = 0; b < 24; ++b) EXPECT_LT((both.motion(b).r - s.motion(b).r).norm(), 1e-6) << b;
}

/// Joints of the heap: neighbours fixed to each other, one body on the ground, two with a spring,
/// and a hinged flap that balls hit.
void add_joints(Scene& s) {
  s.add_joint("spherical", 0, 3, {0.13, 0.255, 0.14});
  s.add_joint("revolute", 7, 10, place(7));
  s.add_joint("fixed", 12, 13, place(12));
  s.add_joint("fixed", 12, 13, place(13));  // redundant
  s.add_joint("spherical", kGround, 23, {0.6, 0.4, 1.2});
  const int flap = s.add_box("flap", {0.3, 0.02, 0.1}, 0.5, at({0.35, 0.7, 0.4}));
  s.add_joint("revolute", kGround, flap, {0.5, 0.7, 0.4});
}

TEST(ContactCgEngine, AgreesWithTheDirectEngineForAHeapWithJoints) {
  for (const double dt : {2e-3, 2e-4}) {
    Heap iterative(1e-9, add_joints, dt), direct(0.0, add_joints, dt);
    ASSERT_TRUE(iterative.run(0.1)) << iterative.last.text();
    ASSERT_TRUE(direct.run(0.1)) << direct.last.text();
    for (int b = 0; b < 25; ++b)
      EXPECT_LT((iterative.motion(b).r - direct.motion(b).r).norm(), 1e-6) << b << " at " << dt;
  }
}

TEST(ContactCgEngine, HoldsJointsToRoundOffAndNeverGainsEnergy) {
  Heap s(1e-8, add_joints);
  double energy = s.energy(), rise = 0.0, open = 0.0;
  for (int k = 0; k < 300; ++k) {
    ASSERT_TRUE(s.step()) << s.last.text();
    rise = std::max(rise, s.energy() - energy);
    open = std::max(open, s.last.constraints.residual);
    energy = s.energy();
  }
  const Ledger& l = s.state.ledger;
  EXPECT_LT(rise, 1e-11 * l.energy_scale);
  EXPECT_LT(open, 1e-14);  // positions of some 1 m
  EXPECT_LT(l.p_drift, 1e-6 * l.p_scale);
  EXPECT_LT(l.l_drift, 1e-6 * l.l_scale);
}

/// Pendulum beside a flying ball: without contact a joint is as exact as the residual, so its
/// energy and angular velocity satisfy the energy integral.
TEST(ContactCgEngine, PendulumBesideBallsKeepsItsEnergy) {
  for (const double dt : {1e-2, 1e-3, 1e-4}) {
    Scene s;
    s.cg_residual = 1e-10;
    const int bob = s.add_ball("bob", 0.1, 1.0, at({1.0, 0.0, 0.0}));
    s.add_ball("ball", 0.1, 1.0, at({0.0, 3.0, 0.0}));
    s.add_joint("spherical", kGround, bob, {0.0, 0.0, 0.0});
    s.begin(dt);
    ASSERT_TRUE(s.run(0.5)) << s.last.text();
    const Vec3 r = s.motion(bob).r, v = s.motion(bob).v;
    EXPECT_NEAR(r.norm(), 1.0, 1e-14);
    // ½ (m l² + J) ω² = m g h, J = 2/5 m (0.1 m)²
    EXPECT_NEAR(0.5 * 1.004 * v.squaredNorm(), -9.81 * r.z(), dt * dt * 100.0) << dt;
    EXPECT_LT(s.drift(), 1e-9 * s.state.ledger.energy_scale);
  }
}

TEST(ContactCgEngine, RefusesDeformableSolids) {
  Scene s;
  s.cg_residual = 1e-6;
  const int ball = s.add_ball("ball", 0.1, 1.0, at({0.0, 0.0, 0.5}));
  s.add_bar(ball, {.from = {0.05, 0.0, 0.0}});
  EXPECT_THROW(s.begin(1e-3), InputError);
}

}  // namespace
}  // namespace polhode::contact_cg_engine_tests
