// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/dynamics/generalized_alpha.hpp>
#include <polhode/math/cayley.hpp>

namespace polhode {

/// Angular rates in body components.
struct MaterialRates {
  Vec3 W;  ///< [rad/s]
  Vec3 A;  ///< [rad/s²]
};

/// Newmark update of the angular rates from the step's rotation, body components.
/// @eq{eq:td-Newmark-mrot}
///
///   W_{n+1} = c Θ/Δt + (1 − c) W_n + c_A Δt A_n,   c = γ/β,   c_A = 1 − c/2
///
/// @param Theta  Material Cayley vector of the step, Λ_nᵀθ = Λ_{n+1}ᵀθ [-].
[[nodiscard]] inline MaterialRates newmark_rotation(const Vec3& Theta, const MaterialRates& at_n,
                                                    const GeneralizedAlpha& ga, double dt) {
  const auto& [W_n, A_n] = at_n;
  return {.W = ga.c / dt * Theta + (1.0 - ga.c) * W_n + ga.c_A * dt * A_n,
          .A = (Theta / dt - W_n) / (ga.beta * dt) + (1.0 - 0.5 / ga.beta) * A_n};
}

/// Derivatives of W and A at t_{n+1} by a material increment ΔΘ = Λ_{n+1}ᵀΔθ.
struct RatesTangent {
  Mat3 D_W;  ///< [1/s]
  Mat3 D_A;  ///< [1/s²]
};

/// @eq{eq:tf-W-A-linearizations}
[[nodiscard]] inline RatesTangent rates_tangent(const Vec3& Theta, const GeneralizedAlpha& ga,
                                                double dt) {
  const Mat3 T = cayley_tangent(Theta);
  return {.D_W = ga.c / dt * T, .D_A = 1.0 / (ga.beta * dt * dt) * T};
}

}  // namespace polhode
