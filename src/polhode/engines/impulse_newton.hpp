// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/engines/projected_gauss_seidel.hpp>

namespace polhode {

/// Points up to which solve_impulses() is worth its dense factors.
inline constexpr int kMaxDensePoints = 40;

/// Newton's method for the impulses of a few points, where sweeps contract too slowly: masses far
/// apart, tall stacks. Starts from the impulses that the sweeps have left, and leaves them as they
/// are if it does not converge. @eq{nonsmooth-projection}
/// @param sweeps  Prepared, without resistance to turning.
/// @param enough  What may be left of speeds that are asked for [m/s].
/// @returns whether it converged.
bool solve_impulses(ProjectedGaussSeidel& sweeps, double enough);

}  // namespace polhode
