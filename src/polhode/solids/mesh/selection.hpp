// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <polhode/solids/mesh/mesh.hpp>

namespace polhode::solids {

/// Selection of nodes or faces of a mesh, in the mesh's own coordinates [m].
struct Selection {
  enum class Kind : unsigned char { kAll, kSet, kPlane, kBox, kSphere, kNodes };
  enum class Level : unsigned char { kMin, kMax, kValue };

  Kind kind = Kind::kAll;
  std::string set;              ///< kSet: a set of nodes, a surface, or a set of elements.
  Vec3 normal = Vec3::UnitZ();  ///< kPlane: unit normal.
  /// kPlane: at the mesh's smallest or largest extent, or at a value.
  Level level = Level::kValue;
  double value = 0.0;          ///< kPlane: normal · X [m].
  Vec3 least = Vec3::Zero();   ///< kBox: corner of smallest coordinates [m].
  Vec3 most = Vec3::Zero();    ///< kBox: corner of largest coordinates [m].
  Vec3 centre = Vec3::Zero();  ///< kSphere [m].
  double radius = 0.0;         ///< kSphere [m].
  bool on_surface = false;     ///< kSphere: at the radius instead of within it.
  double tolerance = 0.0;      ///< [m]; 0: a millionth of the mesh's extent.
  std::vector<int> nodes;      ///< kNodes: indices into Mesh::nodes.
};

/// Union of the nodes of the selections; without selections, all. Ascending, no duplicates.
/// @param where  First part of messages.
/// @throws InputError for an empty selection, with the extent of the mesh; for a nonexistent set,
/// with the existing names.
[[nodiscard]] std::vector<int> select_nodes(std::string_view where, const Mesh& mesh,
                                            const std::vector<Selection>& selections);

/// Union of the elements of the selections: those of a set of elements by its name, and otherwise
/// elements of which a selection contains all nodes. Ascending, no duplicates.
/// @throws InputError as select_nodes(), and for a selection without a whole element.
[[nodiscard]] std::vector<int> select_elements(std::string_view where, const Mesh& mesh,
                                               const std::vector<Selection>& selections);

/// Union of the faces of the selections: those of a surface by its name, and otherwise boundary
/// faces of which a selection contains all nodes. Without selections, the whole boundary.
/// @throws InputError as select_nodes().
[[nodiscard]] Surface select_faces(std::string_view where, const Mesh& mesh,
                                   const std::vector<Selection>& selections);

}  // namespace polhode::solids
