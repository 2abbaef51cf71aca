// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <polhode/system/system.hpp>

namespace polhode {

/// Impulses of interactions at an instant at which velocities jump.
struct VelocityJump {
  /// Rate of drives that counts for their work: before the jump, after it, or the mean of both.
  enum class Rate : unsigned char { before, mean, after };
  /// Impulse of an interaction beyond its rows, such as that of a stop.
  struct More {
    int interaction = 0;
    Vec6 on_a = Vec6::Zero(), on_b = Vec6::Zero();  ///< About the centres of mass [N s, N m s].
  };
  std::vector<double> rows;  ///< Of all rows; may be empty.
  std::vector<More> more;    ///< In ascending order.
  Rate rate = Rate::before;
};

/// Adds the impulses of a jump to the sums of joints and drives. Impulses and work are those at the
/// state's time and positions; velocities do not matter. @eq{jump-work}
/// @returns the work of the drives [J].
double take_jump(const System& system, State& state, const VelocityJump& jump);

}  // namespace polhode
