// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <polhode/compile/plan_solid.hpp>
#include <polhode/loads/pair_on_nodes.hpp>
#include <polhode/solids/loads/loaded_faces.hpp>
#include <polhode/system/system.hpp>

namespace polhode {

namespace solids {
class SolidElements;
}

/// A deformable solid in a System.
struct SolidMap {
  SolidPlan plan;
  int first_node = 0;       ///< Its node k is the System's first_node + k.
  std::vector<int> groups;  ///< Of elements, by block of the mesh.
  std::vector<const solids::SolidElements*> elements;  ///< Of these groups; owned by the System.
  double mass = 0.0;                                   ///< [kg]
  Vec3 centre = Vec3::Zero();                          ///< Of mass at the start, world [m].

  [[nodiscard]] int node_count() const { return static_cast<int>(plan.start.size()); }
};

/// Adds the nodes and elements of a solid.
/// @param body  By Model::bodies: index in the System, kGround if fixed.
/// @throws InputError for everything that plan_solid() rejects, and for a wrong material.
[[nodiscard]] SolidMap add_solid(System& system, const Model& model, int solid,
                                 const std::vector<int>& body);

/// Faces of a solid by the System's node numbers.
[[nodiscard]] std::vector<solids::LoadedFaces> system_faces(const SolidMap& solid,
                                                            const solids::Surface& faces);

/// Adds a load on a solid, a LoadSpec whose `solid` is set.
/// @returns the groups of elements that apply it, one for each shape of face.
/// @throws InputError if its type does not act on solids, its value is missing, or its selection is
/// empty.
std::vector<int> add_solid_load(System& system, const LoadSpec& load, const SolidMap& solid);

/// Point of a solid by the System's node numbers.
/// @param X  In the mesh's own coordinates [m].
/// @throws InputError, at `where`, if it lies in no element.
[[nodiscard]] NodePoint node_point(const SolidMap& solid, const std::string& where, const Vec3& X);

}  // namespace polhode
