// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <polhode/equations/trial.hpp>

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

/// How a Newton solve went. Not to converge is an outcome, not an exception: the stepper may
/// halve the step and try again.
struct NewtonReport {
  bool converged = false;
  double t = 0.0;   ///< Start of the step [s].
  double dt = 0.0;  ///< [s]
  int iterations = 0;
  std::vector<double> increments;  ///< Largest scaled increment, one per iteration [-].
  double rotation = 0.0;           ///< Largest |Θ| of the step [-].
  bool hard = false;   ///< Converged, but slowly: it needed more iterations than it has.
  std::string reason;  ///< If not converged: "contracts too slowly", "turns too far" ...
  std::string worst;   ///< Largest increment: "body 'forearm'".
  ConstraintCheck constraints;
  [[nodiscard]] std::string text() const;  ///< One paragraph, with what to try next.
};

/// Newton on the predicted trial, with polish: round-off conservation is reached when the energy
/// that multipliers may leak, Σ|λ g|, is at round-off.
[[nodiscard]] NewtonReport solve_newton(const System& system, const State& state, Trial& trial,
                                        NewtonEngine& engine, const NewtonOptions& options);

}  // namespace polhode
