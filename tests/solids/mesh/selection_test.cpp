// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <polhode/core/error.hpp>
#include <polhode/solids/mesh/generators.hpp>
#include <polhode/solids/mesh/selection.hpp>

namespace polhode::selection_tests {
namespace {

using Kind = solids::Selection::Kind;
using Level = solids::Selection::Level;

/// 2 × 2 × 2 cells between −1 and 1.
solids::Mesh cube(const char* type = "hex8") {
  return solids::make_mesh("cube.mesh", "block", {{"size", {2, 2, 2}}, {"cells", {2, 2, 2}}}, type);
}

solids::Selection plane(const Vec3& normal, Level level, double value = 0.0) {
  solids::Selection s;
  s.kind = Kind::kPlane;
  s.normal = normal;
  s.level = level;
  s.value = value;
  return s;
}
solids::Selection named(const char* name) {
  solids::Selection s;
  s.kind = Kind::kSet;
  s.set = name;
  return s;
}
solids::Selection box(const Vec3& least, const Vec3& most) {
  solids::Selection s;
  s.kind = Kind::kBox;
  s.least = least;
  s.most = most;
  return s;
}
solids::Selection ball(double radius, bool on_surface) {
  solids::Selection s;
  s.kind = Kind::kSphere;
  s.radius = radius;
  s.on_surface = on_surface;
  return s;
}

std::size_t nodes(const solids::Mesh& mesh, const std::vector<solids::Selection>& s) {
  return solids::select_nodes("bonded.base", mesh, s).size();
}
int faces(const solids::Mesh& mesh, const std::vector<solids::Selection>& s) {
  return solids::select_faces("loads.push", mesh, s).size();
}

TEST(Selection, TakesNodes) {
  const solids::Mesh mesh = cube();
  EXPECT_EQ(nodes(mesh, {}), 27U);
  EXPECT_EQ(nodes(mesh, {plane(Vec3::UnitX(), Level::kMin)}), 9U);
  EXPECT_EQ(nodes(mesh, {plane(Vec3::Ones().normalized(), Level::kMax)}), 1U);
  EXPECT_EQ(nodes(mesh, {plane(Vec3::UnitX(), Level::kValue, 0.0)}), 9U);
  EXPECT_EQ(nodes(mesh, {box({-1, -1, 0}, {1, 1, 1})}), 18U);
  EXPECT_EQ(nodes(mesh, {ball(1.0, false)}), 7U);
  EXPECT_EQ(nodes(mesh, {ball(1.0, true)}), 6U);
  EXPECT_EQ(nodes(mesh, {named("xmin"), named("ymin")}), 15U);
  solids::Selection list;
  list.kind = Kind::kNodes;
  list.nodes = {4, 2, 4};
  EXPECT_EQ(nodes(mesh, {list}), 2U);
}

TEST(Selection, TakesFacesOfTheBoundaryThatFaceOutward) {
  for (const char* type : {"hex8", "hex20", "hex27"}) {
    const solids::Mesh mesh = cube(type);
    EXPECT_EQ(faces(mesh, {}), 24);
    EXPECT_EQ(faces(mesh, {named("xmax")}), 4);
    EXPECT_EQ(faces(mesh, {named("xmax"), plane(Vec3::UnitX(), Level::kMax)}), 4);
    EXPECT_EQ(faces(mesh, {named("xmax"), named("ymax")}), 8);
    EXPECT_EQ(faces(mesh, {box({0, -1, 1}, {1, 1, 1})}), 2);
    const solids::Surface top = solids::select_faces("", mesh, {plane(Vec3::UnitZ(), Level::kMax)});
    const solids::FaceBlock& block = top.blocks[0];
    for (int f = 0; f < block.size(); ++f) {
      const int* face = &block.nodes[block.shape().nodes.size() * static_cast<std::size_t>(f)];
      const Vec3 a = mesh.nodes[face[0]], b = mesh.nodes[face[1]], c = mesh.nodes[face[2]];
      EXPECT_GT((b - a).cross(c - a)[2], 0.0);
      EXPECT_GE(block.owners[f], 4);  // the upper layer
    }
  }
}

TEST(Selection, ReportsTheExtentOfTheMeshIfItIsEmpty) {
  const solids::Mesh mesh = cube();
  const auto message = [&](const solids::Selection& s, bool of_faces) {
    try {
      if (of_faces)
        (void)solids::select_faces("solids.pad.bonded.base", mesh, {s});
      else
        (void)solids::select_nodes("solids.pad.bonded.base", mesh, {s});
      return std::string("no error");
    } catch (const InputError& e) {
      return std::string(e.what());
    }
  };
  EXPECT_EQ(message(plane(Vec3::UnitZ(), Level::kValue, 1.5), false),
            "solids.pad.bonded.base: the plane with normal (0, 0, 1) at 1.5 m holds no node of the "
            "mesh; the nearest node is 0.5 m away. The mesh reaches from (-1, -1, -1) to (1, 1, 1) "
            "m.");
  EXPECT_EQ(message(box({2, -1, -1}, {3, 1, 1}), false),
            "solids.pad.bonded.base: the box from (2, -1, -1) to (3, 1, 1) m holds no node of the "
            "mesh; the nearest node is 1 m away. The mesh reaches from (-1, -1, -1) to (1, 1, 1) "
            "m.");
  EXPECT_EQ(
      message(ball(0.5, true), false),
      "solids.pad.bonded.base: the sphere about (0, 0, 0) of radius 0.5 m holds no node of the "
      "mesh; the nearest node is 0.5 m away. The mesh reaches from (-1, -1, -1) to (1, 1, 1) "
      "m.");
  EXPECT_EQ(
      message(ball(0.5, false), true),
      "solids.pad.bonded.base: the sphere about (0, 0, 0) of radius 0.5 m holds 1 node of the "
      "mesh, but no whole face of its boundary. The mesh reaches from (-1, -1, -1) to (1, 1, "
      "1) m.");
  EXPECT_EQ(message(named("xmim"), false),
            "solids.pad.bonded.base: the mesh has no set 'xmim'. Did you mean 'xmin'? Sets: xmax, "
            "xmin, ymax, ymin, zmax, zmin.");
}

}  // namespace
}  // namespace polhode::selection_tests
