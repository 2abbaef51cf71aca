// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include <polhode/solids/materials/fibre_difference.hpp>
#include <polhode/solids/materials/material_kind.hpp>
#include <polhode/solids/materials/power_from_zero.hpp>

namespace polhode::solids {

/// Fibre that stiffens exponentially:
///
///   F = ξ/(αβ) (exp(α yᵝ) − 1), of α = 0: ξ/β yᵝ,   y = I₄ − 1 ≥ 0
///
/// With β = 2: G. A. Holzapfel, T. C. Gasser, R. W. Ogden: A new constitutive framework for
/// arterial wall mechanics, Journal of Elasticity 61 (2000) 1-48.
struct ExponentialFibre {
  static constexpr const char* kKind = "exponential";
  double xi, alpha, beta;

  static MaterialKind kind() {
    constexpr double kPositive = std::numeric_limits<double>::min();
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    return {
        .name = kKind,
        .meaning = "F = ξ/(αβ) (exp(α (I₄ − 1)ᵝ) − 1)",
        .parameters = {
            {"xi",
             "Pa",
             {},
             kPositive,
             kInfinity,
             "ξ: with β = 2 a quarter of the modulus at rest"},
            {"alpha", "-", {}, 0.0, kInfinity, "α: rate of stiffening; 0 makes F = ξ/β (I₄ − 1)ᵝ"},
            {"beta", "-", 2.0, 2.0, 100.0, "β: exponent of the toe"}}};
  }
  static ExponentialFibre from(const ParameterValues& v) {
    return {v.at("xi"), v.at("alpha"), v.at("beta")};
  }

  template <class P>
  [[nodiscard]] P energy(P y) const {
    const P h = power_from_zero(y, beta);
    return xi / beta * (alpha > 0.0 ? expm1(P(alpha * h)) / alpha : h);
  }
  template <class P>
  [[nodiscard]] FibreDifference<P> difference(P y_0, P y_1) const {
    // e^b − e^a = e^mean 2 sinh((b − a)/2), with a, b = α yᵝ.
    const PowerFromZero<P> h(beta, y_0, y_1);
    const P mean = 1.0 + expm1(P(0.5 * alpha * (h.at_0 + h.at_1)));
    const SinhRatio<P> sinh(P(0.5 * alpha * h.value * (y_1 - y_0)));
    const P ratio = 1.0 + sinh.minus_one;
    return {
        xi / beta * mean * ratio * h.value,
        xi / beta * mean *
            (ratio * h.derivative + 0.5 * alpha * h.value * h.slope_1 * (ratio + sinh.derivative))};
  }
};

}  // namespace polhode::solids
