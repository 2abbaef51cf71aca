// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <polhode/compile/build_system.hpp>

namespace polhode {

/// Moving bodies and interactions whose data may differ between two models of equal topology.
struct ChangedItems {
  std::vector<char> bodies, interactions;  ///< 1 for those that may differ.
};

/// Compares a model with one that has another value of a parameter. Functions of time count as
/// changed, as do all interactions of a model with beams: none that has changed is missed.
[[nodiscard]] ChangedItems changed_items(const Model& model, const System& system,
                                         const Model& other_model, const System& other,
                                         const SystemMap& map);

}  // namespace polhode
