// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <polhode/system/system.hpp>

namespace polhode {

/// Velocities of nodes for the viscous stresses at t_n, three each [m/s]. Newmark's own velocities
/// alternate from step to step in motions that viscosity has long damped out, and the viscous
/// stress at an instant would amplify that. These are derived from the strains of the last steps:
/// each solid is rotated back onto its present position, and the rates of its last three or four
/// steps are extrapolated to t_n by weights that cancel alternating errors. Error O(Δt²) after
/// three steps, O(Δt³) after four; before, and for very unequal steps, Newmark's are returned.
/// @eq{settled-rate}
[[nodiscard]] std::vector<double> extrapolated_velocities(const System& system, const State& state);

/// Extrapolation weights for the mean rates of the last steps, the last one first, to the end of
/// the last step. @eq{settled-weights}
/// @param dt  Lengths of the last three or four steps, the last one first [s].
/// @returns none if the lengths differ so much that errors would grow.
[[nodiscard]] std::vector<double> extrapolation_weights(const std::vector<double>& dt);

}  // namespace polhode
