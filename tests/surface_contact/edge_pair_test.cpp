// SPDX-License-Identifier: Apache-2.0
// Contact of two crossing edges over one step.
#include <gtest/gtest.h>

#include <cmath>

#include <polhode/surface_contact/edge_pair.hpp>
#include <support/derivative.hpp>
#include <support/meeting_forces.hpp>
#include <support/random_steps.hpp>

namespace polhode::test::edge_pair_tests {
namespace {

constexpr double kTolerance = 0.2;

surface_contact::SurfaceLaw law(double mu, double end_share = 0.0) {
  return soft_law(kTolerance, mu, end_share);
}

enum class Place { crossing, end_over_edge, ends, nearly_parallel };

struct Scene {
  surface_contact::FourMoves moves;
  surface_contact::EdgePairData data;
  double alpha = 0.5;
  bool conserving = true;

  [[nodiscard]] surface_contact::EdgePair pair(const surface_contact::SurfaceLaw& law) const {
    return {moves, data, law, alpha, conserving};
  }
  void move(int k, double by) {
    moves.x_n1[k / 3][k % 3] += by;
    moves.u[k / 3][k % 3] += by;
  }
};

Scene scene(Place place, unsigned seed, double way, double alpha = 0.5) {
  Random random(seed);
  Scene s;
  s.alpha = alpha;
  const double angle = place == Place::nearly_parallel ? 0.11 : 1.2;
  const double along = place == Place::crossing || place == Place::nearly_parallel ? 0.4 : 1.05;
  const double across = place == Place::ends ? 1.04 : 0.5;
  const Vec3 e(1.0, 0.0, 0.0), f(std::cos(angle), std::sin(angle), 0.0);
  const Vec3 from_e = -along * e + Vec3(0.0, 0.0, 0.22), from_f = -across * f;
  const Vec3 x[4] = {from_e, from_e + e, from_f, from_f + f};
  const Quat turn = random.orientation();
  const Vec3 shift = random.vector(3.0);
  for (int k = 0; k < 4; ++k) {
    s.moves.u[k] = random.vector(way);
    const double rough = place == Place::nearly_parallel ? 0.01 : 0.05;
    s.moves.x_n1[k] = turn * (x[k] + random.vector(rough)) + shift + s.moves.u[k];
  }
  const double shared[4] = {0.0, 0.5, 0.5, 2.0 / 3.0};
  std::copy_n(shared, 4, s.data.shared);
  s.data.squares = 1.1;
  s.data.centre = kTolerance;
  return s;
}

double at_instant(const Scene& s, const surface_contact::SurfaceLaw& law, bool end) {
  Scene still = s;
  for (int k = 0; k < 4; ++k) {
    if (!end) still.moves.x_n1[k] -= s.moves.u[k];
    still.moves.u[k].setZero();
  }
  return surface_contact::EdgePair(still.moves, s.data, law, 1.0, true).stored();
}

const Place kPlaces[] = {Place::crossing, Place::end_over_edge, Place::ends,
                         Place::nearly_parallel};

// @tests{edge-potential}
TEST(EdgePair, HasTheTangentOfItsForces) {
  for (const Place place : kPlaces)
    for (const double alpha : {0.5, 0.66})
      for (const unsigned seed : {1U, 2U, 3U, 4U}) {
        SCOPED_TRACE(testing::Message() << static_cast<int>(place) << " " << alpha << " " << seed);
        const Scene s = scene(place, seed, 0.05, alpha);
        const surface_contact::SurfaceLaw l = law(0.0, 0.3);
        const surface_contact::EdgePair pair = s.pair(l);
        ASSERT_TRUE(pair.acts());
        ASSERT_GT(pair.force().norm(), 1e-3);
        const auto moved = [&](const Vec& d) {
          Scene to = s;
          for (int k = 0; k < 12; ++k) to.move(k, d[k]);
          return to;
        };
        expect_derivative(
            pair.stiffness(), [&](const Vec& d) -> Vec { return moved(d).pair(l).force(); },
            "edges", 1e-6, 1e-6);
        expect_derivative(
            pair.pressure_slope().transpose(),
            [&](const Vec& d) -> Vec { return Vec::Constant(1, moved(d).pair(l).pressure()); },
            "pressure", 1e-6, 1e-6);
      }
}

TEST(EdgePair, DoesExactlyTheWorkItStoresAndKeepsMomenta) {
  int acting = 0;
  for (const Place place : kPlaces)
    for (const double way : {0.02, 0.1, 0.4})
      for (const unsigned seed : {1U, 2U, 3U, 4U, 5U}) {
        SCOPED_TRACE(testing::Message() << static_cast<int>(place) << " " << way << " " << seed);
        const Scene s = scene(place, seed, way);
        const surface_contact::SurfaceLaw l = law(0.0);
        const surface_contact::EdgePair pair = s.pair(l);
        if (!pair.acts()) continue;
        ++acting;
        const surface_contact::EdgePair::Force f = pair.force();
        double work = 0.0;
        Vec3 sum = Vec3::Zero(), moment = Vec3::Zero(), x[4];
        s.moves.at(0.5, x);
        for (int k = 0; k < 4; ++k) {
          const Vec3 one = f.segment<3>(3 * k);
          work += one.dot(s.moves.u[k]);
          sum += one;
          moment += x[k].cross(one);
        }
        const double scale = 1.0 + f.norm();
        EXPECT_NEAR(work, at_instant(s, l, false) - at_instant(s, l, true), 1e-12 * scale);
        EXPECT_NEAR(pair.stored(), at_instant(s, l, true), 1e-13 * scale);
        EXPECT_NEAR(pair.dissipated(), 0.0, 1e-12 * scale);
        EXPECT_LT(sum.norm(), 1e-12 * scale);
        EXPECT_LT(moment.norm(), 1e-11 * scale);
      }
  EXPECT_GT(acting, 30);
}

// @tests{edge-friction}
TEST(EdgePair, HasFrictionWithoutResultantThatDissipatesItsWork) {
  for (const Place place : {Place::crossing, Place::end_over_edge, Place::ends})
    for (const double mu : {0.05, 50.0})
      for (const unsigned seed : {1U, 2U, 3U, 4U}) {
        SCOPED_TRACE(testing::Message() << static_cast<int>(place) << " " << mu << " " << seed);
        const Scene s = scene(place, seed, 0.05);
        const surface_contact::SurfaceLaw l = law(mu);
        const surface_contact::EdgePair pair = s.pair(l);
        ASSERT_GT(pair.pressure(), 0.0);
        const Vec3 kept = Random(seed + 7).vector(0.03);
        const surface_contact::FourSlide slide = pair.slide(kept, true);
        double work = 0.0;
        Vec3 sum = Vec3::Zero(), moment = Vec3::Zero(), x[4];
        s.moves.at(0.5, x);
        for (int k = 0; k < 4; ++k) {
          const Vec3 one = slide.force.segment<3>(3 * k);
          work += one.dot(s.moves.u[k]);
          sum += one;
          moment += x[k].cross(one);
        }
        EXPECT_NEAR(work, slide.friction.dot(slide.slid), 1e-13);
        EXPECT_LT(sum.norm(), 1e-13);
        EXPECT_LT(moment.norm(), 1e-12);
        EXPECT_EQ(slide.slips, mu < 1.0);
        const auto moved = [&](const Vec& d) {
          Scene to = s;
          for (int k = 0; k < 12; ++k) to.move(k, d[k]);
          return to;
        };
        const Mat K = slide.K + slide.by_pressure * pair.pressure_slope().transpose();
        expect_derivative(
            K, [&](const Vec& d) -> Vec { return moved(d).pair(l).slide(kept, false).force; },
            "friction of edges", 1e-6, 1e-6);
      }
}

TEST(EdgePair, DoesNotSlipInRigidRotations) {
  Scene s = scene(Place::crossing, 3, 0.0);
  const Quat half = quaternion_from_rotation_vector(Vec3(2e-4, -1e-4, 3e-4));
  Vec3 middle[4];
  s.moves.at(0.0, middle);
  for (int k = 0; k < 4; ++k) {
    const Vec3 x_n = half.conjugate() * middle[k];
    s.moves.x_n1[k] = half * middle[k];
    s.moves.u[k] = s.moves.x_n1[k] - x_n;
  }
  const surface_contact::SurfaceLaw l = law(1.0);
  const surface_contact::FourSlide slide = s.pair(l).slide(Vec3::Zero(), false);
  EXPECT_LT(slide.slid.norm(), 1e-10);
  // The second edge moves along itself, so its material slides over the nearest point of the first
  // one.
  const Vec3 draw = 1e-3 * (middle[3] - middle[2]).normalized();
  for (int k = 2; k < 4; ++k) s.moves.u[k] += draw, s.moves.x_n1[k] += draw;
  EXPECT_LT((s.pair(l).slide(Vec3::Zero(), false).slid + draw).norm(), 1e-6);
}

}  // namespace
}  // namespace polhode::test::edge_pair_tests
