// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/system/system.hpp>

namespace polhode {

/// Largest difference between two states of a system [-]: positions of bodies and nodes as parts of
/// ℓ, orientations in radians, internal unknowns of elements as they are. With a span H, velocities
/// times H count as well: a step that is too long may end at the right place with velocities that
/// take the rest of the run elsewhere.
/// @param H  [s]; 0: velocities are left out.
[[nodiscard]] double state_difference(const System& system, const State& x, const State& y,
                                      double H);

/// Largest move that the jump of velocities from one state to the other makes over a time H [-]:
/// what an impact is off by that came anywhere within it.
[[nodiscard]] double jump_difference(const System& system, const State& x, const State& y,
                                     double H);

}  // namespace polhode
