// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <polhode/core/error.hpp>
#include <polhode/solids/mesh/check_mesh.hpp>
#include <polhode/solids/mesh/read_mesh.hpp>

#include <support/paths.hpp>

namespace polhode::read_mesh_tests {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

std::string folder() { return test::source_dir() + "/tests/solids/mesh/data"; }

std::vector<std::string> files() {
  std::vector<std::string> all;
  for (const auto& entry : std::filesystem::directory_iterator(folder()))
    if (entry.path().extension() != ".md") all.push_back(entry.path().filename());
  std::sort(all.begin(), all.end());
  return all;
}

std::string bytes_of(const std::string& file) {
  std::ifstream stream(folder() + "/" + file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

/// Area vector of a plane face by its corners.
Vec3 area(const solids::Mesh& mesh, const solids::FaceBlock& block, int face) {
  const int n = block.shape().size(), corners = block.shape().corners;
  const int* node = &block.nodes[static_cast<std::size_t>(n * face)];
  Vec3 sum = Vec3::Zero();
  for (int i = 1; i + 1 < corners; ++i)
    sum += 0.5 * (mesh.nodes[node[i]] - mesh.nodes[node[0]])
                     .cross(mesh.nodes[node[i + 1]] - mesh.nodes[node[0]]);
  return sum;
}
Vec3 area(const solids::Mesh& mesh, const solids::Surface& surface) {
  Vec3 sum = Vec3::Zero();
  for (const solids::FaceBlock& block : surface.blocks)
    for (int f = 0; f < block.size(); ++f) sum += area(mesh, block, f);
  return sum;
}

// Files of Gmsh and meshio: two blocks of 2 × 1 × 0.5, one above the other (data/README.md). Their
// text is rounded to 5e-12.
class MeshFile : public testing::TestWithParam<std::string> {
 protected:
  solids::Mesh mesh_ = solids::read_mesh(folder() + "/" + GetParam());
  std::string type_ = GetParam().substr(0, GetParam().find_first_of("_."));
  static constexpr double kRounding = 1e-11;
};

TEST_P(MeshFile, HasElementsOfItsType) {
  ASSERT_EQ(mesh_.blocks.size(), 1U);
  EXPECT_EQ(mesh_.blocks[0].type, type_);
  EXPECT_THAT(solids::mesh_faults(mesh_), IsEmpty());
}

// A misplaced node would not be in the middle of its edge, face or cell.
TEST_P(MeshFile, HasItsNodesAtTheirPositions) {
  const solids::CellShape& shape = mesh_.blocks[0].shape();
  const solids::CellShape& linear = solids::cell_shape(shape.corners == 8   ? "hex8"
                                                       : shape.corners == 4 ? "tet4"
                                                                            : "wedge6");
  for (int e = 0; e < mesh_.element_count(); ++e) {
    const std::span<const int> nodes = mesh_.element_nodes(e);
    for (int a = shape.corners; a < shape.size(); ++a) {
      const Vec N = solids::shape_functions(linear, shape.nodes[a]);
      Vec3 X = Vec3::Zero();
      for (int i = 0; i < shape.corners; ++i) X += N[i] * mesh_.nodes[nodes[i]];
      EXPECT_LT((X - mesh_.nodes[nodes[a]]).norm(), kRounding) << "element " << e << " node " << a;
    }
  }
}

TEST_P(MeshFile, FillsItsVolume) {
  double volume = 0.0;
  for (int e = 0; e < mesh_.element_count(); ++e) {
    const double one = solids::element_volume(mesh_, e);
    EXPECT_GT(one, 0.0);
    volume += one;
  }
  EXPECT_NEAR(volume, 2.0, 10.0 * kRounding);
  EXPECT_LT(area(mesh_, solids::boundary(mesh_)).norm(), 10.0 * kRounding);
  EXPECT_LT((solids::extent(mesh_).most - Vec3(2, 1, 1)).norm(), kRounding);
}

TEST_P(MeshFile, HasItsGroups) {
  const bool gmsh = GetParam().ends_with(".msh");
  const bool vtu = GetParam().ends_with(".vtu");
  const int half = mesh_.element_count() / 2;
  const std::string lower = gmsh ? "lower half" : vtu ? "material_1" : "Volume1";
  const std::string upper = gmsh ? "upper" : vtu ? "material_2" : "Volume2";
  ASSERT_EQ(mesh_.element_sets.count(lower), 1U);
  EXPECT_EQ(mesh_.element_sets.at(upper).size(), static_cast<std::size_t>(half));
  const solids::Mesh part = solids::part_of(mesh_, lower);
  EXPECT_LT((solids::extent(part).most - Vec3(2, 1, 0.5)).norm(), kRounding);
  if (gmsh) {
    EXPECT_EQ(mesh_.element_sets.at("volume_9").size(), 2 * static_cast<std::size_t>(half));
    EXPECT_EQ(mesh_.node_sets.at("corner").size(), 1U);
    EXPECT_LT(mesh_.nodes[mesh_.node_sets.at("corner")[0]].norm(), kRounding);
  }
  if (vtu) {
    for (int node : mesh_.node_sets.at("foot")) EXPECT_NEAR(mesh_.nodes[node][2], 0.0, kRounding);
    return;
  }
  // Surfaces face outward in any order of nodes in the file; the surface between the blocks faces
  // out of either.
  const std::string foot = gmsh ? "foot" : "Surface5", top = gmsh ? "top" : "Surface49";
  EXPECT_LT((area(mesh_, mesh_.surfaces.at(foot)) - Vec3(0, 0, -2)).norm(), 10.0 * kRounding);
  EXPECT_LT((area(mesh_, mesh_.surfaces.at(top)) - Vec3(0, 0, 2)).norm(), 10.0 * kRounding);
  const solids::Surface& between = mesh_.surfaces.at(gmsh ? "between" : "Surface27");
  EXPECT_NEAR(std::abs(area(mesh_, between)[2]), 2.0, 10.0 * kRounding);
  for (const solids::FaceBlock& block : mesh_.surfaces.at(top).blocks)
    for (int owner : block.owners) {
      const auto& set = mesh_.element_sets.at(upper);
      EXPECT_TRUE(std::binary_search(set.begin(), set.end(), owner));
    }
}

// A file cut at up to 300 lengths gives a located error or, near its end, the mesh.
TEST_P(MeshFile, CutShortIsRefused) {
  const std::string bytes = bytes_of(GetParam());
  int whole = 0, refused = 0;
  for (std::size_t length = 0; length < bytes.size(); length += 1 + bytes.size() / 300) {
    try {
      (void)solids::parse_mesh(GetParam(), std::string_view(bytes).substr(0, length));
      ++whole;
    } catch (const InputError& e) {
      EXPECT_THAT(e.where(), testing::StartsWith(GetParam()));
      EXPECT_FALSE(e.hint().empty());
      ++refused;
    }
  }
  EXPECT_GT(refused, 20);
  // Abaqus files have no end mark; the other formats detect a missing one.
  if (!GetParam().ends_with(".inp")) {
    EXPECT_LE(whole, 8);
  }
}

// Bytes overwritten at positions of a fixed rule: the result is a mesh or an InputError.
TEST_P(MeshFile, DamagedIsReadOrRefused) {
  const std::string bytes = bytes_of(GetParam());
  std::uint32_t random = 12345;
  for (int trial = 0; trial < 300; ++trial) {
    std::string damaged = bytes;
    for (int i = 0; i < 1 + trial % 4; ++i) {
      random = random * 1664525U + 1013904223U;
      const std::size_t at = (random >> 8) % damaged.size();
      damaged[at] = trial % 2 ? static_cast<char>(random >> 3) : "0 9-\n<,$"[random >> 29];
    }
    try {
      const solids::Mesh mesh = solids::parse_mesh(GetParam(), damaged);
      EXPECT_GT(mesh.element_count(), 0);
    } catch (const InputError& e) {
      EXPECT_FALSE(e.what_is_wrong().empty());
    }
  }
}

std::string test_name(const testing::TestParamInfo<std::string>& one) {
  std::string name = one.param;
  std::replace(name.begin(), name.end(), '.', '_');
  return name;
}
INSTANTIATE_TEST_SUITE_P(Files, MeshFile, testing::ValuesIn(files()), test_name);

// Files on which fuzzers once found failures.
TEST(ReadMesh, ReadsOrRefusesFilesFoundByFuzzers) {
  int inputs = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(test::source_dir() + "/tests/fuzz/found_in_meshes")) {
    std::ifstream stream(entry.path(), std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(stream),
                            std::istreambuf_iterator<char>()};
    for (const char* name : {"a.msh", "a.vtu", "a.inp"}) {
      try {
        (void)solids::mesh_faults(solids::parse_mesh(name, bytes));
      } catch (const InputError& e) {
        EXPECT_FALSE(e.what_is_wrong().empty());
      }
    }
    ++inputs;
  }
  EXPECT_GT(inputs, 0);
}

TEST(ReadMesh, ScalesToMetres) {
  const solids::Mesh mesh = solids::read_mesh(folder() + "/hex8_4_text.msh", 0.001);
  EXPECT_LT((solids::extent(mesh).most - Vec3(2e-3, 1e-3, 1e-3)).norm(), 1e-14);
  EXPECT_THROW((void)solids::read_mesh(folder() + "/hex8_4_text.msh", 0.0), InputError);
}

TEST(ReadMesh, ListsTheFileTypesItReads) {
  const auto message = [](const std::string& path) {
    try {
      (void)solids::read_mesh(path);
      return std::string("no error");
    } catch (const InputError& e) {
      return std::string(e.what());
    }
  };
  EXPECT_THAT(message("nowhere.msh"), HasSubstr("cannot be opened"));
  EXPECT_THAT(message(folder()), HasSubstr("a directory is not a mesh"));
  EXPECT_THAT(message(folder() + "/README.md"),
              HasSubstr("a mesh cannot be read from a file ending in '.md'. Use .msh (Gmsh 2.2 or "
                        "4.1), .vtu (VTK) or .inp (Abaqus)."));
}

}  // namespace
}  // namespace polhode::read_mesh_tests
