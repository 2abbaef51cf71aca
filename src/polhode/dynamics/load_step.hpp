// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include <polhode/dynamics/body_step.hpp>

namespace polhode {

/// Weights of a load step, which leads from one equilibrium to the next: forces at its end, no
/// rates of momentum, no velocities.
[[nodiscard]] inline GeneralizedAlpha load_step_weights() {
  GeneralizedAlpha ga = GeneralizedAlpha::from_spectral_radius(0.0);
  ga.alpha_m = ga.kappa = ga.c = ga.c_A = ga.delta = 0.0;
  return ga;
}

/// Whether this is a load step: its increments are no velocities.
[[nodiscard]] inline bool is_load_step(const StepContext& c) { return c.ga.kappa == 0.0; }

/// Load factor of the last equilibrium [-].
[[nodiscard]] inline double load_factor_n(const StepContext& c) {
  return is_load_step(c) ? c.load_factor_n : c.load_factor;
}

/// Force of which the work over a step is made: forces of dynamics are means of the step; over a
/// load step they vary from one end to the other, taken as a straight line. @eq{statics-work}
[[nodiscard]] inline double working_force(const StepContext& c, double at_n, double in_step) {
  return is_load_step(c) ? 0.5 * (at_n + in_step) : in_step;
}

/// Time at which functions are evaluated for t_n [s].
[[nodiscard]] inline double function_time_n(const StepContext& c) {
  return is_load_step(c) ? std::max(c.t_n, 0.0) : c.t_n;
}

}  // namespace polhode
