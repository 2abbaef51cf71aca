// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>
#include <vector>

#include <polhode/model/model.hpp>

namespace polhode {

/// Adds contact shapes to the nodes of a beam: each node has the halves of its two elements as
/// round bars. Free ends are round and no longer than the beam.
/// @throws InputError The beam has no round size, or its mass is not lumped.
void add_beam_shapes(Model& model, const BeamSpec& beam);

/// Pairs of bodies excluded from contact because a beam with contact connects them: nodes so near
/// along the beam that a sharp bend would press them together, and the support of an end with the
/// nodes next to it. Indices into Model::bodies.
[[nodiscard]] std::vector<std::pair<int, int>> beam_neighbours(const Model& model);

}  // namespace polhode
