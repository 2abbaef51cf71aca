// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/compile/build_system.hpp>
#include <polhode/loads/pair_on_nodes.hpp>

namespace polhode {

/// Adds a load between points of which one at least is on a solid, after the solids.
/// @param map  With bodies and solids.
/// @returns its element, which the System owns.
/// @throws InputError if its kind or a part of it does not act on points of solids, or if a point
/// is in no element.
const PairOnNodes* add_load_on_nodes(System& system, const Model& model, const LoadSpec& load,
                                     const SystemMap& map);

}  // namespace polhode
