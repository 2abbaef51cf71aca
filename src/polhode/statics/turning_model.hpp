// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <polhode/dynamics/turning_frame.hpp>
#include <polhode/statics/modal_matrices.hpp>

namespace polhode {

/// Derivative −∂f/∂v of the wrench on the moving body of an interaction with the ground, by its
/// velocity and angular velocity at rest, world axes [N s/m].
[[nodiscard]] Mat6 damping_on_ground(const System& system, const State& state,
                                     const InteractionRef& ref);

/// Checks that forces and constraints are constant in a turning frame: that those of a ground that
/// stands do not change as the model turns about the axis. @eq{spin-invariance}
/// @throws InputError that names what changes.
void check_turning(const System& system, const State& state, const TurningFrame& frame);

/// Names the whirl of modes in a turning frame, gives their frequencies in the world, and shows the
/// model's own motions along and about the axis, if they are free, as such. @eq{spin-whirl}
void find_whirl(const System& system, const State& state, const TurningFrame& frame,
                ModalMatrices& m, std::vector<Mode>& modes);

}  // namespace polhode
