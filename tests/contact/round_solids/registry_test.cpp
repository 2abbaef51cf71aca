// SPDX-License-Identifier: Apache-2.0
// Every kind of round solid, against the triangles that represent it in pictures.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include <polhode/contact/feature_pairs.hpp>
#include <polhode/contact/round_solids/round_solid.hpp>

#include "support/derivative.hpp"
#include "support/random_steps.hpp"
#include "support/shape_sizes.hpp"

namespace polhode::round_solids_tests {
namespace {

using namespace contact;
using test::Random;

/// Support functions of round solids are rounded by a hundredth of their size.
constexpr double kRounded = 0.01;

class EveryRoundSolid : public testing::TestWithParam<const RoundSolid*> {
 protected:
  const RoundSolid& solid_ = *GetParam();
  const geometry::ShapeKind* kind_ = geometry::find_shape_kind(solid_.name);
  const std::vector<double> sizes_ =
      kind_ ? test::fitting_sizes(*kind_, {0.8, 0.9, 0.6}) : std::vector<double>{};
  const geometry::ShapePlace place_{{0.05, -0.03, 0.02}, Random(3).frame()};

  void SetUp() override {
    ASSERT_NE(kind_, nullptr) << "the kind is not one of the model file";
    ASSERT_FALSE(sizes_.empty()) << "the kind needs a longer list of lengths";
  }
  [[nodiscard]] geometry::Shape shape() const { return solid_.shape("shape", sizes_, place_, 0.0); }
  /// Points of the surface, in coordinates of the body; chords of the circles are below 1e-4.
  [[nodiscard]] std::vector<Vec3> points() const {
    std::vector<Vec3> list = geometry::shape_surface(*kind_, sizes_, 256).points;
    for (Vec3& x : list) x = place_.origin + place_.axes * x;
    return list;
  }
};

Placement<double> at_rest(const Mat3& axes, int first) { return {Vec3::Zero(), axes, first}; }

/// The sharp edges of the triangles stick out of the rounded ones, at an apex by some roundings. A
/// rounded ellipsoid is slightly larger than its size.
TEST_P(EveryRoundSolid, HasTheVerticesOfItsMeshOnItsSurface) {
  const geometry::Shape s = shape();
  const Mat3 still = Mat3::Identity();
  for (const Vec3& x : points()) {
    const double distance = solid_.plain.over(v3(x), 0.0, s, at_rest(still, 6)).distance;
    EXPECT_GT(distance, -s.rounding);
    EXPECT_LT(distance, 4.0 * s.rounding);
    EXPECT_LT((x - s.bound_centre).norm(), s.bound_radius + s.rounding);
    EXPECT_LT(x.norm(), s.reach + s.rounding);
  }
}

TEST_P(EveryRoundSolid, HasChordsFromItsCentreToItsCore) {
  const geometry::Shape s = shape();
  const Mat3 still = Mat3::Identity();
  for (int k = 0; k < 3; ++k)
    for (const double sign : {-1.0, 1.0})
      for (const double part : {1.0 - 1e-6, 1.0 + 1e-6}) {
        // Slightly off the axis, where the radial direction is defined.
        const Vec3 x = s.centre + sign * part * s.chords[k] * s.axes.col(k) + Vec3::Constant(1e-9);
        const double distance =
            solid_.plain.over(v3(x), 0.0, s, at_rest(still, 6)).distance + s.rounding;
        EXPECT_NEAR(distance, 0.0, 2e-6 * s.chords[k]) << k;
        EXPECT_EQ(distance > 0.0, part > 1.0) << k;
      }
}

TEST_P(EveryRoundSolid, HasTheExtentOfItsMesh) {
  const geometry::Shape s = shape();
  const std::vector<Vec3> list = points();
  Random random(5);
  for (int trial = 0; trial < 100; ++trial) {
    const Vec3 n = random.direction();
    double extent = -std::numeric_limits<double>::infinity();
    for (const Vec3& x : list) extent = std::max(extent, n.dot(x));
    const Vec3 support = solid_.curved_support(s, s.axes.transpose() * n, blur::fine).x;
    EXPECT_NEAR(n.dot(s.centre + s.axes * support), extent, kRounded * s.bound_radius);
  }
}

// @tests{contact-round-support}
TEST_P(EveryRoundSolid, HasOneSupportPointAndItsDerivative) {
  const geometry::Shape s = shape();
  V3<double> axes[3];
  for (int k = 0; k < 3; ++k) axes[k] = v3(Vec3::Unit(k));
  Random random(6);
  for (int trial = 0; trial < 20; ++trial) {
    const Vec3 n = random.direction();
    const CurvedSupport curved = solid_.curved_support(s, n, blur::coarse);
    EXPECT_LT((value(solid_.plain.support(s, axes, v3(n), blur::coarse)) - curved.x).norm(), 1e-14);
    // Tangential to the sphere of directions, where the two forms need not agree otherwise.
    const Mat3 across = Mat3::Identity() - n * n.transpose();
    const Mat numeric = test::central_difference(
        [&](const Vec& by) -> Vec {
          return solid_.curved_support(s, (n + across * by).normalized(), blur::coarse).x;
        },
        3, 1e-6);
    EXPECT_LT((curved.D * across - numeric).norm(), 1e-6 * s.bound_radius / kRounded);
    const Mat3 tangential = across * curved.D * across;
    EXPECT_LT((tangential - tangential.transpose()).norm(), 1e-12);
  }
}

/// Representation of a round solid elsewhere: corners, flat ends and, without these, an ellipsoid.
TEST_P(EveryRoundSolid, TouchesAPlaneWithItsLowestPoint) {
  const geometry::Shape s = shape(), floor = geometry::plane();
  const std::vector<Vec3> list = points();
  Random random(7);
  for (int trial = 0; trial < 50; ++trial) {
    const Mat3 L = random.frame(), still = Mat3::Identity();
    const Placement<double> at(Vec3(0.0, 0.0, 2.0), L, 0), ground(Vec3::Zero(), still, 6);
    double lowest = std::numeric_limits<double>::infinity(), least = lowest;
    for (const Vec3& x : list) lowest = std::min(lowest, at.point(x).z);
    std::vector<OrderedPair> found;
    near_feature_pairs(s, floor, at, ground, 10.0, found);
    for (const OrderedPair& p : found)
      if (!p.swapped) least = std::min(least, gap(p.pair, s, floor, at, ground).distance);
    EXPECT_NEAR(least, lowest, 1e-4 + 4.0 * s.rounding);
  }
}

INSTANTIATE_TEST_SUITE_P(RoundSolids, EveryRoundSolid,
                         testing::ValuesIn(round_solids().begin(), round_solids().end()),
                         [](const auto& solid) { return std::string(solid.param->name); });

TEST(RoundSolids, AreFoundByName) {
  EXPECT_EQ(find_round_solid("box"), nullptr);
  EXPECT_EQ(find_round_solid("cone")->name, "cone");
}

}  // namespace
}  // namespace polhode::round_solids_tests
