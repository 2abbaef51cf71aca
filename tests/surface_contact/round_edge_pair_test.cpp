// SPDX-License-Identifier: Apache-2.0
// Contact of two pieces of cables over one step: crossing, parallel, and in between.
#include <gtest/gtest.h>

#include <cmath>

#include <polhode/surface_contact/edge_pair.hpp>
#include <support/derivative.hpp>
#include <support/meeting_forces.hpp>
#include <support/random_steps.hpp>

namespace polhode::test::round_edge_pair_tests {
namespace {

constexpr double kRadii = 0.2, kTolerance = 0.04;

surface_contact::SurfaceLaw law(double mu, double end_share = 0.0) {
  return soft_law(kTolerance, mu, end_share);
}

enum class Place { crossing, between, along, against, end_over_edge };
const Place kPlaces[] = {Place::crossing, Place::between, Place::along, Place::against,
                         Place::end_over_edge};

struct Scene {
  surface_contact::FourMoves moves;
  surface_contact::EdgePairData data;
  double alpha = 0.5;

  [[nodiscard]] surface_contact::EdgePair pair(const surface_contact::SurfaceLaw& law) const {
    return {moves, data, law, alpha, true};
  }
  void move(int k, double by) {
    moves.x_n1[k / 3][k % 3] += by;
    moves.u[k / 3][k % 3] += by;
  }
};

surface_contact::EdgePairData data() {
  surface_contact::EdgePairData d;
  const double shared[4] = {0.0, 0.5, 0.5, 0.5};
  std::copy_n(shared, 4, d.shared);
  d.squares = 1.0;
  d.centre = kRadii;
  d.retreat = 6.0 * kTolerance;
  d.behind = 2.0 * kTolerance;
  d.points[0] = {3, 0.4};
  d.points[1] = {4, 0.3};
  return d;
}

Scene scene(Place place, unsigned seed, double way, double alpha = 0.5) {
  Random random(seed);
  Scene s;
  s.alpha = alpha;
  s.data = data();
  const double angle = place == Place::between ? 0.15 : place == Place::along ? 0.02 : 1.2;
  const double height = place == Place::between ? 0.155 : 0.13;
  const double shift_e = place == Place::end_over_edge ? 1.02 : 0.4;
  const Vec3 e(1.0, 0.0, 0.0);
  Vec3 f(std::cos(angle), std::sin(angle), 0.0);
  if (place == Place::against) f = Vec3(-std::cos(0.02), std::sin(0.02), 0.0);
  const Vec3 up(0.0, 0.0, place == Place::crossing || place == Place::end_over_edge ? 0.2 : height);
  const Vec3 from_e = -shift_e * e + up, from_f = -0.5 * f;
  const Vec3 x[4] = {from_e, from_e + e, from_f, from_f + f};
  const Quat turn = random.orientation();
  const Vec3 shift = random.vector(3.0);
  for (int k = 0; k < 4; ++k) {
    s.moves.u[k] = random.vector(way);
    s.moves.x_n1[k] = turn * (x[k] + random.vector(0.004)) + shift + s.moves.u[k];
  }
  return s;
}

double stored(const Scene& s, const surface_contact::SurfaceLaw& law, bool end) {
  Scene still = s;
  for (int k = 0; k < 4; ++k) {
    if (!end) still.moves.x_n1[k] -= s.moves.u[k];
    still.moves.u[k].setZero();
  }
  return surface_contact::EdgePair(still.moves, s.data, law, 1.0, true).stored();
}

struct Resultant {
  double work = 0.0;
  Vec3 sum = Vec3::Zero(), moment = Vec3::Zero();
  Resultant(const Scene& s, const Eigen::VectorXd& f) {
    Vec3 x[4];
    s.moves.at(0.5, x);
    for (int k = 0; k < 4; ++k) {
      const Vec3 one = f.segment<3>(3 * k);
      work += one.dot(s.moves.u[k]);
      sum += one;
      moment += x[k].cross(one);
    }
  }
};

// @tests{cable-pair}
TEST(RoundEdgePair, HasTheTangentOfItsForces) {
  for (const Place place : kPlaces)
    for (const double alpha : {0.5, 0.66})
      for (const unsigned seed : {1U, 2U, 3U}) {
        SCOPED_TRACE(testing::Message() << static_cast<int>(place) << " " << alpha << " " << seed);
        const Scene s = scene(place, seed, 0.01, alpha);
        const surface_contact::SurfaceLaw l = law(0.0, 0.3);
        const surface_contact::EdgePair pair = s.pair(l);
        ASSERT_GT(pair.force().norm(), 1e-3);
        const auto moved = [&](const Vec& d) {
          Scene to = s;
          for (int k = 0; k < 12; ++k) to.move(k, d[k]);
          return to;
        };
        expect_derivative(
            pair.stiffness(), [&](const Vec& d) -> Vec { return moved(d).pair(l).force(); },
            "round edges", 1e-6, 1e-6);
        expect_derivative(
            pair.pressure_slope().transpose(),
            [&](const Vec& d) -> Vec {
              return Vec::Constant(1, moved(d).pair(l).pressure_across());
            },
            "pressure", 1e-6, 1e-6);
      }
}

TEST(RoundEdgePair, DoesExactlyTheWorkItStoresAndKeepsMomenta) {
  int count = 0;
  for (const Place place : kPlaces)
    for (const double way : {0.005, 0.02, 0.2})
      for (const unsigned seed : {1U, 2U, 3U, 4U, 5U}) {
        SCOPED_TRACE(testing::Message() << static_cast<int>(place) << " " << way << " " << seed);
        const Scene s = scene(place, seed, way);
        const surface_contact::SurfaceLaw l = law(0.0);
        const surface_contact::EdgePair pair = s.pair(l);
        if (!pair.acts()) continue;
        const double e_n = stored(s, l, false), e_n1 = stored(s, l, true);
        if (!std::isfinite(e_n) || !std::isfinite(e_n1)) continue;  // beyond the barrier
        ++count;
        const Resultant r(s, pair.force());
        const double scale = 1.0 + pair.force().norm();
        EXPECT_NEAR(r.work, e_n - e_n1, 1e-11 * scale);
        EXPECT_NEAR(pair.dissipated(), 0.0, 1e-11 * scale);
        EXPECT_LT(r.sum.norm(), 1e-12 * scale);
        EXPECT_LT(r.moment.norm(), 1e-11 * scale);
      }
  EXPECT_GT(count, 40);
}

/// Choice of the two potentials: for crossing edges the potential of points is zero, although
/// points are as near.
TEST(RoundEdgePair, UsesEdgesWhereTheyCrossAndPointsElsewhere) {
  const surface_contact::SurfaceLaw l = law(0.0);
  const auto along = [&](const surface_contact::EdgePair& p) {
    return p.pressure() - p.pressure_across();
  };
  const Scene cross = scene(Place::crossing, 1, 0.0), lies = scene(Place::along, 1, 0.0),
              between = scene(Place::between, 1, 0.0);
  EXPECT_GT(cross.pair(l).pressure_across(), 0.1);
  EXPECT_EQ(along(cross.pair(l)), 0.0);
  EXPECT_EQ(lies.pair(l).pressure_across(), 0.0);
  EXPECT_GT(along(lies.pair(l)), 0.1);
  EXPECT_GT(between.pair(l).pressure_across(), 0.1);
  EXPECT_GT(along(between.pair(l)), 0.01);
}

/// Continuity of the energy from parallel to crossing lines: in a rotation with four times smaller
/// steps its changes are four times smaller.
TEST(RoundEdgePair, HasContinuousEnergyAsItTurns) {
  const surface_contact::SurfaceLaw l = law(0.0);
  const auto energy = [&](double angle) {
    Scene s = scene(Place::crossing, 1, 0.0);
    const Vec3 f(std::cos(angle), std::sin(angle), 0.0);
    const Vec3 x[4] = {{-0.4, 0.0, 0.165}, {0.6, 0.0, 0.165}, -0.5 * f, 0.5 * f};
    std::copy_n(x, 4, s.moves.x_n1);
    return s.pair(l).stored();
  };
  const auto largest_step = [&](int count) {
    double most = 0.0;
    for (int k = 0; k < count; ++k)
      most = std::max(
          most, std::abs(energy(0.3 * (k + 1) / count - 0.05) - energy(0.3 * k / count - 0.05)));
    return most;
  };
  EXPECT_NEAR(largest_step(2000) / largest_step(8000), 4.0, 0.1);
}

/// Contact of a point with a line of edges: it counts once at every position, also over the nodes.
TEST(RoundEdgePair, CountsAPointOnceAlongAStraightLineOfEdges) {
  const surface_contact::SurfaceLaw l = law(0.0);
  const auto energy = [&](double shift) {
    double sum = 0.0;
    for (int f = 0; f < 5; ++f) {
      Scene s;
      s.data = data();
      std::fill_n(s.data.shared, 4, 0.5);
      s.data.points[1].parts = 0;
      const double at = f - 2.0 + shift;
      const Vec3 x[4] = {{0.0, 0.0, 0.1}, {1.0, 0.0, 0.1}, {at, 0.0, 0.0}, {at + 1.0, 0.0, 0.0}};
      for (int k = 0; k < 4; ++k) s.moves.x_n1[k] = x[k], s.moves.u[k].setZero();
      sum += s.pair(l).stored();
    }
    return sum;
  };
  const double once = energy(0.0);
  EXPECT_GT(once, 0.0);
  for (const double shift : {0.01, 0.1, 0.2, 1.0 / 3.0, 0.49, 0.77})
    EXPECT_NEAR(energy(shift), once, 1e-12 * once) << shift;
}

// @tests{cable-along}
TEST(RoundEdgePair, HasFrictionWithoutResultantAlongEdges) {
  for (const Place place : {Place::between, Place::along, Place::against})
    for (const double mu : {0.002, 50.0})
      for (const unsigned seed : {1U, 2U, 3U}) {
        SCOPED_TRACE(testing::Message() << static_cast<int>(place) << " " << mu << " " << seed);
        const Scene s = scene(place, seed, 0.01);
        const surface_contact::SurfaceLaw l = law(mu);
        const surface_contact::EdgePair pair = s.pair(l);
        const surface_contact::LineSlide slide = pair.slide_along(0.002, true);
        ASSERT_NE(slide.friction, 0.0);
        const Resultant r(s, slide.force);
        EXPECT_NEAR(r.work, slide.friction * slide.slid, 1e-13);
        EXPECT_LT(r.sum.norm(), 1e-13);
        EXPECT_LT(r.moment.norm(), 1e-12);
        EXPECT_EQ(slide.slips, mu < 1.0);
        const double along = pair.pressure() - pair.pressure_across();
        EXPECT_LE(std::abs(slide.friction), mu * along * (1.0 + 1e-12));
        const auto moved = [&](const Vec& d) {
          Scene to = s;
          for (int k = 0; k < 12; ++k) to.move(k, d[k]);
          return to;
        };
        expect_derivative(
            slide.K,
            [&](const Vec& d) -> Vec { return moved(d).pair(l).slide_along(0.002, false).force; },
            "friction along", 1e-6, 1e-6);
      }
}

TEST(RoundEdgePair, HasFrictionWithoutResultantWhereEdgesCross) {
  for (const double angle : {0.2, 0.3, 0.45, 1.2})
    for (const double mu : {0.002, 50.0})
      for (const unsigned seed : {1U, 2U, 3U}) {
        SCOPED_TRACE(testing::Message() << angle << " " << mu << " " << seed);
        Random random(seed);
        Scene s;
        s.data = data();
        const Vec3 e(1.0, 0.0, 0.0), f(-std::cos(angle), std::sin(angle), 0.0);
        const Vec3 from(-0.45, 0.0, 0.185);
        const Vec3 x[4] = {from, from + e, -0.5 * f, 0.5 * f};
        for (int k = 0; k < 4; ++k) {
          s.moves.u[k] = random.vector(0.01);
          s.moves.x_n1[k] = x[k] + random.vector(0.003) + s.moves.u[k];
        }
        const surface_contact::SurfaceLaw l = law(mu);
        const surface_contact::EdgePair pair = s.pair(l);
        ASSERT_GT(pair.pressure_across(), 0.0);
        const Vec3 kept = random.vector(0.003);
        const surface_contact::FourSlide slide = pair.slide(kept, true);
        const Resultant r(s, slide.force);
        EXPECT_NEAR(r.work, slide.friction.dot(slide.slid), 1e-12);
        EXPECT_LT(r.sum.norm(), 1e-12);
        EXPECT_LT(r.moment.norm(), 1e-11);
        EXPECT_EQ(slide.slips, mu < 1.0);
        const auto moved = [&](const Vec& d) {
          Scene to = s;
          for (int k = 0; k < 12; ++k) to.move(k, d[k]);
          return to;
        };
        const Mat K = slide.K + slide.by_pressure * pair.pressure_slope().transpose();
        expect_derivative(
            K, [&](const Vec& d) -> Vec { return moved(d).pair(l).slide(kept, false).force; },
            "friction across", 1e-6, 1e-6);
      }
}

/// Slip of an edge that moves along itself: its displacement, for any direction of the other edge.
/// An edge that rolls around the other one does not slip.
TEST(RoundEdgePair, SlipsByTheAxialDisplacementAndRollsFreely) {
  for (const Place place : {Place::along, Place::against}) {
    Scene s = scene(place, 4, 0.0);
    const surface_contact::SurfaceLaw l = law(50.0);
    const Vec3 t = (s.moves.x_n1[1] - s.moves.x_n1[0]).normalized();
    Scene drawn = s;
    for (int k = 0; k < 2; ++k) drawn.moves.u[k] += 1e-3 * t, drawn.moves.x_n1[k] += 1e-3 * t;
    EXPECT_NEAR(drawn.pair(l).slide_along(0.0, false).slid, 1e-3, 2e-6);
    Scene rolled = s;
    const Vec3 across = t.cross(s.pair(l).normal()).normalized();
    for (int k = 0; k < 2; ++k)
      rolled.moves.u[k] += 1e-3 * across, rolled.moves.x_n1[k] += 1e-3 * across;
    EXPECT_NEAR(rolled.pair(l).slide_along(0.0, false).slid, 0.0, 3e-5);
  }
}

}  // namespace
}  // namespace polhode::test::round_edge_pair_tests
