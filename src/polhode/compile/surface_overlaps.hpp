// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <polhode/compile/build_system.hpp>
#include <polhode/surface_contact/mesh_surface.hpp>

namespace polhode {

/// Two overlapping sides, one of them a solid or a cable.
struct SideOverlap {
  Side own, side;
  double depth = 0.0;       ///< [m]; 0: in contact.
  Vec3 out = Vec3::Zero();  ///< Unit, world: direction of exit of `own`; zero if not known.
  double free_gap = 0.0;    ///< Gap without force [m].
};

/// Complete boundary of a solid.
[[nodiscard]] surface_contact::MeshSurface solid_boundary(const SolidMap& solid);

/// Overlaps of surfaces with shapes, and of solids, bodies and cables with solids, beyond what
/// their contact allows, at the deepest point of each two sides; also solids without a gap. Fully
/// enclosed parts are found, see SolidInside.
[[nodiscard]] std::vector<SideOverlap> surface_overlaps(const Model& model, const System& system,
                                                        const SystemMap& map, const State& state);

/// Description of an overlap: "pad in floor by 0.01 m", "pad touches block".
[[nodiscard]] std::string overlap_text(const Model& model, const SideOverlap& overlap);

}  // namespace polhode
