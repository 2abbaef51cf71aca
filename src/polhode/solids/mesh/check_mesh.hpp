// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <polhode/solids/mesh/mesh.hpp>

namespace polhode::solids {

/// An error of a mesh.
struct MeshFault {
  enum class Kind : unsigned char {
    kInverted,
    kSameElements,
    kPieces,
    kDuplicateNodes,
    kLooseNodes
  };

  Kind kind;
  bool fatal;        ///< No solid can be made of it. Otherwise a note.
  std::string what;  ///< With the user's numbers of nodes or elements.
  std::string hint;
};

/// Errors of a mesh: inverted or collapsed elements, elements given twice, coincident nodes (within
/// 1e-9 of the mesh's extent), disconnected parts, nodes of no element. Empty: the mesh is valid.
[[nodiscard]] std::vector<MeshFault> mesh_faults(const Mesh& mesh);

/// Rejects a mesh with a fatal error: inverted elements, or elements given twice.
/// @returns the other errors, as notes: "what. hint."
/// @throws InputError
std::vector<std::string> check_mesh(const Mesh& mesh);

/// Merges nodes that coincide within a distance; the first of them stays, unused nodes are removed.
/// @param distance  [m]; 0: 1e-9 of the mesh's extent. @returns the number of removed nodes.
/// @throws InputError if an element would have the same node twice.
int merge_duplicate_nodes(Mesh& mesh, double distance = 0.0);

}  // namespace polhode::solids
