// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstdlib>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/solids/mesh/gmsh_file.hpp>
#include <polhode/solids/mesh/read_mesh.hpp>

namespace polhode::solids {
namespace {

/// A type of Gmsh element: our shape, and Gmsh's position of our node i.
struct GmshType {
  const char* shape;       ///< Null: not supported.
  const char* name;        ///< Gmsh's name.
  std::vector<int> order;  ///< Empty: the same.
};

const GmshType* gmsh_type(std::int64_t type) {
  static const std::map<std::int64_t, GmshType> types{
      {1, {"line2", "2-node line", {}}},
      {2, {"tri3", "3-node triangle", {}}},
      {3, {"quad4", "4-node quadrangle", {}}},
      {4, {"tet4", "4-node tetrahedron", {}}},
      {5, {"hex8", "8-node hexahedron", {}}},
      {6, {"wedge6", "6-node prism", {}}},
      {7, {nullptr, "5-node pyramid", {}}},
      {8, {"line3", "3-node line", {}}},
      {9, {"tri6", "6-node triangle", {}}},
      {10, {"quad9", "9-node quadrangle", {}}},
      {11, {"tet10", "10-node tetrahedron", {0, 1, 2, 3, 4, 5, 6, 7, 9, 8}}},
      {12, {"hex27", "27-node hexahedron", {0,  1,  2,  3,  4,  5,  6,  7,  8,  11, 13, 9,  16, 18,
                                            19, 17, 10, 12, 14, 15, 22, 23, 21, 24, 20, 25, 26}}},
      {13, {nullptr, "18-node prism", {}}},
      {14, {nullptr, "14-node pyramid", {}}},
      {15, {"point", "1-node point", {}}},
      {16, {"quad8", "8-node quadrangle", {}}},
      {17, {"hex20", "20-node hexahedron", {0,  1, 2,  3,  4,  5,  6,  7,  8,  11,
                                            13, 9, 16, 18, 19, 17, 10, 12, 14, 15}}},
      {18, {"wedge15", "15-node prism", {0, 1, 2, 3, 4, 5, 6, 9, 7, 12, 14, 13, 8, 10, 11}}},
      {19, {nullptr, "13-node pyramid", {}}},
  };
  const auto found = types.find(type);
  return found == types.end() ? nullptr : &found->second;
}

const GmshType& supported_type(const GmshFile& file, std::int64_t type) {
  const GmshType* found = gmsh_type(type);
  if (found && found->shape) return *found;
  file.in.refuse(
      found ? format("elements of type {} ({}) are not supported", type, found->name)
            : format("there is no element type {}", type),
      "Mesh with hexahedra of 8, 20 or 27 nodes, tetrahedra of 4 or 10, or prisms of 6 or 15",
      file.binary);
}

constexpr const char* kVersions = "Save the mesh in format 4.1 or 2.2 (Mesh.MshFileVersion)";

/// Reads $MeshFormat; the section's name has been read. @returns 2 or 4.
int read_header(GmshFile& file) {
  MeshCursor& in = file.in;
  const double version = in.number("the version of the format");
  const bool two = version >= 2.0 && version < 3.0;
  if (!two && version != 4.1)
    in.refuse(format("version {} of the format is not supported", version), kVersions);
  const std::int64_t kind = in.integer("the kind of file, 0 or 1");
  if (kind != 0 && kind != 1)
    in.refuse(format("the kind of file is {}, but 0 (text) or 1 (binary) is expected", kind),
              kExportMeshAgain);
  const std::int64_t size = in.integer("the size of numbers");
  if (size != 8)
    in.refuse(format("numbers of {} bytes are not supported, only those of 8", size), kVersions);
  in.line();
  file.binary = kind == 1;
  if (file.binary) {
    const auto one = in.binary<std::int32_t>("the number 1");
    in.swap = one == 0x01000000;
    if (one != 1 && !in.swap)
      in.refuse(format("the byte order is unknown: 1 reads as {}", one), kExportMeshAgain, true);
  }
  file.expect_end("MeshFormat");
  return two ? 2 : 4;
}

void read_names(GmshFile& file) {
  MeshCursor& in = file.in;
  const std::size_t n = in.count(in.integer("the number of names"), 6, "names", false);
  for (std::size_t i = 0; i < n; ++i) {
    const std::int64_t dimension = in.integer("a dimension");
    if (dimension < 0 || dimension > 3)
      in.refuse(format("a group cannot have the dimension {}", dimension), kExportMeshAgain);
    const std::int64_t tag = in.integer("the number of a group");
    const std::string_view name = in.line();
    if (name.size() < 2 || name.front() != '"' || name.back() != '"')
      in.refuse(format("a name in double quotes is expected, but {} is found", quote(name)),
                kExportMeshAgain);
    file.names[{static_cast<int>(dimension), tag}] = name.substr(1, name.size() - 2);
  }
}

void skip_section(MeshCursor& in, const std::string& section) {
  const std::string end = "$End" + section;
  const std::size_t found = in.bytes().find(end, in.at());
  if (found == std::string_view::npos) {
    in.go_to(in.bytes().size());
    in.refuse_end(end, false);
  }
  in.go_to(found);
}

}  // namespace

std::string GmshFile::group(int dimension, std::int64_t tag) const {
  const auto found = names.find({dimension, tag});
  return found == names.end() ? entity(dimension, tag) : found->second;
}

std::string GmshFile::entity(int dimension, std::int64_t tag) {
  static constexpr std::array<const char*, 4> kKinds{"point", "curve", "surface", "volume"};
  return format("{}_{}", kKinds[static_cast<std::size_t>(dimension)], tag);
}

std::size_t GmshFile::nodes_of_type(std::int64_t type) const {
  return cell_shape(supported_type(*this, type).shape).nodes.size();
}

int GmshFile::read_cell(std::int64_t type, std::int64_t label, std::size_t at, bool wide) {
  const GmshType& known = supported_type(*this, type);
  const CellShape& shape = cell_shape(known.shape);
  std::array<std::int64_t, 27> given{}, ordered{};
  const std::size_t n = shape.nodes.size();
  for (std::size_t i = 0; i < n; ++i)
    given[i] = wide ? static_cast<std::int64_t>(read<std::uint64_t>("the number of a node"))
                    : read<std::int32_t>("the number of a node");
  for (std::size_t i = 0; i < n; ++i)
    ordered[i] = known.order.empty() ? given[i] : given[static_cast<std::size_t>(known.order[i])];
  return mesh.add_cell(shape, label, {ordered.data(), n}, at);
}

void GmshFile::expect_end(const std::string& section) {
  const std::string end = "$End" + section;
  const std::string_view found = in.word();
  if (found.empty()) in.refuse_end(end, false);
  if (found != end)
    in.refuse(format("{} is expected here, but {} is found", end, quote(found)), kExportMeshAgain);
}

Mesh parse_gmsh(const std::string& name, std::string_view bytes) {
  MeshCursor in(name, bytes);
  if (in.word() != "$MeshFormat") in.refuse("a Gmsh file begins with '$MeshFormat'", kVersions);
  MeshBuilder probe(in, false);
  GmshFile header{.in = in, .mesh = probe, .binary = false, .names = {}};
  const int version = read_header(header);
  MeshBuilder mesh(in, header.binary);
  mesh.repeated_cells_are_one = version == 2;
  GmshFile file{.in = in, .mesh = mesh, .binary = header.binary, .names = {}};
  GmshEntities entities;
  bool elements = false;
  for (std::string_view word = in.word(); !word.empty(); word = in.word()) {
    if (word.front() != '$' || word.starts_with("$End"))
      in.refuse(format("a section is expected here, but {} is found", quote(word)),
                kExportMeshAgain);
    const std::string section(word.substr(1));
    in.line();
    if (section == "PhysicalNames") {
      read_names(file);
    } else if (section == "Nodes") {
      version == 2 ? read_gmsh2_nodes(file) : read_gmsh4_nodes(file);
    } else if (section == "Elements") {
      version == 2 ? read_gmsh2_elements(file) : read_gmsh4_elements(file, entities);
      elements = true;
    } else if (version == 4 && (section == "Entities" || section == "PartitionedEntities")) {
      if (elements) in.refuse("the entities come after the elements", kExportMeshAgain);
      read_gmsh4_entities(file, entities, section == "PartitionedEntities");
    } else if (section == "ParametricNodes") {
      in.refuse("nodes with parametric coordinates are not supported in this version",
                "Save without them (Mesh.SaveParametric = 0), or in format 4.1");
    } else {
      skip_section(in, section);  // comments, data, periodicity etc.
    }
    file.expect_end(section);
  }
  return mesh.finish();
}

}  // namespace polhode::solids
