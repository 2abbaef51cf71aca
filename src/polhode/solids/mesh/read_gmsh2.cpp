// SPDX-License-Identifier: Apache-2.0
#include <cstdlib>
#include <vector>

#include <polhode/core/format.hpp>
#include <polhode/solids/mesh/gmsh_file.hpp>

namespace polhode::solids {
namespace {

/// Adds a cell to the set of its physical group, else of its entity.
void put(GmshFile& file, int cell, const std::vector<std::int64_t>& tags) {
  const int dimension = file.mesh.shape(cell).dimension;
  if (!tags.empty() && tags[0] != 0)
    file.mesh.put(cell, file.group(dimension, std::abs(tags[0])));
  else if (tags.size() > 1)
    file.mesh.put(cell, GmshFile::entity(dimension, std::abs(tags[1])));
}

/// The tags of an element: group, entity, partitions.
void read_tags(GmshFile& file, std::size_t n, std::vector<std::int64_t>& tags) {
  tags.clear();
  for (std::size_t i = 0; i < n; ++i) tags.push_back(file.read<std::int32_t>("a tag"));
}

std::size_t count_of_tags(const GmshFile& file, std::int64_t n) {
  return file.in.count(n, file.binary ? 4 : 2, "tags", file.binary);
}

}  // namespace

void read_gmsh2_nodes(GmshFile& file) {
  MeshCursor& in = file.in;
  const std::size_t n =
      in.count(in.integer("the number of nodes"), file.binary ? 28 : 8, "nodes", false);
  in.line();
  for (std::size_t i = 0; i < n; ++i) {
    const auto label = file.binary ? file.read<std::int32_t>("the number of a node")
                                   : in.integer("the number of a node");
    const std::size_t at = in.token();
    file.mesh.add_node(label, file.read_point(), at);
  }
}

void read_gmsh2_elements(GmshFile& file) {
  MeshCursor& in = file.in;
  const std::size_t n =
      in.count(in.integer("the number of elements"), file.binary ? 4 : 6, "elements", false);
  in.line();
  std::vector<std::int64_t> tags;
  if (!file.binary) {
    for (std::size_t i = 0; i < n; ++i) {
      const std::int64_t label = in.integer("the number of an element");
      const std::size_t at = in.token();
      const std::int64_t type = in.integer("the type of an element");
      (void)file.nodes_of_type(type);
      read_tags(file, count_of_tags(file, in.integer("the number of tags")), tags);
      put(file, file.read_cell(type, label, at, false), tags);
    }
    return;
  }
  for (std::size_t done = 0; done < n;) {
    const auto type = file.read<std::int32_t>("the type of elements");
    const std::size_t nodes = file.nodes_of_type(type);
    const std::size_t at = in.token();
    const auto follow = file.read<std::int32_t>("the number of elements that follow");
    const auto of_tags = file.read<std::int32_t>("the number of tags");
    const std::size_t tags_each = count_of_tags(file, of_tags);
    const std::size_t block = in.count(follow, 4 * (1 + tags_each + nodes), "elements", true);
    if (block == 0 || block > n - done) {
      in.go_to(at);
      in.refuse(format("{} elements follow, but {} of {} are still to come", block, n - done, n),
                kExportMeshAgain, true);
    }
    for (std::size_t i = 0; i < block; ++i) {
      const auto label = file.read<std::int32_t>("the number of an element");
      const std::size_t begin = in.token();
      read_tags(file, tags_each, tags);
      put(file, file.read_cell(type, label, begin, false), tags);
    }
    done += block;
  }
}

}  // namespace polhode::solids
