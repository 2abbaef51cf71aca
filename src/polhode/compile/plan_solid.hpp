// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <polhode/core/error.hpp>
#include <polhode/model/model.hpp>
#include <polhode/solids/mesh/mesh.hpp>

namespace polhode {

/// A deformable solid with its mesh read, its sets worked out and its elements chosen: what
/// build_system() makes nodes and elements of, and what 'polhode check' tells.
struct SolidPlan {
  Mesh mesh;                                 ///< In its own coordinates [m].
  std::vector<Vec3> start;                   ///< Its nodes in the world [m].
  std::vector<std::string> elements;         ///< Kind of element of each block of the mesh.
  double density = 0.0;                      ///< [kg/m³]
  std::vector<std::vector<int>> bonded;      ///< Nodes by SolidSpec::bonded, ascending.
  std::vector<std::vector<int>> prescribed;  ///< Nodes by SolidSpec::prescribed, ascending.
  Surface touching;     ///< Faces that may touch, if the model has contacts and the solid touches.
  double volume = 0.0;  ///< [m³]
  double least_jacobian = 0.0;  ///< Smallest det ∂X/∂ξ at a node or middle of an element [m³].
  int least_element = 0;        ///< Where.
  std::vector<std::string> warnings;  ///< What deserves a look.
};

/// Works a solid out.
/// @param faults  Gathers everything that is wrong with it, with paths such as solids.pad.bonded.
///                Null: the first fault is thrown.
/// @throws InputError
[[nodiscard]] SolidPlan plan_solid(const Model& model, int solid,
                                   std::vector<InputError>* faults = nullptr);

}  // namespace polhode
