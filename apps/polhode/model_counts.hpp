// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include <polhode/model/model.hpp>

namespace polhode::cli {

/// Number of bodies of a model that are not fixed, without the masses of inerters.
[[nodiscard]] inline int moving_bodies(const Model& model) {
  return static_cast<int>(std::count_if(model.bodies.begin(), model.bodies.end(),
                                        [](const BodySpec& body) { return !body.fixed; }));
}

}  // namespace polhode::cli
