// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <vector>

#include <polhode/core/format.hpp>
#include <polhode/solids/mesh/gmsh_file.hpp>

namespace polhode::solids {
namespace {

int read_dimension(GmshFile& file) {
  const auto dimension = file.read<std::int32_t>("the dimension of an entity");
  if (dimension < 0 || dimension > 3)
    file.in.refuse(format("an entity cannot have the dimension {}", dimension), kExportMeshAgain,
                   file.binary);
  return dimension;
}

void skip_integers(GmshFile& file, const char* things) {
  const std::size_t n = file.count<std::uint64_t>(things, 2, 4);
  for (std::size_t i = 0; i < n; ++i) (void)file.read<std::int32_t>(things);
}

/// Order of the counts in the first line of a section: blocks, objects, smallest and largest tag.
struct Announced {
  std::size_t blocks;
  std::size_t things;
};
Announced read_counts(GmshFile& file, const char* things, std::size_t text_bytes,
                      std::size_t binary_bytes) {
  Announced counts{};
  counts.blocks = file.count<std::uint64_t>("blocks", 8, 20);
  counts.things = file.count<std::uint64_t>(things, text_bytes, binary_bytes);
  (void)file.read<std::uint64_t>("the smallest number");
  (void)file.read<std::uint64_t>("the largest number");
  return counts;
}

void check_total(const GmshFile& file, std::size_t found, std::size_t announced,
                 const char* things) {
  if (found != announced)
    file.in.refuse(format("{} {} are announced, but the blocks hold {}", announced, things, found),
                   kExportMeshAgain, file.binary);
}

}  // namespace

void read_gmsh4_entities(GmshFile& file, GmshEntities& entities, bool partitioned) {
  if (partitioned) {
    (void)file.read<std::uint64_t>("the number of partitions");
    const std::size_t ghosts = file.count<std::uint64_t>("ghost entities", 4, 8);
    for (std::size_t i = 0; i < 2 * ghosts; ++i) (void)file.read<std::int32_t>("a ghost entity");
  }
  std::array<std::size_t, 4> counts{};
  for (std::size_t& n : counts) n = file.count<std::uint64_t>("entities", 10, 36);
  for (int dimension = 0; dimension < 4; ++dimension)
    for (std::size_t i = 0; i < counts[static_cast<std::size_t>(dimension)]; ++i) {
      const auto tag = file.read<std::int32_t>("the number of an entity");
      if (partitioned) {
        (void)file.read<std::int32_t>("the dimension of the parent");
        (void)file.read<std::int32_t>("the number of the parent");
        skip_integers(file, "partitions");
      }
      const int numbers = dimension == 0 ? 3 : 6;
      for (int k = 0; k < numbers; ++k) (void)file.read<double>("a coordinate");
      const std::size_t groups = file.count<std::uint64_t>("groups", 2, 4);
      std::vector<std::int64_t>& of_entity = entities[{dimension, tag}];
      of_entity.clear();
      for (std::size_t g = 0; g < groups; ++g)
        of_entity.push_back(file.read<std::int32_t>("the number of a group"));
      if (dimension > 0) skip_integers(file, "bounding entities");
    }
}

void read_gmsh4_nodes(GmshFile& file) {
  const Announced counts = read_counts(file, "nodes", 8, 32);
  std::size_t found = 0;
  struct Label {
    std::int64_t label;
    std::size_t at;
  };
  std::vector<Label> labels;
  for (std::size_t b = 0; b < counts.blocks; ++b) {
    const int dimension = read_dimension(file);
    (void)file.read<std::int32_t>("the number of an entity");
    const auto parametric = file.read<std::int32_t>("0 or 1 (parametric)");
    if (parametric != 0 && parametric != 1)
      file.in.refuse(format("0 or 1 (parametric) is expected, but {} is found", parametric),
                     kExportMeshAgain, file.binary);
    const std::size_t n = file.count<std::uint64_t>("nodes", 8, 32);
    labels.clear();
    for (std::size_t i = 0; i < n; ++i) {
      const auto label =
          static_cast<std::int64_t>(file.read<std::uint64_t>("the number of a node"));
      labels.push_back({label, file.in.token()});
    }
    for (const Label& node : labels) {
      file.mesh.add_node(node.label, file.read_point(), node.at);
      for (int k = 0; k < dimension * parametric; ++k) (void)file.read<double>("a parameter");
    }
    found += n;
  }
  check_total(file, found, counts.things, "nodes");
}

void read_gmsh4_elements(GmshFile& file, const GmshEntities& entities) {
  const Announced counts = read_counts(file, "elements", 4, 16);
  std::size_t found = 0;
  for (std::size_t b = 0; b < counts.blocks; ++b) {
    const int dimension = read_dimension(file);
    const auto entity = file.read<std::int32_t>("the number of an entity");
    const auto type = file.read<std::int32_t>("the type of elements");
    const std::size_t nodes = file.nodes_of_type(type);
    const std::size_t n = file.count<std::uint64_t>("elements", 2 * (1 + nodes), 8 * (1 + nodes));
    const auto groups = entities.find({dimension, entity});
    std::vector<std::string> sets;
    if (groups != entities.end())
      for (std::int64_t tag : groups->second)
        sets.push_back(file.group(dimension, tag < 0 ? -tag : tag));
    if (sets.empty()) sets.push_back(GmshFile::entity(dimension, entity));
    for (std::size_t i = 0; i < n; ++i) {
      const auto label =
          static_cast<std::int64_t>(file.read<std::uint64_t>("the number of an element"));
      const int cell = file.read_cell(type, label, file.in.token(), true);
      if (i == 0 && file.mesh.shape(cell).dimension != dimension)
        file.in.refuse(
            format("elements of type {} cannot fill an entity of dimension {}", type, dimension),
            kExportMeshAgain, file.binary);
      for (const std::string& set : sets) file.mesh.put(cell, set);
    }
    found += n;
  }
  check_total(file, found, counts.things, "elements");
}

}  // namespace polhode::solids
