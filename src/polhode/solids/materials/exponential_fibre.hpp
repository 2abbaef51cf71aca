// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include <polhode/solids/materials/material_kind.hpp>
#include <polhode/solids/simd/math.hpp>

namespace polhode::solids {

/// Discrete stress of a fibre over a step.
template <class P>
struct FibreDifference {
  P value;       ///< F[y_0, y_1] = (F(y_1) − F(y_0))/(y_1 − y_0) [Pa].
  P derivative;  ///< ∂F[y_0, y_1]/∂y_1 [Pa].
};

/// Fibre that stiffens exponentially:
///
///   F = ξ/(2α) (exp(α y²) − 1),   y = I₄ − 1 ≥ 0
///
/// G. A. Holzapfel, T. C. Gasser, R. W. Ogden: A new constitutive framework for arterial wall
/// mechanics, Journal of Elasticity 61 (2000) 1-48.
struct ExponentialFibre {
  static constexpr const char* kKind = "exponential";
  double xi, alpha;

  static MaterialKind kind() {
    constexpr double kPositive = std::numeric_limits<double>::min();
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    return {.name = kKind,
            .meaning = "F = ξ/(2α) (exp(α (I₄ − 1)²) − 1)",
            .parameters = {
                {"xi", "Pa", {}, kPositive, kInfinity, "ξ: a quarter of the modulus at rest"},
                {"alpha", "-", {}, kPositive, kInfinity, "α: rate of stiffening"}}};
  }
  static ExponentialFibre from(const ParameterValues& v) { return {v.at("xi"), v.at("alpha")}; }

  template <class P>
  [[nodiscard]] P energy(P y) const {
    return xi / (2.0 * alpha) * expm1(P(alpha * y * y));
  }
  template <class P>
  [[nodiscard]] FibreDifference<P> difference(P y_0, P y_1) const {
    // e^b − e^a = e^mean 2 sinh((b − a)/2), with a, b = α y².
    const P mean = 1.0 + expm1(P(0.5 * alpha * (y_0 * y_0 + y_1 * y_1)));
    const P half = 0.5 * alpha * (y_1 - y_0) * (y_1 + y_0);
    const SinhRatio<P> h(half);
    const P ratio = 1.0 + h.minus_one, sum = y_0 + y_1;
    return {0.5 * xi * sum * mean * ratio,
            0.5 * xi * mean * (ratio + sum * alpha * y_1 * (ratio + h.derivative))};
  }
};

}  // namespace polhode::solids
