// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include <polhode/solids/mesh/mesh.hpp>
#include <polhode/solids/mesh/mesh_cursor.hpp>

namespace polhode::solids {

class FaceIndex;

/// Collects the contents of a mesh file, by the file's own numbers, and builds a Mesh. Inconsistent
/// contents are rejected with their position in the file.
class MeshBuilder {
 public:
  /// @param cursor  Must outlive the builder; provides positions.
  /// @param binary  Positions are given in bytes, not in lines.
  MeshBuilder(const MeshCursor& cursor, bool binary) : cursor_(cursor), binary_(binary) {}

  /// Adds a node. @throws InputError for a repeated number, and unreasonable coordinates.
  void add_node(std::int64_t label, const Vec3& X, std::size_t at);
  /// Adds a cell, its nodes in the order of our shapes.
  /// @returns its index, for the sets below.
  int add_cell(const CellShape& shape, std::int64_t label, std::span<const std::int64_t> nodes,
               std::size_t at);

  /// Adds a cell to a set: solids and lines form sets of elements, faces form surfaces, points form
  /// sets of nodes.
  void put(int cell, std::string_view set);
  void put_node(std::int64_t node, std::string_view set, std::size_t at);
  /// Adds a face of a solid, by its local corners, to a surface.
  void put_face(int cell, std::span<const int> local_corners, std::string_view surface);
  /// Adds all faces of a set's cells that belong to one cell only to a surface.
  void put_free_faces(const std::vector<int>& cells, std::string_view surface);

  [[nodiscard]] std::size_t node_count() const { return nodes_.size(); }
  [[nodiscard]] int cell_count() const { return static_cast<int>(cells_.size()); }
  [[nodiscard]] const CellShape& shape(int cell) const { return *cells_[cell].shape; }
  [[nodiscard]] std::int64_t label(int cell) const { return cells_[cell].label; }
  /// Position of a cell's node, by the order of our shapes. @throws InputError if there is none.
  [[nodiscard]] const Vec3& position(int cell, int node) const;
  /// Permutes nodes of a cell: new node i is the old one order[i].
  void reorder(int cell, std::span<const int> order);
  void note(std::string text) { notes_.push_back(std::move(text)); }

  /// Cells listed twice with the same nodes are one cell in two sets (as in Gmsh 2); otherwise they
  /// are rejected.
  bool repeated_cells_are_one = false;

  /// Builds the mesh. @throws InputError
  [[nodiscard]] Mesh finish();

 private:
  struct Cell {
    const CellShape* shape;
    std::int64_t label;
    std::size_t at;     ///< Byte in the file.
    std::size_t first;  ///< Of its nodes in cell_nodes_.
  };
  struct Face {
    int cell;
    std::vector<int> corners;  ///< Local.
  };

  [[noreturn]] void refuse(std::size_t at, const std::string& what, const std::string& hint) const;
  [[nodiscard]] int node_index(std::int64_t label, std::size_t at, std::string_view user) const;
  [[nodiscard]] std::vector<int> resolved(const Cell& cell) const;
  void make_elements(Mesh& mesh, bool solids);
  void make_surfaces(Mesh& mesh, bool solids);
  /// Existing element with the same nodes; −1 if there is none.
  [[nodiscard]] int same_element(const std::vector<int>& nodes, const CellShape& shape);
  void add_oriented(const Mesh& mesh, const FaceIndex& faces, const std::vector<int>& nodes,
                    std::string_view type, Surface& surface, int& stray) const;

  const MeshCursor& cursor_;
  bool binary_;
  std::vector<Vec3> nodes_;
  std::vector<std::int64_t> labels_;
  std::unordered_map<std::int64_t, int> index_;
  std::vector<Cell> cells_;
  std::vector<std::int64_t> cell_nodes_;
  std::map<std::string, std::vector<int>, std::less<>> cell_sets_;
  std::map<std::string, std::vector<int>, std::less<>> node_sets_;
  std::map<std::string, std::vector<Face>, std::less<>> face_sets_;
  std::map<std::string, std::vector<int>, std::less<>> free_face_sets_;
  std::vector<std::string> notes_;
  std::vector<int> element_of_;  ///< By cell: number of the element; −1 if it is none.
  std::vector<int> cell_of_;     ///< By element created so far.
  std::unordered_multimap<std::size_t, int> known_;  ///< Hash of nodes → position in cell_of_.
};

}  // namespace polhode::solids
