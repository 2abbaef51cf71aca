// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <polhode/core/error.hpp>
#include <polhode/geometry/shapes.hpp>
#include <support/shape_sizes.hpp>

namespace polhode::shapes_tests {
namespace {

class EveryShape : public testing::TestWithParam<const char*> {
 protected:
  const geometry::ShapeKind& kind_ = *geometry::find_shape_kind(GetParam());
  /// Different sizes, so that an exchange of two is detected.
  const std::vector<double> sizes_ = test::fitting_sizes(kind_, {0.5, 1.2, 0.9});
  const geometry::MassProperties exact_ =
      geometry::shape_mass_properties("shape", kind_, sizes_, 1.0);

  /// Relative error of the inertia of the triangulated shape.
  double surface_error(int segments) const {
    const geometry::MassProperties found =
        geometry::mass_properties(geometry::shape_surface(kind_, sizes_, segments), 1.0);
    return (found.inertia - exact_.inertia).norm() / exact_.inertia.norm();
  }
};

TEST_P(EveryShape, HasPossibleMassProperties) {
  EXPECT_NO_THROW(geometry::check_mass_properties("shape", exact_.mass, exact_.inertia));
}

TEST_P(EveryShape, HasAClosedOutwardSurface) {
  for (int segments : {3, 4, 7, 32}) {
    const geometry::TriangleSurface surface = geometry::shape_surface(kind_, sizes_, segments);
    EXPECT_NO_THROW(geometry::check_closed("surface", surface)) << segments << " segments";
    EXPECT_GT(geometry::signed_volume(surface), 0.0);
  }
}

TEST_P(EveryShape, HasASurfaceWhoseMassPropertiesConvergeToTheClosedForms) {
  if (kind_.name == "box") {
    EXPECT_LT(surface_error(3), 1e-14);  // flat faces: exact but for rounding
    return;
  }
  // Chords of a circle enclose less by a term of second order in their length.
  const double coarse = surface_error(64);
  const double fine = surface_error(128);
  EXPECT_NEAR(std::log2(coarse / fine), 2.0, 0.05);
  EXPECT_LT(fine, 5e-3);
}

TEST_P(EveryShape, HasItsOriginAtTheCentroid) {
  const geometry::MassProperties found =
      geometry::mass_properties(geometry::shape_surface(kind_, sizes_, 64), 1.0);
  EXPECT_LT(found.com.norm(), 1e-14);
  EXPECT_EQ(exact_.com, Vec3::Zero());
}

TEST_P(EveryShape, ScalesWithDensityAndTheFifthPowerOfLength) {
  std::vector<double> doubled = sizes_;
  for (double& size : doubled) size *= 2.0;
  const geometry::MassProperties large =
      geometry::shape_mass_properties("shape", kind_, doubled, 3.0);
  EXPECT_NEAR(large.mass, 24.0 * exact_.mass, 1e-14 * large.mass);
  EXPECT_LT((large.inertia - 96.0 * exact_.inertia).norm(), 1e-14 * large.inertia.norm());
}

TEST_P(EveryShape, RefusesSizesThatAreNotPositive) {
  for (std::size_t i = 0; i < sizes_.size(); ++i) {
    std::vector<double> wrong = sizes_;
    wrong[i] = i == 0 ? -1.0 : 0.0;
    EXPECT_THROW(geometry::check_shape_sizes("shape", kind_, wrong), InputError);
  }
  EXPECT_THROW(geometry::check_shape_sizes("shape", kind_, std::vector<double>(4, 1.0)),
               InputError);
}

std::vector<const char*> names() {
  std::vector<const char*> all;
  for (const geometry::ShapeKind& kind : geometry::shape_kinds()) all.push_back(kind.name.c_str());
  return all;
}
INSTANTIATE_TEST_SUITE_P(Shapes, EveryShape, testing::ValuesIn(names()),
                         [](const auto& shape) { return std::string(shape.param); });

geometry::MassProperties of(const char* name, const std::vector<double>& sizes) {
  return geometry::shape_mass_properties(name, *geometry::find_shape_kind(name), sizes, 1.0);
}

TEST(Shapes, TakeDiametersAndTotalLengths) {
  EXPECT_NEAR(of("sphere", {2.0}).mass, 4.0 / 3.0 * std::numbers::pi, 1e-14);
  EXPECT_NEAR(of("cylinder", {2.0, 3.0}).mass, 3.0 * std::numbers::pi, 1e-14);
  EXPECT_NEAR(of("cone", {2.0, 3.0}).mass, std::numbers::pi, 1e-14);
  EXPECT_NEAR(of("tube", {4.0, 2.0, 1.0}).mass, 3.0 * std::numbers::pi, 1e-14);
  // Of length over all: half balls of radius 1 and a barrel of length 1.
  EXPECT_NEAR(of("capsule", {2.0, 3.0}).mass, (4.0 / 3.0 + 1.0) * std::numbers::pi, 1e-14);
}

TEST(Shapes, AgreeWhereOneKindBecomesAnother) {
  const geometry::MassProperties ball = of("sphere", {0.7});
  const geometry::MassProperties capsule = of("capsule", {0.7, 0.7});
  const geometry::MassProperties ellipsoid = of("ellipsoid", {0.7, 0.7, 0.7});
  EXPECT_NEAR(capsule.mass, ball.mass, 1e-15);
  EXPECT_LT((capsule.inertia - ball.inertia).norm(), 1e-16);
  EXPECT_LT((ellipsoid.inertia - ball.inertia).norm(), 1e-16);
  // 2/5 m r² of the ball, m r² of a thin hoop about its axis.
  EXPECT_NEAR(ball.inertia(2, 2), 0.4 * ball.mass * 0.35 * 0.35, 1e-16);
  const geometry::MassProperties hoop = of("tube", {2.0, 2.0 - 1e-9, 1e-3});
  EXPECT_NEAR(hoop.inertia(2, 2) / hoop.mass, 1.0, 2e-9);
}

TEST(Shapes, ReportInconsistentSizes) {
  const auto message = [](const char* name, const std::vector<double>& sizes,
                          double density = 1.0) {
    try {
      (void)geometry::shape_mass_properties("bodies.arm.shape", *geometry::find_shape_kind(name),
                                            sizes, density);
    } catch (const InputError& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  EXPECT_EQ(message("tube", {0.3, 0.4, 1.0}),
            "bodies.arm.shape: the inner diameter, 0.4 m, must be less than the outer one, 0.3 m. "
            "Write tube: [outer, inner, length], full lengths.");
  EXPECT_EQ(message("capsule", {0.3, 0.2}),
            "bodies.arm.shape: the length over all, 0.2 m, must be at least the diameter, 0.3 m. "
            "Write capsule: [diameter, length], full lengths.");
  EXPECT_EQ(message("box", {0.3, 0.2}),
            "bodies.arm.shape: 'box' has 3 sizes, but 2 are given. Write box: [x, y, z], full "
            "lengths.");
  EXPECT_EQ(message("box", {0.3, -0.2, 1.0}),
            "bodies.arm.shape: the size 'y' of 'box' must be positive and finite, but is -0.2 m. "
            "Write box: [x, y, z], full lengths.");
  EXPECT_EQ(message("sphere", {0.3}, 0.0),
            "bodies.arm.shape: the density must be positive and finite, but is 0 kg/m³. Give a "
            "density, e.g. 7850 for steel, or mass and inertia of the body.");
}

TEST(Shapes, AreFoundByName) {
  EXPECT_EQ(geometry::find_shape_kind("cube"), nullptr);
  EXPECT_EQ(geometry::find_shape_kind("cone")->name, "cone");
}

}  // namespace
}  // namespace polhode::shapes_tests
