// SPDX-License-Identifier: Apache-2.0
// Smooth patches over the faces of a mesh.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include <polhode/surface_contact/surface_patch.hpp>
#include <support/random_steps.hpp>

namespace polhode::test::surface_patch_tests {
namespace {

using surface_contact::kRoundedEdge;
using surface_contact::PatchFoot;
using surface_contact::SurfacePatch;

/// n × n unit squares in the plane z = 0, or pairs of triangles, and their patches.
struct Sheet {
  explicit Sheet(int n, int corners = 4) {
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= n; ++i) x.emplace_back(i, j, 0.0);
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        const int a = j * (n + 1) + i;
        if (corners == 4) {
          surface.faces.push_back({4, {a, a + 1, a + n + 2, a + n + 1}, 4 * (j * n + i)});
          continue;
        }
        surface.faces.push_back({3, {a, a + 1, a + n + 2, -1}, 2 * (j * n + i)});
        surface.faces.push_back({3, {a + n + 2, a + n + 1, a, -1}, 2 * (j * n + i) + 1});
      }
    patches = surface_contact::smooth_patches(surface, x);
  }
  void place(const SurfacePatch& patch, Vec3 (&at)[SurfacePatch::kSize]) const {
    for (std::size_t a = 0; a < patch.vertex.size(); ++a)
      at[a] =
          patch.vertex[a] < 0 ? Vec3(Vec3::Zero()) : x[static_cast<std::size_t>(patch.vertex[a])];
  }
  [[nodiscard]] Vec3 sum(const SurfacePatch& patch, const PatchFoot::Weights& w) const {
    Vec3 at[SurfacePatch::kSize], s = Vec3::Zero();
    place(patch, at);
    for (std::size_t a = 0; a < w.size(); ++a) s += w[a] * at[a];
    return s;
  }
  [[nodiscard]] PatchFoot nearest(const Vec3& p, double width) const {
    PatchFoot best;
    best.distance = 1e300;
    for (std::size_t k = 0; k < patches.size(); ++k) {
      Vec3 at[SurfacePatch::kSize];
      place(patches[k], at);
      PatchFoot foot = nearest_of_patch(patches[k], p, at, width);
      EXPECT_GE(foot.distance, least_distance(patches[k], p, at));
      if (best.patch >= 0 && !is_nearer(foot, best)) continue;
      best = foot;
      best.patch = static_cast<int>(k);
    }
    return best;
  }
  /// From the surface to the point, of length 1.
  [[nodiscard]] Vec3 normal(const Vec3& p, double width) const {
    const PatchFoot foot = nearest(p, width);
    return (p - sum(patches[static_cast<std::size_t>(foot.patch)], foot.M)).normalized();
  }

  surface_contact::MeshSurface surface;
  std::vector<Vec3> x;
  std::vector<SurfacePatch> patches;
};

// Stationary to rounding wherever the nearest point is free.
// @tests{patch-weights}
TEST(SurfacePatch, TheNearestPointIsStationary) {
  Random random(1);
  for (int trial = 0; trial < 1000; ++trial) {
    Sheet s(3, trial % 2 == 0 ? 4 : 3);
    for (Vec3& x : s.x) x += random.vector(0.1);
    const Vec3 p = Vec3(1.5, 1.5, 0.3) + random.vector(0.7);
    const PatchFoot foot = s.nearest(p, kRoundedEdge);
    const SurfacePatch& patch = s.patches[static_cast<std::size_t>(foot.patch)];
    double weights = 0.0;
    for (const double w : foot.M) weights += w;
    EXPECT_NEAR(weights, 1.0, 1e-14);
    const Vec3 y = p - s.sum(patch, foot.M);
    EXPECT_NEAR(y.norm(), foot.distance, 1e-14);
    for (int k = 0; k < foot.free_count; ++k)
      EXPECT_LT(std::abs(s.sum(patch, foot.along[k]).dot(y)), 1e-12) << trial;
  }
}

// Over the edge of two faces, to rounding, the foot is free across it, as it is beside it: without
// that the tangent of a point's force would have the stiffness of an edge there.
// @tests{patch-weights}
TEST(SurfacePatch, TheNearestPointIsFreeAcrossEdges) {
  for (const double bend : {0.1, -0.1, 0.05, -0.05}) {
    Sheet s(4, std::abs(bend) == 0.1 ? 4 : 3);
    for (Vec3& x : s.x) x[2] = bend * std::abs(x[0] - 2.0);
    for (const double y : {2.0, 2.3})
      for (const double aside : {0.0, 1e-17, 3e-16, -3e-16, 1e-14, -1e-12, 1e-9}) {
        const PatchFoot foot = s.nearest({2.0 + aside, y, 1e-5}, kRoundedEdge);
        EXPECT_EQ(foot.free_count, 2) << bend << ' ' << y << ' ' << aside;
        EXPECT_LT(foot.outwards, 1e-14);
      }
  }
}

// Whatever the places of vertices in a plane, distances from it are heights above it, and in the
// middle of a face the weights are bilinear.
// @tests{patch-weights}
TEST(SurfacePatch, APlaneStaysAPlane) {
  Random random(1);
  for (const int corners : {4, 3}) {
    Sheet s(3, corners);
    for (Vec3& x : s.x) {
      x += random.vector(0.1);
      x[2] = 0.0;
    }
    for (int trial = 0; trial < 200; ++trial) {
      Vec3 p = Vec3(1.5, 1.5, 0.0) + random.vector(0.8);
      p[2] = 0.01;
      EXPECT_NEAR(s.nearest(p, kRoundedEdge).distance, 0.01, 1e-15);
    }
  }
  const Sheet flat(3);
  const PatchFoot foot = flat.nearest({1.6, 1.3, 0.1}, kRoundedEdge);
  const double bilinear[4] = {0.4 * 0.7, 0.6 * 0.7, 0.4 * 0.3, 0.6 * 0.3};
  for (std::size_t k = 0; k < 4; ++k)
    EXPECT_NEAR(foot.M[k < 2 ? 5 + k : 7 + k], bilinear[k], 1e-14);
}

// Over a valley, a ridge and a saddle the direction to the nearest point changes continuously along
// a path over edges and corners: its largest change falls with the distance of places. Without
// rounded edges it jumps by the angle between the faces.
// @tests{patch-weights}
TEST(SurfacePatch, TheNormalIsContinuousOverEdges) {
  for (const int corners : {4, 3})
    for (const double bend : {0.1, -0.1, 0.0}) {
      Sheet s(4, corners);
      for (Vec3& x : s.x) {
        const double along = x[0] - 2.0, aside = x[1] - 2.0;
        x[2] = bend * std::abs(along) + (bend == 0.0 ? 0.02 * along * aside * aside : 0.0);
      }
      for (const double y : {2.0, 2.3}) {
        const auto largest_change = [&](int places, double width) {
          double most = 0.0;
          Vec3 before = Vec3::Zero();
          for (int i = 0; i <= places; ++i) {
            const double x = 1.2 + 1.6 * i / places;
            const Vec3 n = s.normal({x, y, 0.05 + bend * std::abs(x - 2.0)}, width);
            if (i > 0) most = std::max(most, (n - before).norm());
            before = n;
          }
          return most;
        };
        EXPECT_LT(largest_change(3200, kRoundedEdge),
                  0.6 * largest_change(1600, kRoundedEdge) + 1e-12)
            << corners << ' ' << bend << ' ' << y;
        if (bend > 0.0) {
          EXPECT_NEAR(largest_change(3200, 0.0), 2.0 * std::sin(std::atan(bend)), 1e-3);
        }
      }
    }
}

// A sheet that is curved at the start, where the faces about a vertex cannot be unfolded into one
// plane: less than a quarter of the kinks remains.
// @tests{patch-triangles}
TEST(SurfacePatch, TrianglesOfACurvedSurfaceHaveSmallKinks) {
  Sheet s(4, 3);
  for (Vec3& x : s.x) x[2] = -0.05 * (std::pow(x[0] - 2.0, 2) + std::pow(x[1] - 2.0, 2));
  s.patches = surface_contact::smooth_patches(s.surface, s.x);
  const auto largest_jump = [&](double width) {
    double most = 0.0;
    for (const double y : {2.0, 2.02, 2.3}) {
      Vec3 before = s.normal({1.2, y, 0.01}, width);
      for (int i = 1; i <= 1000; ++i) {
        const Vec3 n = s.normal({1.2 + 1.6e-3 * i, y, 0.01}, width);
        most = std::max(most, (n - before).norm());
        before = n;
      }
    }
    return most;
  };
  EXPECT_GT(largest_jump(0.0), 0.035);
  EXPECT_LT(largest_jump(kRoundedEdge), 0.25 * largest_jump(0.0));
}

}  // namespace
}  // namespace polhode::test::surface_patch_tests
