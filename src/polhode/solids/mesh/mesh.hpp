// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <polhode/core/types.hpp>
#include <polhode/solids/mesh/shapes.hpp>

namespace polhode::solids {

/// Cells of one shape.
struct ElementBlock {
  std::string type;        ///< Name of a shape (cell_shape()).
  std::vector<int> nodes;  ///< Indices into Mesh::nodes, cell by cell.

  [[nodiscard]] const CellShape& shape() const { return cell_shape(type); }
};

/// Faces of one shape (tri3, tri6, quad4, quad8, quad9). Those of a solid face outward: seen from
/// outside, their corners are counterclockwise.
struct FaceBlock {
  std::string type;
  std::vector<int> nodes;   ///< Indices into Mesh::nodes, face by face.
  std::vector<int> owners;  ///< By face: number of the solid element it bounds; −1 if none.

  [[nodiscard]] const CellShape& shape() const { return cell_shape(type); }
  [[nodiscard]] int size() const { return static_cast<int>(owners.size()); }
};

/// A list of faces, by shape.
struct Surface {
  std::vector<FaceBlock> blocks;

  [[nodiscard]] int size() const;
  /// All nodes of the surface, once each, ascending.
  [[nodiscard]] std::vector<int> nodes() const;
  /// Adds a face; its type's block is created if there is none.
  void add(std::string_view type, std::span<const int> nodes, int owner);
};

/// Nodes, cells and named sets. Plain data, in metres.
///
/// Elements are numbered through all blocks, from 0: those of blocks[0] first.
struct Mesh {
  std::string name;                  ///< File or generator; first part of messages.
  std::vector<Vec3> nodes;           ///< Reference positions X [m].
  std::vector<ElementBlock> blocks;  ///< Solids, lines and points; 2-D cells only without solids.
  std::map<std::string, std::vector<int>, std::less<>> node_sets;     ///< Ascending, no doubles.
  std::map<std::string, std::vector<int>, std::less<>> element_sets;  ///< Ascending, no doubles.
  std::map<std::string, Surface, std::less<>> surfaces;
  std::vector<std::int64_t> node_labels;     ///< Numbers in the file; empty: 1, 2, 3, …
  std::vector<std::int64_t> element_labels;  ///< Numbers in the file; empty: 1, 2, 3, …
  std::vector<std::string> notes;            ///< Omissions and changes by a reader.

  [[nodiscard]] int element_count() const;
  /// Block of an element, and its index there.
  struct Place {
    int block;
    int index;
  };
  [[nodiscard]] Place place(int element) const;
  /// Nodes of an element.
  [[nodiscard]] std::span<const int> element_nodes(int element) const;
  [[nodiscard]] const CellShape& element_shape(int element) const;
  /// User's number of a node or an element.
  [[nodiscard]] std::int64_t node_label(int node) const;
  [[nodiscard]] std::int64_t element_label(int element) const;
};

/// Faces that belong to one solid element only, outward.
[[nodiscard]] Surface boundary(const Mesh& mesh);

/// Elements of a set, with their nodes, sets and surfaces, renumbered. An empty name means all
/// solid elements (all elements, if there are no solids).
/// @throws InputError if there is no such set; the message lists the existing ones.
[[nodiscard]] Mesh part_of(const Mesh& mesh, std::string_view element_set);

/// Blocks of a mesh after split_blocks().
struct SplitBlocks {
  std::vector<int> parts;   ///< Part of each new block.
  std::vector<int> former;  ///< Former number of each element.
};

/// Splits blocks so that all elements of a block are of one part; elements are renumbered, in sets
/// and surfaces too.
/// @param part  By element.
SplitBlocks split_blocks(Mesh& mesh, const std::vector<int>& part);

/// Multiplies all coordinates by a factor; move() rotates by R and translates by x.
void scale(Mesh& mesh, double factor);
void move(Mesh& mesh, const Mat3& R, const Vec3& x);

/// Smallest and largest coordinates [m]. Zero for a mesh without nodes.
struct Extent {
  Vec3 least = Vec3::Zero();
  Vec3 most = Vec3::Zero();
  [[nodiscard]] double size() const;  ///< Length of the diagonal [m].
};
[[nodiscard]] Extent extent(const Mesh& mesh);

/// Volume of a solid element by its own shape functions [m³].
[[nodiscard]] double element_volume(const Mesh& mesh, int element);

}  // namespace polhode::solids
