// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <set>
#include <span>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/core/names.hpp>
#include <polhode/solids/mesh/mesh_builder.hpp>
#include <polhode/solids/mesh/read_mesh.hpp>
#include <polhode/solids/mesh/vtk_array.hpp>

namespace polhode::solids {
namespace {

constexpr std::int64_t kMaxThings = 2'000'000'000;
/// Number of different values of an integer array above which it does not define sets.
constexpr std::size_t kMaxSets = 1000;

constexpr int kVoxel = 11;
constexpr int kPixel = 8;
constexpr std::array<int, 8> kVoxelOrder{0, 1, 3, 2, 4, 5, 7, 6};
/// Permutation between VTK's wedge, whose triangle 0 1 2 faces away from 3 4 5, and ours.
constexpr std::array<int, 15> kWedgeOrder{0, 2, 1, 3, 5, 4, 8, 7, 6, 11, 10, 9, 12, 14, 13};

const CellShape* shape_of(std::int64_t vtk) {
  if (vtk == kVoxel) return &cell_shape("hex8");
  if (vtk == kPixel) return &cell_shape("quad4");
  for (const CellShape& shape : cell_shapes())
    if (shape.vtk == vtk) return &shape;
  return nullptr;
}

/// A DataArray that is read later, when its length is known.
struct Pending {
  XmlTag tag;
  std::size_t content = 0;  ///< Byte behind the tag.
};

/// Contents of a piece of the file.
struct Piece {
  XmlTag tag;
  std::int64_t points = 0, cells = 0;
  std::optional<Pending> coordinates;
  std::map<std::string, Pending> topology;  ///< connectivity, offsets, types.
  std::vector<Pending> point_data, cell_data;
};

class VtuReader {
 public:
  VtuReader(const std::string& name, std::string_view bytes)
      : in_(name, bytes), xml_(in_), mesh_(in_, false) {}

  Mesh read() {
    read_header();
    int pieces = 0;
    for (XmlTag tag = xml_.next(); !tag.name.empty(); tag = xml_.next()) {
      if (tag.name == "AppendedData" || (tag.closes && tag.name == "VTKFile")) break;
      if (tag.name == "FieldData" && !tag.closes) xml_.skip(tag);
      if (tag.name != "Piece" || tag.closes) continue;
      read_piece(tag);
      ++pieces;
    }
    if (pieces == 0) in_.refuse_end("<Piece>", false);
    turn_wedges();
    return mesh_.finish();
  }

 private:
  [[noreturn]] void refuse(const XmlTag& tag, const std::string& what, const std::string& hint) {
    throw InputError(in_.text_place(tag.at), what, hint);
  }

  void read_header() {
    const XmlTag root = xml_.next();
    if (root.name != "VTKFile")
      refuse(root, "a VTK file begins with <VTKFile>", "Save the mesh as .vtu (XML)");
    if (root["type"] != "UnstructuredGrid")
      refuse(root, format("the file holds a {}, not an UnstructuredGrid", quote(root["type"])),
             "Save the mesh as an unstructured grid");
    encoding_.big_endian = root["byte_order"] == "BigEndian";
    encoding_.wide_header = root["header_type"] == "UInt64";
    encoding_.compressed = root.has("compressor");
    if (encoding_.compressed && root["compressor"] != "vtkZLibDataCompressor")
      refuse(root, format("data compressed by {} are not supported", quote(root["compressor"])),
             "Save the mesh with zlib, or without compression");
    const std::size_t found = in_.bytes().find("<AppendedData");
    if (found == std::string_view::npos) return;
    const std::size_t here = in_.at();
    in_.go_to(found);
    const XmlTag tag = xml_.next();
    encoding_.appended_base64 = tag["encoding"] == "base64";
    if (!encoding_.appended_base64 && tag["encoding"] != "raw")
      refuse(tag, format("the encoding {} is not supported", quote(tag["encoding"])),
             kExportMeshAgain);
    const std::size_t mark = in_.bytes().find('_', in_.at());
    if (mark == std::string_view::npos) in_.refuse_end("'_' before the appended data", false);
    encoding_.appended = mark + 1;
    in_.go_to(here);
  }

  std::int64_t count_of(const XmlTag& tag, const char* attribute) {
    std::int64_t count = 0;
    if (!parse_integer(tag[attribute], count) || count < 0 || count > kMaxThings)
      refuse(tag, format("{} is {}, but a count is expected", attribute, quote(tag[attribute])),
             kExportMeshAgain);
    return count;
  }

  /// Stores the arrays of a section, to be read later.
  std::vector<Pending> arrays_of(const XmlTag& section) {
    std::vector<Pending> arrays;
    if (section.empty) return arrays;
    while (true) {
      const XmlTag tag = xml_.next();
      if (tag.name.empty()) in_.refuse_end(format("</{}>", section.name), false);
      if (tag.closes && tag.name == section.name) return arrays;
      if (tag.closes || tag.name != "DataArray") continue;
      arrays.push_back({tag, in_.at()});
      xml_.skip(tag);
    }
  }

  VtkArray array(const Pending& pending, std::size_t count) {
    in_.go_to(pending.content);
    return read_vtk_array(in_, xml_, pending.tag, encoding_, count);
  }

  void read_piece(const XmlTag& tag) {
    Piece piece{.tag = tag, .coordinates = {}, .topology = {}, .point_data = {}, .cell_data = {}};
    piece.points = count_of(tag, "NumberOfPoints");
    piece.cells = count_of(tag, "NumberOfCells");
    while (!tag.empty) {
      const XmlTag section = xml_.next();
      if (section.name.empty()) in_.refuse_end("</Piece>", false);
      if (section.closes && section.name == "Piece") break;
      if (section.closes) continue;
      if (section.name == "PointData") {
        piece.point_data = arrays_of(section);
      } else if (section.name == "CellData") {
        piece.cell_data = arrays_of(section);
      } else if (section.name == "Points") {
        const std::vector<Pending> arrays = arrays_of(section);
        if (!arrays.empty()) piece.coordinates = arrays[0];
      } else if (section.name == "Cells") {
        for (const Pending& one : arrays_of(section)) piece.topology[one.tag["Name"]] = one;
      }
    }
    const std::size_t end = in_.at();
    add_points(piece);
    add_cells(piece);
    in_.go_to(end);
  }

  void add_points(const Piece& piece) {
    first_point_ = static_cast<std::int64_t>(mesh_.node_count());
    if (piece.points == 0) return;
    if (!piece.coordinates) refuse(piece.tag, "the piece has no points", kExportMeshAgain);
    if (const std::string& n = piece.coordinates->tag["NumberOfComponents"]; n != "3")
      refuse(piece.coordinates->tag, format("points have {} components instead of 3", quote(n)),
             kExportMeshAgain);
    const VtkArray X = array(*piece.coordinates, 3 * static_cast<std::size_t>(piece.points));
    const auto at = [&](std::size_t i) {
      return X.whole ? static_cast<double>(X.integers[i]) : X.reals[i];
    };
    for (std::size_t i = 0; i < X.size(); i += 3)
      mesh_.add_node(first_point_ + static_cast<std::int64_t>(i / 3), {at(i), at(i + 1), at(i + 2)},
                     piece.coordinates->tag.at);
    for (const Pending& data : piece.point_data)
      put_sets(data, piece.points, [&](std::int64_t point, const std::string& set) {
        mesh_.put_node(first_point_ + point, set, data.tag.at);
      });
  }

  VtkArray topology(const Piece& piece, const char* name, std::size_t count) {
    const auto found = piece.topology.find(name);
    if (found == piece.topology.end())
      refuse(piece.tag, format("the cells have no array '{}'", name), kExportMeshAgain);
    VtkArray one = array(found->second, count);
    if (!one.whole)
      refuse(found->second.tag, format("array '{}' has to be of integers", name), kExportMeshAgain);
    return one;
  }

  void add_cells(const Piece& piece) {
    if (piece.cells == 0) return;
    const auto n = static_cast<std::size_t>(piece.cells);
    const VtkArray offsets = topology(piece, "offsets", n);
    const VtkArray types = topology(piece, "types", n);
    const XmlTag& tag = piece.topology.at("offsets").tag;
    std::int64_t last = 0;
    for (std::size_t c = 0; c < n; ++c) {
      const CellShape* shape = shape_of(types.integers[c]);
      if (!shape)
        refuse(piece.topology.at("types").tag,
               format("cell {} has the VTK type {}, which is not supported", c, types.integers[c]),
               "Mesh with hexahedra (12, 25, 29), tetrahedra (10, 24) or wedges (13, 26)");
      const std::int64_t size = offsets.integers[c] - last;
      if (size != shape->size())
        refuse(
            tag,
            format("cell {} ({}) has {} nodes instead of {}", c, shape->name, size, shape->size()),
            kExportMeshAgain);
      last = offsets.integers[c];
    }
    const VtkArray nodes = topology(piece, "connectivity", static_cast<std::size_t>(last));
    const std::size_t at = piece.topology.at("connectivity").tag.at;
    const int first_cell = mesh_.cell_count();
    std::size_t begin = 0;
    std::vector<std::int64_t> own;
    for (std::size_t c = 0; c < n; ++c) {
      const CellShape& shape = *shape_of(types.integers[c]);
      const bool brick = types.integers[c] == kVoxel || types.integers[c] == kPixel;
      own.clear();
      for (std::size_t i = 0; i < shape.nodes.size(); ++i) {
        const std::size_t from = brick ? static_cast<std::size_t>(kVoxelOrder[i]) : i;
        const std::int64_t node = nodes.integers[begin + from];
        if (node < 0 || node >= piece.points)
          refuse(piece.topology.at("connectivity").tag,
                 format("cell {} names point {}; the first is 0, the last {}", c, node,
                        piece.points - 1),
                 kExportMeshAgain);
        own.push_back(first_point_ + node);
      }
      begin += shape.nodes.size();
      mesh_.add_cell(shape, first_cell + static_cast<std::int64_t>(c), own, at);
    }
    for (const Pending& data : piece.cell_data)
      put_sets(data, piece.cells, [&](std::int64_t cell, const std::string& set) {
        mesh_.put(first_cell + static_cast<int>(cell), set);
      });
  }

  /// Sets from an array of integers: for zeros and ones the set of that name; otherwise a set
  /// "name_value" for each value.
  template <class Put>
  void put_sets(const Pending& data, std::int64_t count, const Put& put) {
    const std::string& type = data.tag["type"];
    const std::string& components = data.tag["NumberOfComponents"];
    const bool whole = type.starts_with("Int") || type.starts_with("UInt");
    if (!whole || (!components.empty() && components != "1") || data.tag["Name"].empty()) return;
    const VtkArray values = array(data, static_cast<std::size_t>(count));
    const std::set<std::int64_t> all(values.integers.begin(), values.integers.end());
    const bool flags = !all.empty() && *all.begin() >= 0 && *all.rbegin() <= 1;
    if (!flags && all.size() > kMaxSets) {
      mesh_.note(
          format("array '{}' has {} values, so no sets are made of it", values.name, all.size()));
      return;
    }
    for (std::size_t i = 0; i < values.integers.size(); ++i) {
      if (!flags)
        put(static_cast<std::int64_t>(i), format("{}_{}", values.name, values.integers[i]));
      else if (values.integers[i] == 1)
        put(static_cast<std::int64_t>(i), values.name);
    }
  }

  /// Corrects the orientation of wedges. VTK's definition is opposite to the usual one, which many
  /// programs write; the volumes of the file's wedges show which is used.
  void turn_wedges() {
    const CellShape& wedge = cell_shape("wedge6");
    std::vector<int> wedges;
    int as_given = 0;
    std::vector<Vec3> X(6);
    for (int c = 0; c < mesh_.cell_count(); ++c) {
      if (!mesh_.shape(c).name.starts_with("wedge")) continue;
      wedges.push_back(c);
      for (int i = 0; i < 6; ++i) X[static_cast<std::size_t>(i)] = mesh_.position(c, i);
      if (jacobian(wedge, X.data(), {1.0 / 3.0, 1.0 / 3.0, 0.0}) > 0.0) ++as_given;
    }
    if (2 * as_given > static_cast<int>(wedges.size())) {
      mesh_.note(
          "the wedges have the node order of Gmsh and Abaqus, not that of VTK; it is accepted");
      return;
    }
    for (int c : wedges)
      mesh_.reorder(c, std::span(kWedgeOrder).first(mesh_.shape(c).nodes.size()));
  }

  MeshCursor in_;
  XmlTags xml_;
  MeshBuilder mesh_;
  VtkEncoding encoding_;
  std::int64_t first_point_ = 0;
};

}  // namespace

Mesh parse_vtu(const std::string& name, std::string_view bytes) {
  return VtuReader(name, bytes).read();
}

}  // namespace polhode::solids
