// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include <polhode/core/error.hpp>
#include <polhode/geometry/mass_properties.hpp>
#include <polhode/geometry/shapes.hpp>
#include <polhode/math/exp_map.hpp>

namespace polhode::mass_properties_tests {
namespace {

const Mat3 kSomeTurn = exp_map(Vec3(0.4, -1.1, 0.7));

std::string message(double mass, const Mat3& inertia) {
  try {
    geometry::check_mass_properties("bodies.arm", mass, inertia);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

Mat3 diagonal(double xx, double yy, double zz) { return Vec3(xx, yy, zz).asDiagonal(); }

TEST(CheckMassProperties, AcceptsPossibleMassProperties) {
  EXPECT_EQ(message(1.0, diagonal(1.0, 2.0, 2.5)), "");
  EXPECT_EQ(message(1e-9, 1e-18 * diagonal(1.0, 2.0, 2.5)), "");
  EXPECT_EQ(message(1e9, geometry::inertia_at(kSomeTurn, diagonal(1e12, 2e12, 2.5e12))), "");
}

TEST(CheckMassProperties, AcceptsAFlatBodyPrintedToSevenDigits) {
  EXPECT_EQ(message(1.0, diagonal(0.08333333, 0.08333333, 0.1666667)), "");
  // The limit J3 = J1 + J2 itself, turned, so that rounding falls on either side of it.
  EXPECT_EQ(message(1.0, geometry::inertia_at(kSomeTurn, diagonal(1.0, 1.0, 2.0))), "");
}

TEST(CheckMassProperties, RefusesAMassThatIsNotPositiveAndFinite) {
  EXPECT_EQ(message(0.0, Mat3::Identity()),
            "bodies.arm: mass must be positive and finite, but is 0 kg. Give the mass of the body, "
            "or a shape and a density.");
  EXPECT_NE(message(-2.0, Mat3::Identity()), "");
  EXPECT_NE(message(std::numeric_limits<double>::infinity(), Mat3::Identity()), "");
  EXPECT_NE(message(std::numeric_limits<double>::quiet_NaN(), Mat3::Identity()), "");
}

TEST(CheckMassProperties, RefusesAnInertiaThatIsNotSymmetric) {
  Mat3 inertia = diagonal(1.0, 2.0, 2.5);
  inertia(0, 1) = 0.1;
  EXPECT_EQ(message(1.0, inertia),
            "bodies.arm: inertia is not symmetric: entry xy is 0.1, but yx is 0 kg m². Make both "
            "the same.");
}

TEST(CheckMassProperties, RefusesEntriesThatAreNotFinite) {
  EXPECT_EQ(message(1.0, diagonal(1.0, std::numeric_limits<double>::quiet_NaN(), 1.0)),
            "bodies.arm: inertia has an entry that is not a finite number. Give three principal "
            "moments or the six entries of the tensor.");
}

TEST(CheckMassProperties, NamesThePrincipalMomentsAndTheBoundThatIsBroken) {
  EXPECT_EQ(message(1.0, diagonal(1.0, 2.0, 4.0)),
            "bodies.arm: the principal moments of inertia are 1, 2 and 4 kg m², but the largest "
            "may not exceed the sum of the other two, 3. No distribution of mass has these; check "
            "the values and their units.");
  EXPECT_EQ(message(1.0, diagonal(0.0, 1.0, 1.0)),
            "bodies.arm: the principal moments of inertia are 0, 1 and 1 kg m², but each must be "
            "positive. Give a thin body its small thickness, or say point_mass: true if it has no "
            "rotation.");
}

TEST(CheckMassProperties, RemindsOfTheSignOfTheOffDiagonalEntries) {
  Mat3 inertia = diagonal(1.0, 1.0, 1.5);
  inertia(0, 1) = inertia(1, 0) = 1.2;
  EXPECT_NE(message(1.0, inertia).find("xy is −∫ x y dm"), std::string::npos)
      << message(1.0, inertia);
}

TEST(PrincipalAxes, RebuildTheTensorFromAscendingMomentsAndARightHandedFrame) {
  const Mat3 J = geometry::inertia_at(kSomeTurn, diagonal(3.0, 1.0, 2.0));
  const auto [moments, axes] = geometry::principal_axes(J);
  EXPECT_LT((moments - Vec3(1.0, 2.0, 3.0)).norm(), 1e-14);
  EXPECT_LT((axes * moments.asDiagonal() * axes.transpose() - J).norm(), 1e-14);
  EXPECT_NEAR(axes.determinant(), 1.0, 1e-14);
}

// @tests{eq:rbm-moi-rotation}
TEST(InertiaAt, TurnsWithTheBody) {
  // Four unit masses fixed in the body: the tensor of the turned masses is the turned tensor.
  const Vec3 masses[] = {{1.0, 0.2, 0.0}, {-0.3, 0.5, 0.9}, {0.1, -0.8, 0.4}, {-0.6, 0.3, -1.0}};
  const auto tensor = [&](const Mat3& Lambda) {
    Mat3 J = Mat3::Zero();
    for (const Vec3& Z : masses) {
      const Vec3 z = Lambda * Z;
      J += z.squaredNorm() * Mat3::Identity() - z * z.transpose();
    }
    return J;
  };
  EXPECT_LT((geometry::inertia_at(kSomeTurn, tensor(Mat3::Identity())) - tensor(kSomeTurn)).norm(),
            1e-14);
}

TEST(InertiaAbout, OfARodAboutItsEndIsAThirdOfMassTimesLengthSquared) {
  const geometry::MassProperties rod{
      .mass = 3.0, .com = {1.0, 0.0, 0.0}, .inertia = diagonal(0.0, 1.0, 1.0)};
  EXPECT_LT((geometry::inertia_about(rod, Vec3::Zero()) - diagonal(0.0, 4.0, 4.0)).norm(), 1e-14);
  EXPECT_LT((geometry::inertia_about(rod, rod.com) - rod.inertia).norm(), 1e-15);
}

TEST(Composed, OfTheHalvesOfABoxIsTheBox) {
  const geometry::ShapeKind& box = *geometry::find_shape_kind("box");
  const double whole_sizes[] = {2.0, 0.6, 0.4};
  const double half_sizes[] = {1.0, 0.6, 0.4};
  const geometry::MassProperties whole =
      geometry::shape_mass_properties("box", box, whole_sizes, 1000.0);
  const geometry::MassProperties half =
      geometry::shape_mass_properties("box", box, half_sizes, 1000.0);
  const Vec3 p(0.3, -0.2, 5.0);
  const geometry::MassProperties parts[] = {
      geometry::placed(half, p + Vec3(-0.5, 0.0, 0.0), Mat3::Identity()),
      geometry::placed(half, p + Vec3(0.5, 0.0, 0.0), Mat3::Identity())};
  const geometry::MassProperties sum = geometry::composed(parts);
  EXPECT_NEAR(sum.mass, whole.mass, 1e-12 * whole.mass);
  EXPECT_LT((sum.com - p).norm(), 1e-14);
  // The parallel-axes terms are at most 26 m² times the mass; rounding of those.
  EXPECT_LT((sum.inertia - whole.inertia).norm(), 1e-14 * 26.0 * whole.mass);
}

TEST(Composed, DoesNotDependOnTheGrouping) {
  const geometry::MassProperties a{.mass = 1.0, .com = {1, 2, 3}, .inertia = diagonal(1, 2, 2.5)};
  const geometry::MassProperties b{.mass = 4.0, .com = {0, -2, 1}, .inertia = diagonal(3, 2, 2.5)};
  const geometry::MassProperties c{
      .mass = 0.5, .com = {-1, 1, 0}, .inertia = diagonal(0.1, 0.2, 0.2)};
  const geometry::MassProperties ab = geometry::composed(std::array{a, b});
  const geometry::MassProperties bc = geometry::composed(std::array{b, c});
  const geometry::MassProperties left = geometry::composed(std::array{ab, c});
  const geometry::MassProperties right = geometry::composed(std::array{a, bc});
  EXPECT_LT((left.com - right.com).norm(), 1e-14);
  EXPECT_LT((left.inertia - right.inertia).norm(), 1e-13);
}

TEST(Composed, CommutesWithPlacing) {
  const geometry::MassProperties a{.mass = 1.0, .com = {1, 2, 3}, .inertia = diagonal(1, 2, 2.5)};
  const geometry::MassProperties b{.mass = 4.0, .com = {0, -2, 1}, .inertia = diagonal(3, 2, 2.5)};
  const Vec3 p(0.1, 0.2, -0.7);
  const geometry::MassProperties first =
      geometry::placed(geometry::composed(std::array{a, b}), p, kSomeTurn);
  const geometry::MassProperties last = geometry::composed(
      std::array{geometry::placed(a, p, kSomeTurn), geometry::placed(b, p, kSomeTurn)});
  EXPECT_LT((first.com - last.com).norm(), 1e-14);
  EXPECT_LT((first.inertia - last.inertia).norm(), 1e-13);
}

TEST(Composed, TreatsAPartOfNegativeMassAsAHole) {
  const std::array tube_sizes = {0.3, 0.2, 1.0};
  const std::array outer_sizes = {0.3, 1.0};
  const std::array inner_sizes = {0.2, 1.0};
  const geometry::ShapeKind& cylinder = *geometry::find_shape_kind("cylinder");
  geometry::MassProperties hole = cylinder.unit_mass_properties(inner_sizes);
  hole.mass = -hole.mass;
  hole.inertia = -hole.inertia;
  const geometry::MassProperties tube =
      geometry::find_shape_kind("tube")->unit_mass_properties(tube_sizes);
  const geometry::MassProperties bored =
      geometry::composed(std::array{cylinder.unit_mass_properties(outer_sizes), hole});
  EXPECT_NEAR(bored.mass, tube.mass, 1e-15);
  EXPECT_LT((bored.inertia - tube.inertia).norm(), 1e-15);
}

}  // namespace
}  // namespace polhode::mass_properties_tests
