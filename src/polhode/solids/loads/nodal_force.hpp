// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/core/error.hpp>
#include <polhode/solids/loads/dead_load.hpp>
#include <polhode/solids/loads/solid_load.hpp>

namespace polhode::solids {

/// Equal forces on all nodes [N]; absent components are zero.
/// @param name  Path of the load in the user's model.
/// @param X     Reference positions of all nodes [m].
/// @throws InputError if there are no nodes.
[[nodiscard]] inline std::unique_ptr<ElementGroup> make_nodal_force(std::string name,
                                                                    const std::vector<int>& nodes,
                                                                    std::span<const Vec3> X,
                                                                    TimeVector force) {
  if (nodes.empty())
    throw InputError(name, "there are no nodes to load", "Choose at least one node");
  NodeShares shares(X);
  for (const int node : nodes) shares.add(node, Mat3::Identity());
  return std::make_unique<DeadLoad>("force on nodes", std::move(name), shares.all(),
                                    std::move(force));
}

[[nodiscard]] inline SolidLoadKind nodal_force_kind() {
  return {.name = "nodal_force",
          .meaning = "a force on each of some nodes of a deformable solid",
          .place = SolidLoadPlace::nodes,
          .vector = TimeParameter{"force", "N", "force on each of the nodes, world components"},
          .make = [](const SolidLoadDescription& d) {
            return one_group(make_nodal_force(d.name, d.nodes, d.X, d.vector));
          }};
}

}  // namespace polhode::solids
