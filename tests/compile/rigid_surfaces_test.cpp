// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <polhode/compile/rigid_surfaces.hpp>
#include <polhode/core/error.hpp>
#include <polhode/geometry/shapes.hpp>
#include <support/shape_sizes.hpp>

namespace polhode::rigid_surfaces_tests {
namespace {

ShapeSpec shape_of(const std::string& type, std::vector<double> sizes) {
  ShapeSpec shape;
  shape.type = type;
  shape.sizes = std::move(sizes);
  return shape;
}

TEST(RigidSurfaces, ExistForEveryKindOfShape) {
  for (const geometry::ShapeKind& kind : geometry::shape_kinds()) {
    const std::vector<double> sizes = test::fitting_sizes(kind, {0.2, 0.5, 0.4});
    const surface_contact::RigidSurface surface =
        rigid_surface("a", shape_of(kind.name, sizes), 1e-4);
    EXPECT_NE(surface.kind, surface_contact::RigidSurface::Kind::plane) << kind.name;
    EXPECT_GT(surface.distance(Vec3(0.0, 0.0, 1.0), 2.0, true), 0.5) << kind.name;
    EXPECT_GT(surface.distance(Vec3(1.0, 0.0, 0.0), 2.0, true), 0.5) << kind.name;
  }
  EXPECT_EQ(rigid_surface("a", shape_of("plane", {}), 1e-4).kind,
            surface_contact::RigidSurface::Kind::plane);
}

TEST(RigidSurfaces, RefuseAnUnknownKindOfShape) {
  try {
    static_cast<void>(rigid_surface("rock and pad", shape_of("star", {0.3, 0.2, 0.4}), 1e-4));
    FAIL() << "an unknown shape was accepted";
  } catch (const InputError& e) {
    EXPECT_EQ(e.where(), "rock and pad");
    EXPECT_THAT(e.what_is_wrong(), testing::HasSubstr("star"));
  }
}

}  // namespace
}  // namespace polhode::rigid_surfaces_tests
