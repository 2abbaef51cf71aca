// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include <polhode/solids/materials/isochoric.hpp>
#include <polhode/solids/materials/material_kind.hpp>

namespace polhode::solids {

/// Ground substance of a Holzapfel-Gasser-Ogden solid, whose families of fibres are exponential
/// with a dispersion:
///
///   W = ½ μ (Ī₁ − 3) + ½ K ((J² − 1)/2 − ln J)
///
/// This struct is the isochoric part.
///
/// T. C. Gasser, R. W. Ogden, G. A. Holzapfel: Hyperelastic modelling of arterial layers with
/// distributed collagen fibre orientations, Journal of the Royal Society Interface 3 (2006) 15-35.
struct HolzapfelGasserOgden {
  static constexpr const char* kKind = "holzapfel_gasser_ogden";
  static constexpr bool kUncoupled = true;
  static constexpr VolumeRule kVolume = VolumeRule::kSquare;
  double shear, bulk;

  static MaterialKind kind() {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    constexpr double kPositive = std::numeric_limits<double>::min();
    return {.name = kKind,
            .meaning =
                "ground substance of arterial walls, nearly incompressible: give two families of "
                "exponential fibres with a dispersion",
            .parameters = {{"shear_modulus", "Pa", {}, kPositive, kInfinity, "μ of the matrix"},
                           {"bulk_modulus",
                            "Pa",
                            {},
                            kPositive,
                            kInfinity,
                            "K, some hundred to some thousand times μ"}},
            .uncoupled = true,
            .volume = kVolume};
  }
  static HolzapfelGasserOgden from(const ParameterValues& v) {
    return {v.at("shear_modulus"), v.at("bulk_modulus")};
  }
  [[nodiscard]] LinearModuli linear() const { return {bulk - 2.0 / 3.0 * shear, shear}; }

  template <class P>
  [[nodiscard]] P energy(const Strain<P>& e) const {
    return 0.5 * shear * IsochoricInvariants<P>(e).first;
  }
  template <class P>
  [[nodiscard]] Coefficients<P> stress(const StrainPair<P>& e) const {
    Coefficients<P> r;
    IsochoricSlopes<P>(e).add_first(P(P{} + 0.5 * shear), r);
    return r;
  }
};

}  // namespace polhode::solids
