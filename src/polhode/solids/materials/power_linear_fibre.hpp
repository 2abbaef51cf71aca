// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/solids/materials/fibre_difference.hpp>
#include <polhode/solids/materials/material_kind.hpp>
#include <polhode/solids/materials/power_from_zero.hpp>

namespace polhode::solids {

/// Fibre with a toe that is a power, followed by a straight line:
///
///   F = ξ/β yᵝ                                     for λ < λ_s,   y = λ² − 1 ≥ 0
///   F = b (y − y_s) − E (λ − λ_s) + ξ/β y_sᵝ       beyond
///
/// with the modulus E of the straight part, and ξ and b such that neither the force nor its slope
/// jumps at λ_s:
///
///   ξ = E/(4 (β − 1) λ_s³) y_s^(2 − β),   b = ξ y_s^(β − 1) + E/(2 λ_s)
struct PowerLinearFibre {
  static constexpr const char* kKind = "power_linear";
  double modulus, beta, xi, b, y_s, stretch_s;

  static MaterialKind kind();
  static PowerLinearFibre from(const ParameterValues& values);

  template <class P>
  [[nodiscard]] P energy(P y) const {
    const P toe = y < y_s ? y : P{} + y_s, line = y < y_s ? P{} : y - y_s;
    return xi / beta * power_from_zero(toe, beta) +
           line * (b - modulus / (stretch_s + square_root(P(1.0 + y_s + line))));
  }
  template <class P>
  [[nodiscard]] FibreDifference<P> difference(P y_0, P y_1) const {
    const P one = P{} + 1.0, bend = P{} + y_s;
    const P u_0 = y_0 < y_s ? y_0 : bend, u_1 = y_1 < y_s ? y_1 : bend;
    const P v_0 = y_0 < y_s ? bend : y_0, v_1 = y_1 < y_s ? bend : y_1;
    const PowerFromZero<P> h(beta, u_0, u_1);
    const P toe = xi / beta * h.value;
    const P stretch_1 = square_root(P(1.0 + v_1));
    const P sum = square_root(P(1.0 + v_0)) + stretch_1;
    const P line = b - modulus / sum;
    // The part of the step in the toe.
    const P step = y_1 - y_0, on = y_1 < y_s ? one : P{};
    const auto still = step == 0.0;
    const P safe = still ? one : step, part = still ? on : (u_1 - u_0) / safe;
    return {toe * part + line * (1.0 - part),
            xi / beta * h.derivative * on * part +
                modulus / (2.0 * stretch_1 * sum * sum) * (1.0 - on) * (1.0 - part) +
                (still ? P{} : (toe - line) * (on - part) / safe)};
  }
};

}  // namespace polhode::solids
