// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <polhode/compile/build_system.hpp>
#include <polhode/surface_contact/mesh_surface.hpp>

namespace polhode {

/// Two sides that overlap, a solid or a cable one of them.
struct SideOverlap {
  int own = 0, side = 0;    ///< See contact_spec.hpp.
  double depth = 0.0;       ///< [m]; 0: they touch.
  Vec3 out = Vec3::Zero();  ///< Unit, world: where `own` goes to leave; zero if not known.
  double free_gap = 0.0;    ///< At which nothing acts [m].
};

/// Faces of a solid by the system's numbers of nodes.
[[nodiscard]] std::vector<LoadedFaces> system_faces(const SolidMap& solid, const Surface& faces);
/// All around a solid.
[[nodiscard]] MeshSurface solid_boundary(const SolidMap& solid);

/// Surfaces that are deeper in a shape, or solids, bodies and cables that are deeper in a solid,
/// than what they touch by lets pass, the deepest place of each two sides; and solids that leave no
/// gap. What lies wholly within a solid is found, too, see SolidInside.
[[nodiscard]] std::vector<SideOverlap> surface_overlaps(const Model& model, const System& system,
                                                        const SystemMap& map, const State& state);

/// "pad in floor by 0.01 m", "pad touches block".
[[nodiscard]] std::string overlap_text(const Model& model, const SideOverlap& overlap);

}  // namespace polhode
