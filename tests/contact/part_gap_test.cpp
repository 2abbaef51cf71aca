// SPDX-License-Identifier: Apache-2.0
// Parts of round solids over faces and edges, against samples of many points.
#include <gtest/gtest.h>

#include <algorithm>

#include <polhode/contact/gap_parts.hpp>
#include <polhode/contact_laws/normal_law.hpp>

#include "contact/shapes_for_tests.hpp"

namespace polhode::part_gap_tests {
namespace {

using namespace contact;
using namespace test;

std::vector<NamedShape> round_shapes() {
  const geometry::ShapePlace place{{0.05, -0.03, 0.02}, Random(3).frame()};
  std::vector<NamedShape> all;
  for (const RoundSolid* solid : round_solids()) {
    const std::string name(solid->name);
    const std::vector<double> sizes =
        fitting_sizes(*geometry::find_shape_kind(name), {0.7, 0.9, 0.5});
    all.push_back({name, solid->shape(name, sizes, place, 0.0)});
  }
  return all;
}

/// Number of parts that can come near faces.
int parts_of(const geometry::Shape& round) {
  return std::max(1, static_cast<int>(round.flat_ends.size()));
}

/// Smallest distance of sample points on an ellipsoid from a solid. It exceeds the exact distance
/// by no more than the spacing of the points allows.
double sampled(const geometry::Shape& part, const geometry::Shape& b, const Placement<double>& at_a,
               const Placement<double>& at_b) {
  double least = 1e9;
  const int n = 300;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j < n; ++j) {
      const double u = std::numbers::pi * i / n, v = 2.0 * std::numbers::pi * j / n;
      const Vec3 on_ball(std::sin(u) * std::cos(v), std::sin(u) * std::sin(v), std::cos(u));
      const Vec3 X = part.centre + part.axes * part.half.cwiseProduct(on_ball);
      const Gap<double> g = point_over_solid(at_a.point(X), part.rounding, b, at_b);
      least = std::min(least, g.distance);
    }
  return least;
}

TEST(PartGap, IsTheMinimumOverManyPoints) {
  Random random(31);
  for (const NamedShape& round : round_shapes())
    for (const geometry::Shape& b :
         {geometry::box("box", {0.8, 0.7, 0.5}), geometry::hull("hull", stone(5))}) {
      int met = 0;
      for (int trial = 0; trial < 12; ++trial) {
        const BodyMotion m = random.motion();
        const Mat3 L_a = m.q.toRotationMatrix(), L_b = Random(trial).frame();
        const Vec3 r = 1.1 * random.direction();
        const Placement<double> at_a(r, L_a, 0), at_b(Vec3::Zero(), L_b, 6);
        for (int which = 0; which < parts_of(round.shape); ++which) {
          const geometry::Shape part = part_of(round.shape, which);
          const double expected = sampled(part, b, at_a, at_b);
          if (expected < 0.0) continue;
          const Gap<double> g =
              gap({GapKind::part_solid, which, 0, Fade::none}, round.shape, b, at_a, at_b);
          EXPECT_LT(g.distance, expected + 1e-12) << round.name << " " << trial;
          EXPECT_GT(g.distance, expected - 2e-3) << round.name << " " << trial;
          EXPECT_NEAR(value(g.normal).norm(), 1.0, 1e-14);
          ++met;
        }
      }
      EXPECT_GT(met, 5) << round.name;
    }
}

/// Distance of the outer rim of a tube from solids in front of it, beside it and within its mouth.
TEST(RingGap, IsTheMinimumOverManyPoints) {
  Random random(34);
  const geometry::Shape tube = round_tube(0.8, 0.5, 0.7);
  int met = 0, within = 0;
  for (const geometry::Shape& b :
       {geometry::box("box", {0.8, 0.7, 0.5}), geometry::hull("hull", stone(5)),
        geometry::box("needle", {0.1, 0.1, 1.5})})
    for (int trial = 0; trial < 300; ++trial) {
      const Mat3 L_a = random.frame(), L_b = random.frame();
      const Placement<double> at_a(0.7 * random.direction(), L_a, 0), at_b(Vec3::Zero(), L_b, 6);
      for (const int which : {0, 1}) {
        const geometry::Shape part = part_of(tube, which);
        const double R = part.half.x();
        double expected = 1e9;
        for (int k = 0; k < 2000; ++k) {
          const double u = std::numbers::pi * k / 1000;
          const Vec3 X = part.centre + part.axes * Vec3(R * std::cos(u), R * std::sin(u), 0.0);
          expected =
              std::min(expected, point_over_solid(at_a.point(X), part.rounding, b, at_b).distance);
        }
        if (expected < 0.0) continue;
        const Gap<double> g = gap({GapKind::part_solid, which, 0, Fade::none}, tube, b, at_a, at_b);
        EXPECT_LT(g.distance, expected + 1e-12) << trial;
        EXPECT_GT(g.distance, expected - 1e-3) << trial;
        EXPECT_NEAR(value(g.normal).norm(), 1.0, 1e-14);
        ++met;
        // Whether the solid is nearer to the disc that the rim surrounds than to the rim.
        double disc = 1e9;
        for (int k = 0; k < 2000; ++k) {
          const double u = std::numbers::pi * k / 20, q = R * (k / 40) / 50.0;
          const Vec3 X = part.centre + part.axes * Vec3(q * std::cos(u), q * std::sin(u), 0.0);
          disc = std::min(disc, point_over_solid(at_a.point(X), part.rounding, b, at_b).distance);
        }
        if (disc < expected - 0.05) ++within;
      }
    }
  EXPECT_GT(met, 500);
  EXPECT_GT(within, 30);
}

/// Overlap of a part that penetrates a face far from the edges: its depth below the face.
TEST(PartGap, IsNegativeWhereThePartPenetrates) {
  const geometry::Shape egg = ellipsoid("egg", {0.3, 0.2, 0.4}),
                        crate = geometry::box("crate", {2.0, 2.0, 2.0});
  const geometry::Shape field =
      geometry::height_field("field", 5, 1.0, std::vector<double>(25, 0.0));
  const Mat3 upright = Mat3::Identity();
  const auto gap_at = [&](double z, const geometry::Shape& b, const FeaturePair& pair) {
    return gap(pair, egg, b, Placement<double>({0.2, 0.3, z}, upright, 0),
               Placement<double>(Vec3::Zero(), upright, 6))
        .distance;
  };
  for (const double depth : {-0.1, -1e-3, 1e-3, 0.05, 0.15, 0.3, 0.7}) {
    EXPECT_NEAR(gap_at(1.2 - depth, crate, {GapKind::part_solid, 0, 0, Fade::none}), -depth, 1e-12);
    double least = 1e9;
    if (depth > 0.19) continue;  // the middle of the egg is still above the field
    for (int t = 0; t < static_cast<int>(field.triangles.size()); ++t)
      least =
          std::min(least, gap_at(0.2 - depth, field, {GapKind::part_triangle, 0, t, Fade::none}));
    EXPECT_NEAR(least, -depth, 1e-12);
    EXPECT_NEAR(gap_at(0.2 - depth, field, {GapKind::part_surface, 0, 0, Fade::none}), -depth,
                1e-12);
  }
}

/// Position of a point along the straight side of a round solid, from 0 at the lower end to 1; −1
/// below the lower end.
double along_side(const geometry::Shape& s, const Vec3& x_0) {
  const Vec3 x = s.axes.transpose() * (x_0 - s.centre);
  const double R = s.half[0], H = s.half[2], top = s.flat_ends.size() == 2 ? R : 0.0;
  if (x.z() < -H) return -1.0;
  const Vec3 side(top - R, 0.0, 2.0 * H), from(std::hypot(x.x(), x.y()) - R, 0.0, x.z() + H);
  return side.dot(from) / side.squaredNorm();
}

/// Gap of an edge to the round solid, whose rims and ends are rounded by a hundredth; its straight
/// side is exact.
TEST(RoundOverEdge, IsTheMinimumOverManyPoints) {
  Random random(32);
  const geometry::Shape with_edges[] = {geometry::box("box", {0.8, 0.7, 0.5}),
                                        geometry::capsule("capsule", 0.3, 0.8)};
  int compared = 0, sides = 0;
  for (const NamedShape& round : round_shapes())
    for (const geometry::Shape& b : with_edges)
      for (int trial = 0; trial < 40; ++trial) {
        const BodyMotion m = random.motion();
        const Mat3 L_a = m.q.toRotationMatrix(), L_b = Random(trial).frame();
        const Placement<double> at_a(0.8 * random.direction(), L_a, 0);
        const Placement<double> at_b(Vec3::Zero(), L_b, 6);
        for (int e = 0; e < static_cast<int>(b.edges.size()); ++e) {
          double expected = 1e9, along = 0.0;
          const Vec3 &p = b.corners[b.edges[e].i], &q = b.corners[b.edges[e].j];
          for (int k = 0; k <= 400; ++k) {
            const V3<double> x = at_b.point(p + k / 400.0 * (q - p));
            const double distance = point_over_solid(x, b.rounding, round.shape, at_a).distance;
            if (distance >= expected) continue;
            expected = distance;
            along = along_side(round.shape, at_a.to_body(value(x)));
          }
          if (expected < 0.0) continue;
          const Gap<double> g =
              gap({GapKind::round_edge, 0, e, Fade::none}, round.shape, b, at_a, at_b);
          const bool on_side = !round.shape.flat_ends.empty() && along > 0.05 && along < 0.95;
          const bool has_rim = !round.shape.flat_ends.empty() && !on_side;
          sides += on_side ? 1 : 0;
          EXPECT_GT(g.distance, expected - (has_rim ? 4e-3 : 1e-5)) << round.name << " " << e;
          EXPECT_LT(g.distance, expected + (has_rim ? 8e-3 : 3e-5)) << round.name << " " << e;
          ++compared;
        }
      }
  EXPECT_GT(compared, 500);
  EXPECT_GT(sides, 300);
}

/// On a plane that is cut into triangles a part has the gap of the plane, the outer rim of a tube
/// too. @tests{contact-one-gap}
TEST(PartGap, IsThatOfThePlaneOverItsTriangles) {
  Random random(33);
  std::vector<NamedShape> shapes = round_shapes();
  shapes.push_back({"tube", round_tube(0.8, 0.5, 0.7)});
  const geometry::Shape field =
      geometry::height_field("field", 15, 0.15, std::vector<double>(225, 0.0));
  NormalLaw law;
  law.stiffness = 1e5;
  law.tolerance = 2e-4;
  for (const NamedShape& round : shapes)
    for (int trial = 0; trial < 40; ++trial) {
      const Mat3 L = random.frame(), none = Mat3::Identity();
      const Placement<double> ground(Vec3::Zero(), none, 6);
      Vec3 r(0.15 * random.vector(1.0).x(), 0.15 * random.vector(1.0).y(), 1.0);
      const auto least = [&](int which) {
        const geometry::Shape part = part_of(round.shape, which);
        const Placement<double> at(r, L, 0);
        const V3<double> x = extreme_point(part, 0, v3(Vec3::UnitZ()), at);
        return x.z - part.rounding - field.rounding - field.corners[0].z();
      };
      const int parts = parts_of(round.shape);
      r.z() -= parts == 2 ? std::min(least(0), least(1)) : least(0);
      std::vector<OrderedPair> found;
      const Placement<double> at(r, L, 0);
      near_feature_pairs(round.shape, field, at, ground, 1e-3, found);
      double sum = 0.0, expected = 0.0;
      for (const OrderedPair& p : found) {
        if (p.swapped || p.pair.kind != GapKind::part_surface) continue;
        sum += law.energy(gap(p.pair, round.shape, field, at, ground).distance);
      }
      for (int which = 0; which < parts; ++which) expected += law.energy(least(which));
      EXPECT_NEAR(sum, expected, 1e-9 * expected) << round.name << " " << trial;
      EXPECT_GT(expected, 0.0);
    }
}

}  // namespace
}  // namespace polhode::part_gap_tests
