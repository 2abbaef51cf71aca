// SPDX-License-Identifier: Apache-2.0
// Shapes from faulty files.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <string>

#include <polhode/core/error.hpp>
#include <polhode/geometry/hull.hpp>
#include <polhode/geometry/read_surface.hpp>
#include <polhode/geometry/shape.hpp>
#include <support/paths.hpp>

namespace polhode::contact::shape_tests {
namespace {

const std::string kCube =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 0 0 1\nv 1 0 1\nv 0 1 1\nv 1 1 1\n"
    "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";

template <class Make>
std::string refusal(Make&& make) {
  try {
    (void)make();
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

TEST(MeshShape, LeavesOutPointsThatNoTriangleUses) {
  const geometry::Shape cube = geometry::mesh("cube", geometry::parse_surface("cube.obj", kCube));
  const geometry::Shape more =
      geometry::mesh("cube", geometry::parse_surface(
                                 "cube.obj", "v 7 7 7\n" + [] {
                                   std::string text = kCube;  // every number one higher
                                   for (std::size_t i = text.find('f'); i < text.size(); ++i)
                                     if (text[i] >= '1' && text[i] <= '8') ++text[i];
                                   return text;
                                 }()));
  ASSERT_EQ(more.corners.size(), 8U);
  EXPECT_EQ(more.bound_radius, cube.bound_radius);
  for (const Vec3& x : more.corners) EXPECT_TRUE(x.allFinite());
}

TEST(MeshShape, RefusesTrianglesWithoutArea) {
  // A point in the middle of an edge: a corner of one face, and of a sliver beside the other one.
  std::string text = "v 0.5 0 0\n" + kCube;
  for (std::size_t i = text.find('f'); i < text.size(); ++i)
    if (text[i] >= '1' && text[i] <= '8') ++text[i];
  text.replace(text.find("f 2 4 5 3"), 9, "f 2 4 5 3 1");
  text.replace(text.find("f 2 3 7 6"), 9, "f 1 3 7 6 2");
  const geometry::TriangleSurface surface = geometry::parse_surface("cube.obj", text);
  ASSERT_TRUE(geometry::edge_report(surface).closed()) << geometry::edge_report(surface).first;
  EXPECT_EQ(refusal([&] { return geometry::mesh("cube.obj", surface); }),
            "cube.obj: the triangle at (0, 0, 0) m has no area: its corners lie on a line. Let the "
            "program that made it remove degenerate triangles, or set contact: {touches: false}.");
}

TEST(MeshShape, RefusesImplausibleSizes) {
  geometry::TriangleSurface surface = geometry::parse_surface("cube.obj", kCube);
  for (Vec3& x : surface.points) x *= 1e200;
  EXPECT_EQ(refusal([&] { return geometry::mesh("cube.obj", surface); }),
            "cube.obj: its points are up to 1e+200 m apart. Check its unit of length, or give a "
            "scale.");
}

TEST(HullShape, RefusesPointsAlmostInAPlane) {
  const std::vector<Vec3> points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0.5, 0.5, 4e-10}};
  EXPECT_EQ(refusal([&] { return geometry::hull("tray", points); }),
            "tray: the points lie almost in a plane, so their hull has no volume. Give points that "
            "do not lie in one plane.");
}

TEST(ConvexHull, RefusesPointsInOnePlace) {
  const std::vector<Vec3> points(5, Vec3(1, 2, 3));
  EXPECT_EQ(
      refusal([&] { return geometry::convex_hull("dot", points); }),
      "dot: the points lie in one place, so their hull has no volume. Give at least four points "
      "that do not lie in one plane.");
}

TEST(HeightField, RefusesAHeightThatIsNotFinite) {
  const std::vector<double> heights{0, 0, std::numeric_limits<double>::quiet_NaN(), 0};
  EXPECT_EQ(refusal([&] { return geometry::height_field("soil", 2, 1.0, heights); }),
            "soil: a height is not finite. Correct the table of heights.");
}

/// Files found by fuzzers.
TEST(SurfaceFiles, FoundByFuzzersAreReadOrRefused) {
  int count = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(test::source_dir() + "/tests/fuzz/found_in_surfaces")) {
    const std::string name = entry.path().string();
    if (name.ends_with(".md")) continue;
    ++count;
    std::ifstream file(name, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(file), {}};
    const geometry::TriangleSurface surface = geometry::parse_surface(name, bytes);
    for (const bool convex : {false, true}) {
      try {
        const geometry::Shape shape =
            convex ? geometry::hull(name, surface.points) : geometry::mesh(name, surface);
        EXPECT_GT(shape.rounding, 0.0) << name;
        for (const Vec3& x : shape.corners) EXPECT_TRUE(x.allFinite()) << name;
      } catch (const InputError& e) {
        EXPECT_FALSE(e.hint().empty()) << name;
      }
    }
  }
  EXPECT_GE(count, 2);
}

}  // namespace
}  // namespace polhode::contact::shape_tests
