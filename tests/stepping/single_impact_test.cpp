// SPDX-License-Identifier: Apache-2.0
// Impacts at a single point: closed forms in a plane, small increments of the impulse in space.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include <polhode/stepping/single_impact.hpp>

#include "support/random_steps.hpp"

namespace polhode::single_impact_tests {
namespace {

using test::Random;

/// K of a rod of unit mass and length 2 that touches with its end, tilted by an angle against the
/// horizontal: normal, tangent in its plane, tangent across.
Mat3 mobility_of_rod(double angle) {
  const Vec3 r(-std::sin(angle), -std::cos(angle), 0.0);  // from the centre to the end: n, t, c
  const double J = 1.0 / 3.0;
  Mat3 skew;
  skew << 0.0, -r.z(), r.y(), r.z(), 0.0, -r.x(), -r.y(), r.x(), 0.0;
  return Mat3::Identity() - skew * skew / J;
}

/// Routh's equations by small equal increments of the normal impulse, with friction that ends the
/// slip of each increment or has its full size.
SingleImpactEnd by_increments(const SingleImpact& law, double increment) {
  SingleImpactEnd end{Vec3::Zero(), law.velocity};
  const Mat3& K = law.mobility;
  const Eigen::Matrix2d tangents = K.bottomRightCorner<2, 2>();
  double stored = law.stored;
  bool turned = false;
  while (true) {
    if (!turned && end.velocity.x() >= 0.0) {
      turned = true;
      stored *= law.restitution * law.restitution;
    }
    if (turned && stored <= law.kept) return end;
    Vec3 p(increment, 0.0, 0.0);
    const Eigen::Vector2d slip = (end.velocity + K * p).tail<2>();
    Eigen::Vector2d f = -tangents.ldlt().solve(slip);
    if (f.norm() > law.mu * increment) {  // towards the slip that is left, by iteration
      for (int k = 0; k < 50; ++k) {
        const Eigen::Vector2d left = slip + tangents * f;
        f = f - left / tangents.trace();
        if (f.norm() > law.mu * increment) f *= law.mu * increment / f.norm();
      }
    }
    p.tail<2>() = f;
    const Vec3 before = end.velocity;
    end.velocity += K * p;
    end.impulse += p;
    stored -= 0.5 * increment * (before.x() + end.velocity.x());
  }
}

// @tests{routh}
TEST(SingleImpact, FollowsNewtonAndCoulombForASphere) {
  Mat3 K = Mat3::Zero();
  K.diagonal() << 1.0, 3.5, 3.5;
  for (const double e : {0.0, 0.3, 0.7, 1.0})
    for (const double mu : {0.0, 0.1, 0.5}) {
      const Vec3 v(-2.0, 3.0, -4.0);
      const SingleImpactEnd end = end_of({K, v, mu, mu, e});
      const double p = 2.0 * (1.0 + e), has_friction = std::min(mu * p, 5.0 / 3.5);
      EXPECT_NEAR(end.impulse.x(), p, 1e-14);
      EXPECT_NEAR(end.impulse.y(), -0.6 * has_friction, 1e-14);
      EXPECT_NEAR(end.impulse.z(), 0.8 * has_friction, 1e-14);
      EXPECT_NEAR(end.velocity.x(), 2.0 * e, 1e-14);
      EXPECT_LT((end.velocity - v - K * end.impulse).norm(), 1e-13);
    }
}

/// Slips of a rod's end in its plane: constant accelerations by the normal impulse between the end
/// of the first slip, the end of compression and that of restitution, whose order decides.
/// (Y. Wang and M. T. Mason, J. Appl. Mech. 59 (1992) 635-642.)
// @tests{routh}
TEST(SingleImpact, FollowsSlipThatStopsSticksOrReverses) {
  int sticks = 0, turns = 0, slides = 0;
  for (const double angle : {0.3, 0.6, 0.9, 1.2, 1.9, 2.3})
    for (const double mu : {0.05, 0.2, 0.5, 0.9})
      for (const double slip : {0.1, 0.7, 3.0})
        for (const double e : {0.0, 0.5, 1.0}) {
          const Mat3 K = mobility_of_rod(angle);
          const double w = 1.3, n = K(0, 0), b = K(0, 1), t = K(1, 1);
          double f = -mu;
          double rate_n = n + f * b, rate_t = b + f * t;
          const double p_slip = rate_t < 0.0 ? -slip / rate_t : 1e300;
          // Normal velocity over the impulse: two straight lines.
          const double held = std::abs(b / t) <= mu ? -b / t : std::copysign(mu, -b);
          const double rate_2 = n + held * b;
          const auto v = [&](double p) {
            return -w + rate_n * std::min(p, p_slip) + rate_2 * std::max(0.0, p - p_slip);
          };
          const auto root = [&](const auto& left) {
            double low = 0.0, high = 1.0;
            while (left(high)) high *= 2.0;
            for (int k = 0; k < 200; ++k)
              (left(0.5 * (low + high)) ? low : high) = 0.5 * (low + high);
            return low;
          };
          const double p_c = root([&](double p) { return v(p) < 0.0; });
          const auto work = [&](double p) {  // of the normal force, exact on straight lines
            const double x = std::min(p, p_slip), y = std::max(0.0, p - p_slip);
            return 0.5 * x * (-w + v(x)) + 0.5 * y * (v(x) + v(p));
          };
          const double W = work(p_c);
          const double p_end =
              e == 0.0 ? p_c
                       : root([&](double p) { return p < p_c || work(p) < (1.0 - e * e) * W; });
          const double friction =
              -mu * std::min(p_end, p_slip) + held * std::max(0.0, p_end - p_slip);
          const SingleImpactEnd end = end_of({K, Vec3(-w, slip, 0.0), mu, mu, e});
          EXPECT_NEAR(end.impulse.x(), p_end, 1e-9)
              << angle << ' ' << mu << ' ' << slip << ' ' << e;
          EXPECT_NEAR(end.impulse.y(), friction, 1e-9);
          EXPECT_NEAR(end.impulse.z(), 0.0, 1e-14);
          slides += p_slip > p_end;
          sticks += p_slip < p_end && std::abs(b / t) <= mu;
          turns += p_slip < p_end && std::abs(b / t) > mu;
        }
  EXPECT_GT(slides, 20);
  EXPECT_GT(sticks, 20);
  EXPECT_GT(turns, 10);
}

// @tests{routh}
TEST(SingleImpact, FollowsSlipAlongItsCurveInSpace) {
  Random random(11);
  for (int trial = 0; trial < 20; ++trial) {
    const Vec3 r = 0.3 * random.vector();
    Vec3 inertia(0.01, 0.02, 0.025);
    const Mat3 R = random.frame();
    Mat3 skew;
    skew << 0.0, -r.z(), r.y(), r.z(), 0.0, -r.x(), -r.y(), r.x(), 0.0;
    const Mat3 K =
        Mat3::Identity() - skew * R * inertia.cwiseInverse().asDiagonal() * R.transpose() * skew;
    const double e = 0.25 * (trial % 5), mu = trial % 2 ? 0.15 : 0.6;
    const Vec3 v(-1.5, 1.0 + 0.1 * trial, -0.8);
    const SingleImpactEnd end = end_of({K, v, mu, mu, e});
    EXPECT_LT((end.velocity - v - K * end.impulse).norm(), 1e-9);
    EXPECT_LE(end.impulse.tail<2>().norm(), mu * end.impulse.x() * (1.0 + 1e-9));
    EXPECT_LE(end.impulse.dot(v + end.velocity), 1e-12);
    const double far = (by_increments({K, v, mu, mu, e}, 4e-4).impulse - end.impulse).norm();
    const double near = (by_increments({K, v, mu, mu, e}, 1e-4).impulse - end.impulse).norm();
    EXPECT_LT(far, 6e-3) << trial;
    EXPECT_LT(near, 1.5e-3) << trial;
  }
}

/// A slip that ends and resumes in the plane, with round-off across it: the search for its
/// direction starts in the plane and ends there.
TEST(SingleImpact, ResumesSlipInThePlaneDespiteRoundOff) {
  SingleImpact s;
  s.mu = s.mu_across = 0.5;
  s.restitution = 0.3;
  for (const double noise : {0.0, -4.4e-16, 4.4e-16, -1e-12})
    for (const double other : {0.0, -5.5e-17, 1e-17}) {
      s.mobility << 3.4358, 1.17189, noise, 1.17189, 1.56381, other, noise, other, 3.75065;
      s.velocity = {-2.0, -1.0, 0.0};
      const SingleImpactEnd end = end_of(s);
      // Slip ends at p = 1/(K₁₀ + μ K₁₁), then resumes the other way.
      const double p = 1.0 / (1.17189 + 0.5 * 1.56381);
      EXPECT_NEAR(end.impulse[1], 0.5 * p - 0.5 * (end.impulse[0] - p), 1e-9) << noise;
      EXPECT_GT(end.velocity[1], 0.0) << noise;
      EXPECT_NEAR(end.impulse[2], 0.0, 1e-9) << noise;
    }
}

/// A slip that is slow relative to the approach, at the corner of a box: it needs no more steps
/// than others.
// @tests{routh}
TEST(SingleImpact, FollowsSlowSlip) {
  Mat3 K;
  K << 3.1, 0.9, -0.3, 0.9, 2.4, 0.2, -0.3, 0.2, 2.9;
  for (const double slip : {1e-1, 1e-4, 1e-8}) {
    const SingleImpact impact{K, Vec3(-1.5, -0.8 * slip, 0.6 * slip), 0.2, 0.2, 0.8};
    const SingleImpactEnd end = end_of(impact);
    EXPECT_GT(end.velocity.x(), 0.0);
    EXPECT_LT((by_increments(impact, 1e-4).impulse - end.impulse).norm(), 1.5e-3) << slip;
  }
}

/// An impact in parts equals the whole one: e² of the energy stored at the end of compression is
/// returned.
// @tests{routh}
TEST(SingleImpact, ContinuesFromStoredEnergy) {
  Mat3 K = Mat3::Zero();
  K.diagonal() << 0.5, 2.0, 2.0;
  const double w = 2.0, e = 0.6, whole = 0.5 * w * w / 0.5;
  const double stored = 0.3 * whole, kept = e * e * 0.2 * whole;
  const SingleImpactEnd end =
      end_of({K, Vec3(-w * std::sqrt(0.7), 0.1, 0.0), 0.2, 0.2, e, stored, kept});
  EXPECT_NEAR(end.velocity.x(), e * w * std::sqrt(0.8), 1e-13);
}

}  // namespace
}  // namespace polhode::single_impact_tests
