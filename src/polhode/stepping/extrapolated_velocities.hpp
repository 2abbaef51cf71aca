// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <polhode/system/system.hpp>

namespace polhode {

/// Velocities of nodes for the viscous stresses at t_n, three each [m/s]. Newmark's own turn their
/// sign from step to step in motions that viscosity has long damped away, and an instant would
/// multiply that by the viscosity. These come from the strains that the last steps made: each solid
/// turned back onto its present place, the rates of its last three or four steps extrapolated to
/// t_n by weights that leave out what changes its sign with every step. Error O(Δt²) after three
/// steps, O(Δt³) after four; before, and where steps differ too much, Newmark's are returned.
/// @eq{settled-rate}
[[nodiscard]] std::vector<double> extrapolated_velocities(const System& system, const State& state);

/// Weights of the mean rates of the last steps, the last one first, that give the rate at their
/// end. @eq{settled-weights}
/// @param dt  Lengths of the last three or four steps, the last one first [s].
/// @returns none if the lengths differ so much that errors would grow.
[[nodiscard]] std::vector<double> extrapolation_weights(const std::vector<double>& dt);

}  // namespace polhode
