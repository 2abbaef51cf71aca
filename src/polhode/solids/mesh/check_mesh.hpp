// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <polhode/solids/mesh/mesh.hpp>

namespace polhode {

/// What is wrong with a mesh.
struct MeshFault {
  enum class Kind : unsigned char { kInverted, kPieces, kDuplicateNodes, kLooseNodes };

  Kind kind;
  bool fatal;        ///< No solid can be made of it. Otherwise it deserves a note.
  std::string what;  ///< With the numbers of nodes or elements that the user knows.
  std::string hint;
};

/// Inverted or collapsed elements, nodes that coincide (within a 1e-9 of the mesh's extent) without
/// being one, pieces that do not hang together, nodes of no element. Empty: the mesh is sound.
[[nodiscard]] std::vector<MeshFault> mesh_faults(const Mesh& mesh);

/// Refuses a mesh that has a fatal fault: inverted elements.
/// @returns the other faults, as notes: "what. mend."
/// @throws InputError
std::vector<std::string> check_mesh(const Mesh& mesh);

/// Joins nodes that coincide within a distance; the first of them stays, loose nodes go.
/// @param distance  [m]; 0: 1e-9 of the mesh's extent.
/// @returns how many nodes went.
/// @throws InputError if an element would have the same node twice.
int merge_duplicate_nodes(Mesh& mesh, double distance = 0.0);

}  // namespace polhode
