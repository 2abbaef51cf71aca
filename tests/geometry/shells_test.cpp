// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include <polhode/core/error.hpp>
#include <polhode/geometry/shapes.hpp>
#include <polhode/geometry/shells.hpp>

namespace polhode::shells_tests {
namespace {

/// A cube about a point; a cavity faces inward.
geometry::TriangleSurface cube(double size, const Vec3& centre, bool cavity = false) {
  const double sizes[] = {size, size, size};
  geometry::TriangleSurface surface =
      geometry::shape_surface(*geometry::find_shape_kind("box"), sizes);
  for (Vec3& x : surface.points) x += centre;
  if (cavity)
    for (auto& t : surface.triangles) std::swap(t[1], t[2]);
  return surface;
}

geometry::TriangleSurface together(std::initializer_list<geometry::TriangleSurface> shells) {
  geometry::TriangleSurface whole;
  for (const geometry::TriangleSurface& shell : shells) {
    const int first = static_cast<int>(whole.points.size());
    whole.points.insert(whole.points.end(), shell.points.begin(), shell.points.end());
    for (auto t : shell.triangles) {
      for (int& corner : t) corner += first;
      whole.triangles.push_back(t);
    }
  }
  geometry::join_equal_points(whole);
  return whole;
}

std::string refusal(const geometry::TriangleSurface& surface) {
  try {
    geometry::check_closed("part.stl", surface);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

TEST(Shells, OneWithinAnotherThatFacesTheSameWayIsRefused) {
  const auto nested = together({cube(2.0, Vec3::Zero()), cube(1.0, {0.2, 0.1, 0.0})});
  // The mass without the refusal: 8 and 1 together, for a solid of 8.
  EXPECT_DOUBLE_EQ(geometry::mass_properties(nested, 1.0).mass, 9.0);
  EXPECT_EQ(refusal(nested),
            "part.stl: the surface has a shell at (-0.3, -0.4, -0.5) that lies inside another one "
            "and faces the same way, so its volume would count twice. Remove it, or turn its "
            "triangles over if it is a cavity.");
}

TEST(Shells, AWholeThatFacesInwardIsJudgedTheSame) {
  const auto nested = together({cube(2.0, Vec3::Zero(), true), cube(1.0, Vec3::Zero(), true)});
  EXPECT_NE(refusal(nested), "");
  EXPECT_EQ(refusal(together({cube(2.0, Vec3::Zero(), true), cube(1.0, Vec3::Zero())})), "");
}

TEST(Shells, CavitiesAndSolidsWithinThemAreAllowed) {
  const auto hollow =
      together({cube(3.0, Vec3::Zero()), cube(2.0, Vec3::Zero(), true), cube(1.0, Vec3::Zero())});
  EXPECT_EQ(refusal(hollow), "");
  EXPECT_NEAR(geometry::mass_properties(hollow, 1.0).mass, 27.0 - 8.0 + 1.0, 1e-13);
}

TEST(Shells, ACavityOutsideOfAllSolidsIsRefused) {
  EXPECT_NE(refusal(together({cube(2.0, Vec3::Zero()), cube(1.0, {5.0, 0.0, 0.0}, true)})), "");
}

TEST(Shells, SolidsSideBySideMayTouch) {
  EXPECT_EQ(refusal(together({cube(2.0, Vec3::Zero()), cube(1.5, {1.75, 0.1, 0.1}),
                              cube(1.0, {0.0, 0.3, 1.5}), cube(1.0, {9.0, 0.0, 0.0})})),
            "");
}

}  // namespace
}  // namespace polhode::shells_tests
