// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace polhode {

/// Constants of the generalized-α method. Both weights multiply t_{n+1}.
/// (Chung & Hulbert 1993 weight t_n: their α is 1 − ours.)
///
/// The derived factors are coded in closed form, so that at ρ∞ = 1 the weights of the
/// stored accelerations are exactly zero in floating point (they are undamped noise there).
struct GeneralizedAlpha {
  double rho_inf = 1.0;  ///< Spectral radius for an infinite step [-].
  double alpha_f = 0.5;  ///< Weight of t_{n+1} for forces and moments [-].
  double alpha_m = 0.5;  ///< Weight of t_{n+1} for rates of momentum [-].
  double beta = 0.25;    ///< Newmark β [-].
  double gamma = 0.5;    ///< Newmark γ [-].
  double kappa = 1.0;    ///< α_m/γ: weight of the step's momentum rate [-].
  double c = 2.0;        ///< γ/β: weight of the step's mean velocity [-].
  double c_A = 0.0;      ///< 1 − γ/(2β): weight of Δt·acceleration at t_n [-].
  double delta = 0.0;    ///< α_f − α_m: stored accelerations belong to t_n + δΔt [-].

  /// @eq{eq:ga-alphas-2nd} @eq{eq:ga-Newmark-params}
  /// @throws InputError if rho_inf is outside [0, 1].
  [[nodiscard]] static GeneralizedAlpha from_spectral_radius(double rho_inf);
};

}  // namespace polhode
