// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <polhode/equations/newton_engine.hpp>
#include <polhode/newton/least_reactions.hpp>
#include <polhode/newton/newton_report.hpp>

namespace polhode {

/// Policies for the factorisation of the Jacobian.
enum class JacobianPolicy { every_iteration, every_step, automatic, never };

struct NewtonOptions {
  double tolerance = 1e-5;  ///< On the largest increment, |Δr|/ℓ or |Δθ| [-].
  int max_iterations = 12;
  JacobianPolicy jacobian = JacobianPolicy::automatic;
  bool line_search = true;
  double max_rotation = 2.0;            ///< Largest rotation |Θ| of a body in the step [-].
  double energy_scale = 0.0;            ///< Energy scale of the run so far [J].
  LeastReactions* reactions = nullptr;  ///< Null where no force depends on redundant reactions.
};

/// Solves the predicted trial by Newton's method with an extra iteration: conservation to round-off
/// is reached when the possible energy leak of the multipliers, Σ|λ g|, is at round-off.
[[nodiscard]] NewtonReport solve_newton(const System& system, const State& state, Trial& trial,
                                        NewtonEngine& engine, const NewtonOptions& options);

}  // namespace polhode
