// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>
#include <vector>

#include <polhode/core/types.hpp>

namespace polhode {

/// A constraint on velocities and accelerations of nodes at an instant,
///
///   Σ n_i·v_i = rate,   Σ n_i·a_i = second.
///
/// Its multiplier exerts the forces n_i.
struct NodeRow {
  std::vector<std::pair<int, Vec3>> on;  ///< Node and n_i.
  double rate = 0.0, second = 0.0;       ///< [m/s], [m/s²]
};

}  // namespace polhode
