// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/engines/projected_gauss_seidel.hpp>

namespace polhode {

/// Largest number of points and turns for which the dense factors of solve_impulses() pay.
inline constexpr int kMaxDensePoints = 100;

/// Solves for the impulses of a few points by Newton's method where Gauss-Seidel sweeps contract
/// too slowly: large mass ratios, tall stacks. Starts from the impulses of the sweeps, and leaves
/// them unchanged if it does not converge. @eq{nonsmooth-projection}
/// @param sweeps  Prepared.
/// @param enough  Tolerance of target speeds [m/s].
/// @param exact   Smaller tolerance that is aimed at, as far as round-off permits [m/s].
/// @returns whether it converged.
bool solve_impulses(ProjectedGaussSeidel& sweeps, double enough, double exact);

}  // namespace polhode
