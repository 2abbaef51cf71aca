// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>

#include <polhode/solids/materials/power_linear_fibre.hpp>

namespace polhode::solids {

MaterialKind PowerLinearFibre::kind() {
  constexpr double kPositive = std::numeric_limits<double>::min();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  return {.name = kKind,
          .meaning = "F = ξ/β (I₄ − 1)ᵝ, straight beyond λ_s: ligament, tendon",
          .parameters = {{"modulus", "Pa", {}, kPositive, kInfinity, "E of the straightened fibre"},
                         {"beta", "-", 2.0, 2.0, 100.0, "β: exponent of the toe"},
                         {"straight_stretch",
                          "-",
                          {},
                          std::nextafter(1.0, 2.0),
                          1e3,
                          "λ_s at which fibres are straight, above 1"}}};
}

PowerLinearFibre PowerLinearFibre::from(const ParameterValues& v) {
  const double E = v.at("modulus"), beta = v.at("beta"), s = v.at("straight_stretch");
  const double y = (s - 1.0) * (s + 1.0);
  const double xi = E / (4.0 * (beta - 1.0) * s * s * s) * std::pow(y, 2.0 - beta);
  return {E, beta, xi, xi * std::pow(y, beta - 1.0) + E / (2.0 * s), y, s};
}

}  // namespace polhode::solids
