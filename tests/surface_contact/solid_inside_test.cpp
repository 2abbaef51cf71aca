// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <polhode/surface_contact/solid_inside.hpp>
#include <support/random_steps.hpp>

namespace polhode::test::solid_inside_tests {
namespace {

/// Cubes of 1 m about these centres, each face one quadrilateral.
struct Cubes {
  std::vector<double> x;
  solids::LoadedFaces faces{"quad4", {}};

  explicit Cubes(const std::vector<Vec3>& centres) {
    for (const Vec3& centre : centres) {
      const int first = static_cast<int>(x.size() / 3);
      for (int k = 0; k < 8; ++k)
        for (int c = 0; c < 3; ++c) x.push_back(centre[c] + ((k >> c) % 2 == 1 ? 0.5 : -0.5));
      for (const int k : {0, 2, 3, 1, 4, 5, 7, 6, 0, 1, 5, 4, 2, 6, 7, 3, 0, 4, 6, 2, 1, 3, 7, 5})
        faces.nodes.push_back(first + k);
    }
  }
  [[nodiscard]] surface_contact::SolidInside inside() const {
    return {surface_contact::triangulated({faces}), x.data()};
  }
};

double depth_in_cube(const Vec3& x) {
  const Vec3 beyond = x.cwiseAbs().array() - 0.5;
  const double outside = beyond.cwiseMax(0.0).norm();
  return outside > 0.0 ? -outside : -beyond.maxCoeff();
}

TEST(SolidInside, FindsTheDepthOfABallInASolidAndTheDirectionOut) {
  const surface_contact::SolidInside cube = Cubes({Vec3::Zero()}).inside();
  EXPECT_EQ(cube.size(), 1.0);
  Random random(3);
  int found = 0;
  for (int k = 0; k < 500; ++k) {
    const Vec3 x = random.vector(0.8);
    const double radius = k % 2 == 0 ? 0.0 : 0.2, depth = depth_in_cube(x) + radius;
    const std::optional<surface_contact::SurfaceOverlap> overlap = cube.overlap(x, radius);
    ASSERT_EQ(overlap.has_value(), depth > 0.1) << x.transpose();
    if (!overlap) continue;
    ++found;
    EXPECT_NEAR(overlap->depth, depth, 1e-12);
    EXPECT_NEAR(depth_in_cube(x + depth * overlap->out), -radius, 1e-12);
  }
  EXPECT_GT(found, 50);
}

TEST(SolidInside, FindsSelfOverlapsOfASolid) {
  EXPECT_FALSE(Cubes({Vec3::Zero()}).inside().overlap_with_itself());
  EXPECT_FALSE(Cubes({Vec3::Zero(), {1.0, 0.0, 0.0}}).inside().overlap_with_itself())
      << "faces on each other";
  EXPECT_FALSE(Cubes({Vec3::Zero(), {0.95, 0.0, 0.0}}).inside().overlap_with_itself())
      << "less than a tenth of a face";
  const auto found = Cubes({Vec3::Zero(), {0.6, 0.0, 0.0}}).inside().overlap_with_itself();
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->depth, 0.5 - 1.0 / 3.0, 1e-5) << "the middle of a quarter of a face";
  EXPECT_TRUE(found->out.isZero());
}

}  // namespace
}  // namespace polhode::test::solid_inside_tests
