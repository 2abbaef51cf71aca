// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include <polhode/compile/plan_solid.hpp>
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

/// Kinds of element of a solid, once each, though each of several materials has its own groups.
[[nodiscard]] inline std::vector<std::string> element_kinds_of(const SolidPlan& plan) {
  std::vector<std::string> kinds;
  for (const std::string& kind : plan.elements)
    if (std::find(kinds.begin(), kinds.end(), kind) == kinds.end()) kinds.push_back(kind);
  return kinds;
}

}  // namespace polhode::cli
