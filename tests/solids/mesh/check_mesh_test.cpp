// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <polhode/core/error.hpp>
#include <polhode/solids/mesh/check_mesh.hpp>
#include <polhode/solids/mesh/generators.hpp>

namespace polhode::check_mesh_tests {
namespace {

solids::Mesh block(int cells, double at = 0.0) {
  solids::Mesh mesh = solids::make_mesh(
      "pad.msh", "block", {{"size", {1.0 * cells, 1, 1}}, {"cells", {1.0 * cells, 1, 1}}}, "hex8");
  solids::move(mesh, Mat3::Identity(), {at, 0, 0});
  return mesh;
}

/// Both meshes in one, with separate nodes.
solids::Mesh both(const solids::Mesh& a, const solids::Mesh& b) {
  solids::Mesh sum = a;
  const int shift = static_cast<int>(a.nodes.size());
  sum.nodes.insert(sum.nodes.end(), b.nodes.begin(), b.nodes.end());
  for (int node : b.blocks[0].nodes) sum.blocks[0].nodes.push_back(node + shift);
  return sum;
}

TEST(CheckMesh, NamesInvertedElements) {
  solids::Mesh mesh = block(3);
  std::swap(mesh.blocks[0].nodes[8], mesh.blocks[0].nodes[9]);
  std::swap(mesh.blocks[0].nodes[10], mesh.blocks[0].nodes[11]);
  std::swap(mesh.blocks[0].nodes[12], mesh.blocks[0].nodes[13]);
  std::swap(mesh.blocks[0].nodes[14], mesh.blocks[0].nodes[15]);
  try {
    solids::check_mesh(mesh);
    FAIL();
  } catch (const InputError& e) {
    EXPECT_STREQ(
        e.what(),
        "pad.msh: 1 element is inverted or collapsed: 2; element 2 (hex8) has det dX/dxi = "
        "-0.125 m^3. Mesh the part again, with smaller or straighter elements there.");
  }
}

/// Twice the same volume would weigh twice as much; the order of the nodes does not matter.
TEST(CheckMesh, RefusesAnElementThatIsGivenTwice) {
  solids::Mesh mesh = block(2);
  for (const int i : {1, 2, 3, 0, 5, 6, 7, 4})
    mesh.blocks[0].nodes.push_back(mesh.blocks[0].nodes[static_cast<std::size_t>(i)]);
  try {
    solids::check_mesh(mesh);
    FAIL();
  } catch (const InputError& e) {
    EXPECT_STREQ(
        e.what(),
        "pad.msh: 1 element is given twice: 3; element 3 has the nodes of element 1. Leave "
        "one of them out.");
  }
}

TEST(CheckMesh, DetectsAnElementThatIsInvertedAtOneNodeOnly) {
  solids::Mesh mesh =
      solids::make_mesh("m", "block", {{"size", {1, 1, 1}}, {"cells", {1, 1, 1}}}, "hex20");
  // A middle node beyond the quarter of its edge folds the edge over.
  const int middle = mesh.blocks[0].nodes[8], corner = mesh.blocks[0].nodes[0];
  mesh.nodes[middle] = 0.8 * mesh.nodes[corner] + 0.2 * mesh.nodes[mesh.blocks[0].nodes[1]];
  EXPECT_THROW(solids::check_mesh(mesh), InputError);
}

TEST(CheckMesh, ReportsSeparatePiecesAndCoincidentNodes) {
  const solids::Mesh mesh = both(block(1), block(2, 1.5));
  EXPECT_THAT(
      solids::check_mesh(mesh),
      testing::ElementsAre(
          testing::StartsWith("4 nodes lie on others, so that parts may not be connected: 9, 12, "
                              "15, 18; node 9 lies on node 2."),
          "the mesh has 2 pieces that share no node: 1 element with element 1, 2 elements with "
          "element 2. Merge duplicate nodes if they are one, or constrain every piece."));
}

TEST(CheckMesh, ReportsNodesOfNoElement) {
  solids::Mesh mesh = block(1);
  mesh.nodes.emplace_back(5, 5, 5);
  EXPECT_THAT(solids::check_mesh(mesh),
              testing::ElementsAre(
                  "1 node belongs to no element: 9. They are ignored; no action is needed."));
}

TEST(MergeDuplicateNodes, MakesOnePieceOfTwo) {
  solids::Mesh mesh = both(block(1), block(2, 1.5));
  mesh.node_sets["joint"] = {1, 8};
  EXPECT_EQ(solids::merge_duplicate_nodes(mesh), 4);
  EXPECT_EQ(mesh.nodes.size(), 16U);
  EXPECT_THAT(solids::check_mesh(mesh), testing::IsEmpty());
  EXPECT_EQ(solids::boundary(mesh).size(), 2 + 3 * 4);
  EXPECT_THAT(mesh.node_sets.at("joint"), testing::ElementsAre(1));
}

TEST(MergeDuplicateNodes, RefusesToCollapseAnElement) {
  solids::Mesh mesh = block(1);
  try {
    solids::merge_duplicate_nodes(mesh, 1.0);
    FAIL();
  } catch (const InputError& e) {
    EXPECT_STREQ(e.what(),
                 "pad.msh: merging nodes within 1 m makes nodes 1 and 2 of element 1 one. Merge "
                 "within a smaller distance.");
  }
}

TEST(PartOf, KeepsTheElementsOfAGroupWithItsSets) {
  solids::Mesh mesh = block(3);
  mesh.element_sets["rubber"] = {2};
  mesh.node_sets["tip"] = mesh.surfaces.at("xmax").nodes();
  mesh.node_sets["foot"] = mesh.surfaces.at("xmin").nodes();
  const solids::Mesh part = solids::part_of(mesh, "rubber");
  EXPECT_EQ(part.nodes.size(), 8U);
  EXPECT_EQ(part.element_count(), 1);
  EXPECT_EQ(part.surfaces.count("xmax"), 1U);
  EXPECT_EQ(part.surfaces.count("xmin"), 0U);
  EXPECT_EQ(part.node_sets.at("tip").size(), 4U);
  EXPECT_EQ(part.node_sets.count("foot"), 0U);
  EXPECT_EQ(part.node_label(0), 3);
  EXPECT_LT((solids::extent(part).least - Vec3(0.5, -0.5, -0.5)).norm(), 1e-15);
  EXPECT_EQ(solids::part_of(mesh, "").element_count(), 3);
  try {
    (void)solids::part_of(mesh, "ruber");
    FAIL();
  } catch (const InputError& e) {
    EXPECT_STREQ(e.what(),
                 "pad.msh: there is no group of elements 'ruber'. Did you mean 'rubber'? Groups of "
                 "elements: rubber.");
  }
}

}  // namespace
}  // namespace polhode::check_mesh_tests
