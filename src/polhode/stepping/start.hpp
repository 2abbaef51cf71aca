// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <polhode/stepping/instant.hpp>
#include <polhode/stepping/start_report.hpp>
#include <polhode/system/system.hpp>

namespace polhode {

struct StartOptions {
  /// Factor of drives while positions are assembled: 0 in statics.
  double load_factor = 1.0;
  double position_tolerance = 1e-10;  ///< |g| that counts as assembled [m or -].
  /// Solve for accelerations and multipliers even where the method does not need them (ρ∞ = 1).
  bool multipliers = true;
  /// Start on the smooth solution of the method: multipliers do not alternate from step to step.
  bool smooth_multipliers = false;
};

/// Makes a state consistent before its first step: positions on g = 0, velocities on G v = 0,
/// histories of interactions, accelerations and multipliers; ends after the positions if they
/// cannot be assembled.
StartReport start(const System& system, State& state, const GeneralizedAlpha& ga, double dt,
                  const StartOptions& options = {});

/// Initialises the histories of all interactions (turns of an angle, ...).
void initialize_histories(const System& system, State& state);

/// Computes a, A, ḣ of the first step and the multipliers. Generalized-α needs accelerations at the
/// time t + δΔt: they are extrapolated by their rate, a central difference over t ± Δt.
/// @returns false if the velocities are not compatible with any motion.
bool start_accelerations(const System& system, State& state, const GeneralizedAlpha& ga, double dt);

/// Replaces a, A, ḣ at ρ∞ < 1 after a time at which forces jump: they become those by the forces
/// just after it. Velocities are unchanged. Without contacts between bodies.
/// @param t  Just after the jump [s].
void restart_accelerations(const System& system, State& state, const GeneralizedAlpha& ga,
                           double t);

/// Adds to the velocities the constraint-normal difference between the method's smooth solution and
/// the true one (of order Δt²). Without it, multipliers at ρ∞ = 1 have an undamped alternating
/// error of order Δt. Energy changes by O(Δt⁴).
void start_smooth_multipliers(const System& system, State& state, const GeneralizedAlpha& ga,
                              double dt);

}  // namespace polhode
