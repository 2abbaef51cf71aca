// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/solids/materials/material_kind.hpp>
#include <polhode/solids/materials/principal.hpp>

namespace polhode::solids {

/// Terms c/m² (λ_1ᵐ + λ_2ᵐ + λ_3ᵐ) of Ogden's energies, as powers C_iᵠ with q = m/2.
struct OgdenTerms {
  static constexpr int kMost = 6;
  int count = 0;
  double weight[kMost]{};    ///< c/m² [Pa].
  double exponent[kMost]{};  ///< q.

  /// c1, m1, ... c6, m6.
  static std::vector<Parameter> parameters();
  /// Terms whose c is not zero. @throws InputError if there is none, an m is zero, or the shear
  /// modulus is not positive.
  static OgdenTerms from(const ParameterValues& values);
  /// μ = ½ Σ c.
  [[nodiscard]] double shear() const;
};

}  // namespace polhode::solids
