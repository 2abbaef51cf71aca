// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <polhode/system/system.hpp>

namespace polhode {

/// Estimated error of a step, and where it occurs.
struct StepError {
  double value = 0.0;  ///< Lengths over ℓ, angles in radians [-].
  int body = -1, node = -1;
};

/// Error of the last step at order 2: its term Δt³ x‴/12, x‴ from the mean velocities of the last
/// three steps, with the phase error of the Cayley transform. @eq{step-error}
/// @returns nothing until three steps are stored, as after an impact.
[[nodiscard]] std::optional<StepError> error_of_last_step(const System& system, const State& state);

/// Adds an estimate, valid for so many steps, to the sums of the state's ledger.
void record_error(State& state, const StepError& error, int steps = 1);

/// Adds the error of the last step at order 2, if it is known.
void record_last_step(const System& system, State& state);
/// Records a step in which Newton's method only just converged.
void record_hard(State& state);

}  // namespace polhode
