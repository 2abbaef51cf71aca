// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <polhode/core/error.hpp>
#include <polhode/model/model.hpp>
#include <polhode/solids/mesh/mesh.hpp>

namespace polhode {

/// A deformable solid with its mesh, sets and elements resolved, for build_system() and 'polhode
/// check'.
struct SolidPlan {
  solids::Mesh mesh;                  ///< In its own coordinates [m].
  std::vector<Vec3> start;            ///< Its nodes in the world [m].
  std::vector<std::string> elements;  ///< Kind of element of each block of the mesh.
  /// Material and density of each block of the mesh: index into Model::materials, and [kg/m³].
  std::vector<int> materials;
  std::vector<double> densities;
  /// By block and element of it, family after family: directions along the mesh's axes in place of
  /// the material's; none: those of the material.
  std::vector<std::vector<Vec3>> fibres;
  std::vector<std::vector<int>> bonded;      ///< Nodes by SolidSpec::bonded, ascending.
  std::vector<std::vector<int>> prescribed;  ///< Nodes by SolidSpec::prescribed, ascending.
  solids::Surface touching;  ///< Contact faces, if the model has contacts and the solid takes part.
  double volume = 0.0;       ///< [m³]
  double least_jacobian = 0.0;  ///< Smallest det ∂X/∂ξ at a node or middle of an element [m³].
  int least_element = 0;        ///< Its element.
  std::vector<std::string> warnings;  ///< Conspicuous findings.
};

/// Resolves a solid.
/// @param faults  Receives all errors, with paths such as solids.pad.bonded. Null: the first error
/// is thrown.
/// @throws InputError
[[nodiscard]] SolidPlan plan_solid(const Model& model, int solid,
                                   std::vector<InputError>* faults = nullptr);

}  // namespace polhode
