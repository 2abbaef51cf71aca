// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <polhode/core/format.hpp>
#include <polhode/solids/mesh/mesh_builder.hpp>
#include <polhode/solids/mesh/mesh_cursor.hpp>

namespace polhode::solids {

/// A Gmsh file while it is read. Numbers are text or binary, as the file's header says.
struct GmshFile {
  MeshCursor& in;
  MeshBuilder& mesh;
  bool binary = false;
  /// Names of physical groups, by dimension and number.
  std::map<std::pair<int, std::int64_t>, std::string> names;

  /// The next number. @param what  What is expected, for messages.
  template <class T>
  T read(const char* what) {
    if (binary) return in.binary<T>(what);
    if constexpr (std::is_floating_point_v<T>)
      return in.number(what);
    else
      return whole<T>(in.integer(what), what);
  }
  /// A count of objects of some bytes each: in text, and in binary.
  template <class T>
  std::size_t count(const char* things, std::size_t text_bytes, std::size_t binary_bytes) {
    const auto n = static_cast<std::int64_t>(read<T>("a count"));
    return in.count(n, binary ? binary_bytes : text_bytes, things, binary);
  }
  template <class T>
  T whole(std::int64_t value, const char* what) const {
    if (!std::in_range<T>(value))
      in.refuse(format("{} is expected here, but {} is out of range", what, value),
                kExportMeshAgain);
    return static_cast<T>(value);
  }
  Vec3 read_point() {
    Vec3 x;
    for (double& coordinate : x) coordinate = read<double>("a coordinate");
    return x;
  }

  /// Name of an entity, or of a group without a name: "volume_3".
  [[nodiscard]] static std::string entity(int dimension, std::int64_t tag);
  /// Name of a physical group.
  [[nodiscard]] std::string group(int dimension, std::int64_t tag) const;
  /// Reads the nodes of a cell of a Gmsh type and adds it.
  int read_cell(std::int64_t type, std::int64_t label, std::size_t at, bool wide);
  /// Number of nodes of a Gmsh type. @throws InputError, naming a type that is not supported.
  [[nodiscard]] std::size_t nodes_of_type(std::int64_t type) const;
  /// Rejects everything but the end of a section.
  void expect_end(const std::string& section);
};

void read_gmsh2_nodes(GmshFile& file);
void read_gmsh2_elements(GmshFile& file);

/// Physical groups of the entities of a file of version 4, by dimension and entity.
using GmshEntities = std::map<std::pair<int, std::int64_t>, std::vector<std::int64_t>>;
void read_gmsh4_entities(GmshFile& file, GmshEntities& entities, bool partitioned);
void read_gmsh4_nodes(GmshFile& file);
void read_gmsh4_elements(GmshFile& file, const GmshEntities& entities);

}  // namespace polhode::solids
