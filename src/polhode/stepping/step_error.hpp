// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/system/system.hpp>

namespace polhode {

/// Largest difference between two states of a system [-]: positions of bodies and nodes relative to
/// ℓ, orientations in radians, internal unknowns of elements as they are. With a span H, velocities
/// times H are included: a step that is too long may end at the right position with velocities that
/// change the rest of the run.
/// @param H  [s]; 0: without velocities.
[[nodiscard]] double state_difference(const System& system, const State& x, const State& y,
                                      double H);

/// The body of which two states of a system differ most, as in state_difference(); −1: of a node,
/// or of none.
[[nodiscard]] int most_different_body(const System& system, const State& x, const State& y,
                                      double H);

/// Largest displacement by the velocity jump from one state to the other over a time H [-]: the
/// error of an impact at any time within it.
[[nodiscard]] double jump_difference(const System& system, const State& x, const State& y,
                                     double H);

/// Largest distance of a body or node from the origin at the start, for the rounding of positions
/// [m].
[[nodiscard]] double extent(const System& system);

}  // namespace polhode
