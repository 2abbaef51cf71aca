// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <polhode/system/system.hpp>

namespace polhode {

/// A load without a potential that acts at a state: a force that follows its body, a moment fixed
/// in space, a pressure at the edge of a surface.
struct FollowerLoad {
  std::string name;      ///< "force 'main'".
  double force = 0.0;    ///< Largest force, or moment per size of the model [N].
  int interaction = -1;  ///< −1: a load on a solid.

  /// Stiffness of a load on bodies by (r, θ) of a and b, with the symmetric form of moments.
  using Stiffness = Eigen::Matrix<double, 12, 12>;
  Stiffness stiffness = Stiffness::Zero();
  /// Change of its force and moment by a motion of a and b, which the half moments of that form are
  /// no part of.
  Stiffness change = Stiffness::Zero();
};

/// Loads of bodies and solids whose derivative by the configuration is not symmetric, in the order
/// of the model. @eq{statics-hessian}
[[nodiscard]] std::vector<FollowerLoad> follower_loads(const System& system, const State& state,
                                                       double load_factor);

/// Stiffness of an interaction of bodies at a state, with its multipliers, in the symmetric form.
[[nodiscard]] FollowerLoad::Stiffness pair_stiffness(const System& system, const State& state,
                                                     double load_factor, int interaction);

}  // namespace polhode
