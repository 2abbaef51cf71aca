// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include <polhode/model/model.hpp>

namespace polhode::cli {

/// Number of bodies that the user has given, fixed ones included: not the nodes of beams and
/// cables.
[[nodiscard]] inline int given_bodies(const Model& model) {
  return static_cast<int>(std::count_if(model.bodies.begin(), model.bodies.end(),
                                        [](const BodySpec& body) { return body.node_of.empty(); }));
}

/// Number of those that are not fixed.
[[nodiscard]] inline int moving_bodies(const Model& model) {
  return static_cast<int>(
      std::count_if(model.bodies.begin(), model.bodies.end(),
                    [](const BodySpec& body) { return body.node_of.empty() && !body.fixed; }));
}

}  // namespace polhode::cli
