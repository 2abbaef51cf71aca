// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include <polhode/solids/materials/isochoric.hpp>
#include <polhode/solids/materials/material_kind.hpp>

namespace polhode::solids {

/// Nearly incompressible Veronda-Westmann solid:
///
///   W = c₁ (exp(c₂ (Ī₁ − 3)) − 1) − ½ c₁ c₂ (Ī₂ − 3) + ½ K ln² J
///
/// with the shear modulus c₁ c₂ at small strains. This struct is the isochoric part.
///
/// D. R. Veronda, R. A. Westmann: Mechanical characterization of skin - finite deformations,
/// Journal of Biomechanics 3 (1970) 111-124.
struct VerondaWestmann {
  static constexpr const char* kKind = "veronda_westmann";
  static constexpr bool kUncoupled = true;
  double c1, c2, bulk;

  static MaterialKind kind() {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    constexpr double kPositive = std::numeric_limits<double>::min();
    return {.name = kKind,
            .meaning =
                "nearly incompressible Veronda-Westmann: stiffens exponentially, deviatoric and "
                "volumetric response uncoupled; skin",
            .parameters = {{"c1", "Pa", {}, kPositive, kInfinity, "factor; c1 c2 is μ"},
                           {"c2", "-", {}, kPositive, kInfinity, "rate of stiffening with Ī₁"},
                           {"bulk_modulus",
                            "Pa",
                            {},
                            kPositive,
                            kInfinity,
                            "K, some hundred to some thousand times c1 c2"}},
            .uncoupled = true};
  }
  static VerondaWestmann from(const ParameterValues& v) {
    return {v.at("c1"), v.at("c2"), v.at("bulk_modulus")};
  }
  [[nodiscard]] LinearModuli linear() const { return {bulk - 2.0 / 3.0 * c1 * c2, c1 * c2}; }

  template <class P>
  [[nodiscard]] P energy(const Strain<P>& e) const {
    const IsochoricInvariants<P> i(e);
    return c1 * (expm1(P(c2 * i.first)) - 0.5 * c2 * i.second);
  }
  template <class P>
  [[nodiscard]] Coefficients<P> stress(const StrainPair<P>& e) const {
    const P i_0 = IsochoricInvariants<P>(e.at_n).first, i_1 = IsochoricInvariants<P>(e.at_n1).first;
    // e^b − e^a = e^mean 2 sinh((b − a)/2), with a, b = c₂ (Ī₁ − 3).
    const P mean = 1.0 + expm1(P(0.5 * c2 * (i_0 + i_1)));
    const SinhRatio<P> h(P(0.5 * c2 * (i_1 - i_0)));
    const P ratio = 1.0 + h.minus_one;
    const IsochoricSlopes<P> slopes(e);
    Coefficients<P> r;
    slopes.add_first(P(c1 * c2 * mean * ratio), r);
    slopes.add_second(P(P{} - 0.5 * c1 * c2), r);
    slopes.add_first_slope(P(0.5 * c1 * c2 * c2 * mean * (ratio + h.derivative)), e.at_n1, r);
    return r;
  }
};

}  // namespace polhode::solids
