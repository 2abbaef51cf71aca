// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/core/types.hpp>
#include <polhode/dynamics/generalized_alpha.hpp>

namespace polhode {

/// Rates of a centre of mass, world.
struct TranslationRates {
  Vec3 v;  ///< [m/s]
  Vec3 a;  ///< [m/s²]
};

/// Newmark update of the rates of the centre of mass from its displacement over the step.
/// @eq{eq:td-Newmark-COM}
///
///   v_{n+1} = c u/Δt + (1 − c) v_n + c_A Δt a_n,   c = γ/β,   c_A = 1 − c/2
///
/// In this form the weight of a_n is exactly zero at ρ∞ = 1.
/// @param u  r_{n+1} − r_n [m].
[[nodiscard]] inline TranslationRates newmark_translation(const Vec3& u,
                                                          const TranslationRates& at_n,
                                                          const GeneralizedAlpha& ga, double dt) {
  const auto& [v_n, a_n] = at_n;
  return {.v = ga.c / dt * u + (1.0 - ga.c) * v_n + ga.c_A * dt * a_n,
          .a = (u / dt - v_n) / (ga.beta * dt) + (1.0 - 0.5 / ga.beta) * a_n};
}

}  // namespace polhode
