// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/core/time_function.hpp>

namespace polhode {

/// A Hill-type muscle with a rigid tendon: a contractile and a parallel elastic element.
/// @eq{muscle-force}
struct HillMuscle {
  double max_force = 0.0;       ///< Isometric, at the optimal length [N].
  double optimal_length = 0.0;  ///< Of the fibres [m].
  double tendon_length = 0.0;   ///< [m]
  double pennation = 0.0;       ///< At the optimal length [rad].
  double max_velocity = 10.0;   ///< Largest speed of shortening, optimal lengths a second [1/s].
  double damping = 0.0;        ///< Of the fibres: over max_force, by velocity over the largest [-].
  TimeFunctionPtr activation;  ///< From 0 to 1 [-].
};

}  // namespace polhode
