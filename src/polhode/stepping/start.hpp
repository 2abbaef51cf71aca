// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <polhode/stepping/instant.hpp>
#include <polhode/system/system.hpp>

namespace polhode {

struct StartOptions {
  double load_factor = 1.0;           ///< Of drives while positions are assembled: 0 in statics.
  double position_tolerance = 1e-10;  ///< |g| that counts as assembled [m or -].
  /// Solve for accelerations and multipliers even where the method does not need them (ρ∞ = 1).
  bool multipliers = true;
  /// Start on the smooth solution of the method: multipliers do not alternate from step to step.
  bool smooth_multipliers = false;
};

/// What the consistent start did.
struct StartReport {
  double largest_move = 0.0;  ///< Of any body, |Δr|/ℓ or angle [-]; 0 if it was assembled.
  std::string moved_body;
  double position_residual = 0.0;  ///< Largest |g| before assembly [m or -].
  double velocity_residual = 0.0;  ///< Largest |G v| before projection [m/s or 1/s].
  double velocity_change = 0.0;    ///< Largest change of a velocity by the projection.
  int iterations = 0;
  bool assembled = true;                 ///< False: the constraints contradict one another.
  std::vector<std::string> unsatisfied;  ///< Interactions that do: "joint 'elbow'".
  bool consistent = true;  ///< False: the velocities fit no motion of a singular position.
};

/// Makes a state consistent before its first step: positions on g = 0, velocities on G v = 0,
/// histories of interactions, accelerations and multipliers; stops after the positions if they
/// cannot be assembled.
StartReport start(const System& system, State& state, const GeneralizedAlpha& ga, double dt,
                  const StartOptions& options = {});

/// Lets every interaction write the history it begins with (turns of an angle, ...).
void initialize_histories(const System& system, State& state);

/// Sets a, A, ḣ of the first step and the multipliers. Generalized-α wants accelerations of the
/// time t + δΔt: they are taken there by their rate, a central difference over t ± Δt.
/// @returns false if the velocities fit no motion.
bool start_accelerations(const System& system, State& state, const GeneralizedAlpha& ga, double dt);

/// At ρ∞ < 1, after a time at which forces jump: a, A, ḣ become those that the forces just after it
/// give; before, they told of other forces. Velocities stay. Without contacts between bodies.
/// @param t  Just after the jump [s].
void restart_accelerations(const System& system, State& state, const GeneralizedAlpha& ga,
                           double t);

/// Adds to the velocities the constraint-normal part of what the method's smooth solution differs
/// by from the true one (of order Δt²). Without it, multipliers at ρ∞ = 1 carry an undamped
/// alternating error of order Δt. Energy changes by O(Δt⁴).
void start_smooth_multipliers(const System& system, State& state, const GeneralizedAlpha& ga,
                              double dt);

}  // namespace polhode
