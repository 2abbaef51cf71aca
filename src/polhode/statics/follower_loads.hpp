// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <polhode/system/system.hpp>

namespace polhode {

/// A load without a potential that acts at a state: a force that follows its body, a moment fixed
/// in space, a pressure at the edge of a surface.
struct FollowerLoad {
  std::string name;    ///< "force 'main'".
  double force = 0.0;  ///< Largest force, or moment per size of the model [N].
};

/// Loads of bodies and solids whose derivative by the configuration is not symmetric, in the order
/// of the model. @eq{statics-hessian}
[[nodiscard]] std::vector<FollowerLoad> follower_loads(const System& system, const State& state,
                                                       double load_factor);

}  // namespace polhode
