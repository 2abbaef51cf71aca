// SPDX-License-Identifier: Apache-2.0
// Edges that cross: by duality they are nearest where no plane separates the two bodies more.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include <polhode/contact/crossing_edges.hpp>

#include "contact/shapes_for_tests.hpp"

namespace polhode::crossing_edges_tests {
namespace {

using namespace contact;
using namespace test;

/// Distance of the cores along a direction: all of a lies beyond all of b by so much.
double separation(const geometry::Shape& a, const geometry::Shape& b, const BothPlaced& at,
                  const Vec3& n) {
  double of_a = std::numeric_limits<double>::infinity(), of_b = -of_a;
  for (const Vec3& X : a.corners) of_a = std::min(of_a, n.dot(value(at.a.point(X))));
  for (const Vec3& X : b.corners) of_b = std::max(of_b, n.dot(value(at.b.point(X))));
  return of_a - of_b;
}

PointData pair_of(const geometry::Shape& a, int i, const geometry::Shape& b, int j) {
  PointData d;
  d.a = &a;
  d.b = &b;
  d.pair = {GapKind::edge_edge, i, j, Fade::parallel};
  return d;
}

/// A square bar along an axis of the world, turned about it by an angle.
BodyStep bar(const Vec3& place, const Vec3& axis, double angle, const Vec3& moved = Vec3::Zero()) {
  BodyStep s = BodyStep::ground(0.5);
  const Mat3 along = Eigen::Quaterniond::FromTwoVectors(Vec3::UnitX(), axis).toRotationMatrix();
  s.moves = true;
  s.r_n = place;
  s.u = moved;
  s.r_n1 = place + moved;
  s.Lambda_n = s.Lambda_n1 = Eigen::AngleAxisd(angle, axis).toRotationMatrix() * along;
  return s;
}

/// Number of edge pairs of two shapes that meet in a step.
int met(const geometry::Shape& a, const geometry::Shape& b, const BodyStep& step_a,
        const BodyStep& step_b) {
  int count = 0;
  for (int i = 0; i < static_cast<int>(a.edges.size()); ++i)
    for (int j = 0; j < static_cast<int>(b.edges.size()); ++j)
      if (a.edges[static_cast<std::size_t>(i)].convex &&
          b.edges[static_cast<std::size_t>(j)].convex)
        count += have_met(pair_of(a, i, b, j), step_a, step_b) ? 1 : 0;
  return count;
}

// Weak duality: the distance of two bodies is at least their separation along any direction, so
// edges whose distance equals that along their gap are nearest.
// @tests{contact-edges}
TEST(CrossingEdges, InFrontAreThoseThatNothingElseIsNearerThan) {
  Random random(7);
  int in_front = 0, others = 0;
  for (int trial = 0; trial < 40; ++trial) {
    const geometry::Shape a = geometry::box("box", {0.8, 0.7, 0.5}),
                          b = trial % 2 == 0 ? geometry::box("box", {0.6, 0.3, 0.9})
                                             : geometry::hull("hull", stone(5));
    const Mat3 L_a = random.frame(), L_b = random.frame();
    const Vec3 r = 1.2 * random.direction(), zero = Vec3::Zero();
    const BothPlaced at{{r, L_a, 0}, {zero, L_b, 6}};
    for (int i = 0; i < static_cast<int>(a.edges.size()); ++i)
      for (int j = 0; j < static_cast<int>(b.edges.size()); ++j) {
        if (!a.edges[static_cast<std::size_t>(i)].convex ||
            !b.edges[static_cast<std::size_t>(j)].convex)
          continue;
        const std::optional<Crossing> c = crossing(pair_of(a, i, b, j), at);
        if (!c) continue;
        const double cores = c->gap.distance + a.rounding + b.rounding;
        const double apart = separation(a, b, at, value(c->gap.normal));
        if (c->in_front) {
          EXPECT_NEAR(apart, cores, 1e-12);
          ++in_front;
        } else {
          EXPECT_LT(apart, cores);
          ++others;
        }
      }
  }
  EXPECT_GT(in_front, 5);
  EXPECT_GT(others, 50);
}

// Two square bars across each other, on edge: the lower edge of one meets the upper edge of the
// other however deep it goes, and nothing else does; not if it was below from the beginning.
TEST(CrossingEdges, MeetWhereTheyPassThroughEachOther) {
  const geometry::Shape s = geometry::box("bar", {1.0, 0.1, 0.1});
  const double diagonal = 0.1 * std::sqrt(2.0), turned = 0.25 * std::numbers::pi;
  const BodyStep low = bar(Vec3::Zero(), Vec3::UnitX(), turned);
  const auto falls = [&](double height, double way, double aside = 0.0) {
    return met(s, s, bar({0.0, 0.0, height}, Vec3::UnitY(), turned, {aside, 0.0, -way}), low);
  };
  const double above = diagonal + 0.01;
  EXPECT_EQ(falls(above, 0.009), 0);
  EXPECT_EQ(falls(above, 0.011), 1);
  EXPECT_EQ(falls(above, 0.06), 1);
  EXPECT_EQ(falls(above, 0.011, 0.3), 1);
  EXPECT_EQ(falls(-above, 0.05), 0);
  EXPECT_EQ(falls(-above, 0.0, 0.3), 0);
}

// A bar that slides below another into sight of it has not passed through it.
TEST(CrossingEdges, DoNotMeetWhereOneSlidesUnderTheOther) {
  const geometry::Shape s = geometry::box("bar", {1.0, 0.1, 0.1});
  const BodyStep low = bar(Vec3::Zero(), Vec3::UnitX(), 0.0);
  for (const double height : {0.11, -0.11})
    EXPECT_EQ(met(s, s, bar({0.7, 0.0, height}, Vec3::UnitY(), 0.0, {-0.4, 0.0, 0.0}), low), 0)
        << height;
}

}  // namespace
}  // namespace polhode::crossing_edges_tests
