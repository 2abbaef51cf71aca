// SPDX-License-Identifier: Apache-2.0
// Prisms of 15 nodes in the orders of Abaqus, Gmsh and VTK, and lists of 15 nodes.
#include <array>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <polhode/core/format.hpp>
#include <polhode/solids/mesh/check_mesh.hpp>
#include <polhode/solids/mesh/generators.hpp>
#include <polhode/solids/mesh/read_mesh.hpp>

namespace polhode::quadratic_wedges_tests {
namespace {

using Edge = std::array<int, 2>;

/// Corners of a prism of volume 1; the triangle 0 1 2 faces 3 4 5.
const std::vector<Vec3> kCorners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 2}, {1, 0, 2}, {0, 1, 2}};

/// Its nodes, with those in the middles of edges in the order of a format.
std::vector<Vec3> prism(const std::vector<Edge>& edges, const std::vector<Vec3>& corners) {
  std::vector<Vec3> X = corners;
  for (const Edge& e : edges)
    X.push_back(
        0.5 * (corners[static_cast<std::size_t>(e[0])] + corners[static_cast<std::size_t>(e[1])]));
  return X;
}

/// The usual order, of Abaqus and FEBio.
const std::vector<Edge> kUsual{{0, 1}, {1, 2}, {2, 0}, {3, 4}, {4, 5},
                               {5, 3}, {0, 3}, {1, 4}, {2, 5}};

/// One prism whose nodes are at the middles of its edges.
void expect_prism(const solids::Mesh& mesh) {
  ASSERT_EQ(mesh.blocks.size(), 1U);
  ASSERT_EQ(mesh.blocks[0].type, "wedge15");
  ASSERT_EQ(mesh.element_count(), 1);
  EXPECT_THAT(solids::mesh_faults(mesh), testing::IsEmpty());
  EXPECT_NEAR(solids::element_volume(mesh, 0), 1.0, 1e-14);
  const solids::CellShape& shape = mesh.element_shape(0);
  const auto X = [&](int local) {
    return mesh
        .nodes[static_cast<std::size_t>(mesh.element_nodes(0)[static_cast<std::size_t>(local)])];
  };
  for (const solids::CellEdge& e : shape.edges)
    EXPECT_EQ(X(e.middle), Vec3(0.5 * (X(e.begin) + X(e.end))));
  const solids::Surface outside = solids::boundary(mesh);
  ASSERT_EQ(outside.blocks.size(), 2U);
  EXPECT_EQ(outside.size(), 5);
}

TEST(QuadraticWedge, HasAbaqusOrder) {
  std::string text = "*NODE\n", list;
  int k = 0;
  for (const Vec3& x : prism(kUsual, kCorners)) {
    text += format("{}, {}, {}, {}\n", ++k, x[0], x[1], x[2]);
    list += format(", {}", k);
  }
  expect_prism(solids::parse_mesh("prism.inp", text + "*ELEMENT, TYPE=C3D15\n1" + list + "\n"));
}

TEST(QuadraticWedge, HasGmshOrder) {
  std::string text = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n15\n", list;
  int k = 0;
  for (const Vec3& x :
       prism({{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 4}, {2, 5}, {3, 4}, {3, 5}, {4, 5}}, kCorners)) {
    text += format("{} {} {} {}\n", ++k, x[0], x[1], x[2]);
    list += format(" {}", k);
  }
  text += "$EndNodes\n$Elements\n1\n1 18 2 1 1" + list + "\n$EndElements\n";
  expect_prism(solids::parse_mesh("prism.msh", text));
}

// VTK's triangle 0 1 2 faces away from 3 4 5, as its faces 0 1 2 and 3 5 4 point outward; the usual
// order is read too.
TEST(QuadraticWedge, HasTheOrderOfVtkOrTheUsualOne) {
  for (const bool usual : {false, true}) {
    std::vector<Vec3> corners = kCorners;
    if (!usual) {
      std::swap(corners[1], corners[2]);
      std::swap(corners[4], corners[5]);
    }
    std::string points, list;
    int k = 0;
    for (const Vec3& x : prism(kUsual, corners)) {
      points += format("{} {} {} ", x[0], x[1], x[2]);
      list += format("{} ", k++);
    }
    const std::string text =
        "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\">"
        "<UnstructuredGrid><Piece NumberOfPoints=\"15\" NumberOfCells=\"1\"><Points>"
        "<DataArray type=\"Float64\" Name=\"Points\" NumberOfComponents=\"3\" format=\"ascii\">" +
        points +
        "</DataArray></Points><Cells>"
        "<DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">" +
        list +
        "</DataArray><DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">15</DataArray>"
        "<DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">26</DataArray></Cells>"
        "</Piece></UnstructuredGrid></VTKFile>";
    expect_prism(solids::parse_mesh("prism.vtu", text));
  }
}

// A list of 15 nodes is the type that has them in the middles of its edges, also when these are
// bent.
TEST(InlineMesh, TellsPrismsFromTetrahedraOf15Nodes) {
  std::vector<Vec3> X = prism(kUsual, kCorners);
  for (std::size_t k = 6; k < X.size(); ++k) X[k] += Vec3(0.05, -0.04, 0.1);
  std::vector<int> all;
  for (int k = 0; k < 15; ++k) all.push_back(k);
  EXPECT_EQ(solids::inline_mesh("m", X, {all}, {}).blocks[0].type, "wedge15");
  const solids::Mesh tets =
      solids::make_mesh("m", "sphere", {{"diameter", {1}}, {"cells", {1, 1}}}, "tet15");
  std::vector<std::vector<int>> cells;
  for (int e = 0; e < tets.element_count(); ++e) {
    const std::span<const int> nodes = tets.element_nodes(e);
    cells.emplace_back(nodes.begin(), nodes.end());
  }
  const solids::Mesh again = solids::inline_mesh("m", tets.nodes, cells, {});
  ASSERT_EQ(again.blocks.size(), 1U);
  EXPECT_EQ(again.blocks[0].type, "tet15");
}

}  // namespace
}  // namespace polhode::quadratic_wedges_tests
