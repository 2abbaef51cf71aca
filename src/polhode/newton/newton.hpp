// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <polhode/equations/trial.hpp>
#include <polhode/newton/newton_report.hpp>

namespace polhode {

/// When the Jacobian is factored anew.
enum class JacobianPolicy { every_iteration, every_step, automatic, never };

struct NewtonOptions {
  double tolerance = 1e-5;  ///< On the largest increment, |Δr|/ℓ or |Δθ| [-].
  int max_iterations = 12;
  JacobianPolicy jacobian = JacobianPolicy::automatic;
  bool line_search = true;
  double max_rotation = 2.0;  ///< Largest |Θ| a body may turn in the step [-].
  double energy_scale = 0.0;  ///< Size of the energies of the run so far [J].
};

/// Newton on the predicted trial, with polish: round-off conservation is reached when the energy
/// that multipliers may leak, Σ|λ g|, is at round-off.
[[nodiscard]] NewtonReport solve_newton(const System& system, const State& state, Trial& trial,
                                        NewtonEngine& engine, const NewtonOptions& options);

}  // namespace polhode
