// SPDX-License-Identifier: Apache-2.0
#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/dynamics/generalized_alpha.hpp>

namespace polhode {

GeneralizedAlpha GeneralizedAlpha::from_spectral_radius(double rho_inf) {
  if (!(rho_inf >= 0.0 && rho_inf <= 1.0))
    throw InputError("analysis.rho_inf", format("must lie in [0, 1], but is {}", rho_inf),
                     "1 conserves energy, 0 damps the highest frequencies in one step");
  const double rho = rho_inf;
  // β = ¼(1 + α_m − α_f)² and γ = ½ + α_m − α_f with α_m − α_f = (1 − ρ)/(1 + ρ).
  return {.rho_inf = rho,
          .alpha_f = 1.0 / (1.0 + rho),
          .alpha_m = (2.0 - rho) / (1.0 + rho),
          .beta = 1.0 / ((1.0 + rho) * (1.0 + rho)),
          .gamma = (3.0 - rho) / (2.0 * (1.0 + rho)),
          .kappa = 2.0 * (2.0 - rho) / (3.0 - rho),
          .c = 0.5 * (3.0 - rho) * (1.0 + rho),
          .c_A = 1.0 - 0.25 * (3.0 - rho) * (1.0 + rho),
          .delta = -(1.0 - rho) / (1.0 + rho)};
}

}  // namespace polhode
