// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include <polhode/contact/closed_form_point.hpp>

#include "support/random_steps.hpp"

namespace polhode::closed_form_point_tests {
namespace {

using namespace contact;
using test::Random;

/// A ball of a over a ball or a plane of b, within the search radius at both ends of the step.
struct Case {
  geometry::Shape a, b;
  PointData data;
  BodyStep step_a, step_b;
  StepContext context;

  Case(unsigned seed, bool plane_below) {
    Random random(seed);
    a = geometry::sphere("a", 0.4, {0.1 * random.vector(), Mat3::Identity()});
    b = plane_below ? geometry::plane({0.1 * random.vector(), random.frame()})
                    : geometry::sphere("b", 0.6, {0.1 * random.vector(), Mat3::Identity()});
    context.dt = 1e-2;
    context.ga = GeneralizedAlpha::from_spectral_radius(1.0);
    BodyMotion at_a = random.motion(), at_b = random.motion();
    const Vec3 n = plane_below ? Vec3(at_b.q * b.axes.col(2)) : random.direction();
    // The centres 0.2 or 0.5 apart along n, less half the tolerance.
    const double apart = (plane_below ? 0.2 : 0.5) - 5e-4;
    at_a.r = at_b.r + at_b.q * b.centre + apart * n - at_a.q * a.corners[0];
    step_a = newmark_step(at_a, 1e-4 * random.vector(), 1e-3 * random.vector(), context);
    step_b = newmark_step(at_b, 1e-4 * random.vector(), 1e-3 * random.vector(), context);
    data.a = &a;
    data.b = &b;
    data.normal.tolerance = 2e-3;
    data.normal.stiffness = 3e4;
    data.friction.mu = 0.05 + 0.3 * std::abs(random.number());
    data.friction.stiffness = 2e4;
    data.friction.damping = 30.0;
    data.length = 0.2;
    data.history.bristle = 1e-4 * random.vector();
    data.history.normal = (n + 0.01 * random.vector()).normalized();
    data.end_share = seed % 2 == 0 ? 0.5 : 0.0;
  }
};

TEST(ClosedFormPoint, AgreesWithTheGeneralFormulas) {
  for (unsigned seed = 1; seed <= 40; ++seed)
    for (const bool plane_below : {false, true}) {
      Case c(seed, plane_below);
      ASSERT_TRUE(is_closed_form_point(c.data));
      const auto distance = [&](const Vec3& r_a, const Mat3& L_a, const Vec3& r_b,
                                const Mat3& L_b) {
        return gap(c.data.pair, *c.data.a, *c.data.b, Placement<double>(r_a, L_a, 0),
                   Placement<double>(r_b, L_b, 6))
            .distance;
      };
      const BodyStep &a = c.step_a, &b = c.step_b;
      const double g_0 = distance(a.r_n, a.Lambda_n, b.r_n, b.Lambda_n);
      const double g_1 = closed_form_gap_n1(c.data, g_0, a, b);
      EXPECT_NEAR(g_1, distance(a.r_n1, a.Lambda_n1, b.r_n1, b.Lambda_n1), 1e-15);
      PointReport fast_report, report;
      const PointForce fast =
          closed_form_force(c.data, g_0, g_1, c.step_a, c.step_b, c.context, &fast_report);
      PairTerms terms;
      terms.set_zero();
      c.context.tangents = false;
      add_contact(c.data, c.step_a, c.step_b, c.context, terms, &report);
      const double scale = fast.force.norm();
      ASSERT_GT(scale, 0.1);
      EXPECT_LT((fast.force - terms.wrench_a.head<3>()).norm(), 1e-11 * scale);
      EXPECT_LT((fast.moment_a - terms.wrench_a.tail<3>()).norm(), 1e-11 * scale);
      EXPECT_LT((fast.moment_b - terms.wrench_b.tail<3>()).norm(), 1e-11 * scale);
      EXPECT_LT((fast_report.after.bristle - report.after.bristle).norm(), 1e-15);
      EXPECT_EQ(fast_report.after.slips, report.after.slips);
      EXPECT_NEAR(fast_report.work.stored, report.work.stored, 1e-12);
      EXPECT_NEAR(fast_report.work.dissipated, report.work.dissipated, 1e-12);
      const PointForce slow = point_force(c.data, c.step_a, c.step_b, c.context);
      EXPECT_LT((fast.C - slow.C).norm(), 1e-9 * slow.C.norm());
      EXPECT_LT((fast.arm_a - slow.arm_a).norm() + (fast.arm_b - slow.arm_b).norm(), 1e-14);
    }
}

/// Gap after motions far below the rounding of positions: it changes by their component along the
/// normal. @tests{contact-gap-change}
TEST(ClosedFormPoint, ResolvesGapChangesBelowTheRoundingOfPositions) {
  const geometry::Shape ball = geometry::sphere("ball", 0.4),
                        other = geometry::sphere("other", 0.6), floor = geometry::plane();
  const geometry::Shape block = geometry::box("block", {0.2, 0.3, 0.4}),
                        table = geometry::box("table", {2.0, 2.0, 0.4});
  struct Scene {
    const geometry::Shape *a, *b;
    int corner;
    double above;  ///< Of a over b [m].
  };
  const auto at_corner = [&](int k) { return block.corners[k].z() < 0.0; };
  int low = 0;
  while (!at_corner(low)) ++low;
  for (const Scene& scene : {Scene{&ball, &other, 0, 0.5}, Scene{&ball, &floor, 0, 0.2},
                             Scene{&block, &table, low, 0.4}}) {
    PointData data;
    data.a = scene.a;
    data.b = scene.b;
    data.pair.i = scene.corner;
    StepContext context;
    context.dt = 1e-2;
    context.ga = GeneralizedAlpha::from_spectral_radius(1.0);
    BodyMotion at_a, at_b;
    at_b.r = {20.0, 30.0, 40.0};
    if (scene.b == &floor) at_b.r = Vec3::Zero();
    at_a.r = at_b.r + Vec3(0.0, 0.0, scene.above);
    const BodyStep still = newmark_step(at_b, Vec3::Zero(), Vec3::Zero(), context);
    const auto gap = [&](double moved) {
      return gap_n1(data, 0.0, newmark_step(at_a, {0.0, 0.0, moved}, Vec3::Zero(), context), still);
    };
    const double move = 1e-5, more = 1e-18;  // a position holds steps of 7e-15 here
    EXPECT_NEAR(gap(move + more) - gap(move), more, 0.2 * more) << scene.above;
    EXPECT_NEAR(gap(move + 1e-7) - gap(move), 1e-7, 1e-16) << scene.above;
  }
}

/// The spring is the tangent without μ t dλ and without terms of rotation: both are small where
/// nothing slides and rotations are small. @tests{contact-spring}
TEST(ClosedFormPoint, HasASpringCloseToTheTangentOfAStickingContact) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    Case c(seed, seed % 2 == 0);
    c.data.friction.mu = 1e3;
    PairTerms terms;
    terms.set_zero();
    c.context.tangents = true;
    add_contact(c.data, c.step_a, c.step_b, c.context, terms);
    const PointForce f = point_force(c.data, c.step_a, c.step_b, c.context);
    const Mat3 K = -terms.D_aa.topLeftCorner<3, 3>();
    EXPECT_LT((K - f.C).norm(), 0.05 * f.C.norm()) << seed;
    EXPECT_LT((f.C - f.C.transpose()).norm(), 1e-12 * f.C.norm());
    EXPECT_GE(Eigen::SelfAdjointEigenSolver<Mat3>(f.C).eigenvalues()[0], -1e-9 * f.C.norm());
  }
}

}  // namespace
}  // namespace polhode::closed_form_point_tests
