// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <polhode/solids/mesh/mesh.hpp>

namespace polhode {

/// Which nodes or faces of a mesh are meant, in the mesh's own coordinates [m].
struct Selection {
  enum class Kind : unsigned char { kAll, kSet, kPlane, kBox, kSphere, kNodes };
  enum class Level : unsigned char { kMin, kMax, kValue };

  Kind kind = Kind::kAll;
  std::string set;              ///< kSet: a set of nodes, a surface, or a set of elements.
  Vec3 normal = Vec3::UnitZ();  ///< kPlane: unit normal.
  Level level = Level::kValue;  ///< kPlane: at the mesh's least or largest extent, or at a value.
  double value = 0.0;           ///< kPlane: normal · X [m].
  Vec3 least = Vec3::Zero();    ///< kBox: corner of least coordinates [m].
  Vec3 most = Vec3::Zero();     ///< kBox: corner of largest coordinates [m].
  Vec3 centre = Vec3::Zero();   ///< kSphere [m].
  double radius = 0.0;          ///< kSphere [m].
  bool on_surface = false;      ///< kSphere: what lies at the radius, not what lies within it.
  double tolerance = 0.0;       ///< [m]; 0: a millionth of the mesh's extent.
  std::vector<int> nodes;       ///< kNodes: indices into Mesh::nodes.
};

/// Nodes that any of the selections holds; without selections, all. Ascending, no doubles.
/// @param where  First part of messages.
/// @throws InputError for a selection that holds nothing, with the extent of the mesh; for a set
///         that does not exist, with the names there are.
[[nodiscard]] std::vector<int> select_nodes(std::string_view where, const Mesh& mesh,
                                            const std::vector<Selection>& selections);

/// Faces that any of the selections holds: those of a surface by its name, and otherwise those of
/// the boundary all of whose nodes a selection holds. Without selections, the whole boundary.
/// @throws InputError as select_nodes().
[[nodiscard]] Surface select_faces(std::string_view where, const Mesh& mesh,
                                   const std::vector<Selection>& selections);

}  // namespace polhode
