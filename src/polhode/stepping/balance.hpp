// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/core/types.hpp>

namespace polhode {

/// Energies and momenta at an instant. SI units, world axes, angular momentum about the origin.
struct Balance {
  double kinetic = 0.0, potential = 0.0;  ///< [J]
  double put_in = 0.0, dissipated = 0.0;  ///< Since the start [J].
  Vec3 linear_momentum = Vec3::Zero(), angular_momentum = Vec3::Zero();
};

}  // namespace polhode
