// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/solids/materials/isochoric.hpp>
#include <polhode/solids/materials/material_kind.hpp>

namespace polhode::solids {

/// Nearly incompressible Mooney-Rivlin solid with uncoupled volumetric and isochoric parts:
///
///   W = c₁ (Ī₁ − 3) + c₂ (Ī₂ − 3) + ½ K ln² J,   Ī₁ = J^(−2/3) I₁,  Ī₂ = J^(−4/3) I₂
///
/// This struct is the isochoric part; the volumetric part is the same for all uncoupled materials
/// and added by their kernel.
struct MooneyRivlinUncoupled {
  static constexpr const char* kKind = "mooney_rivlin_uncoupled";
  static constexpr bool kUncoupled = true;
  double c1, c2, bulk;

  static MaterialKind kind() {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    return {.name = kKind,
            .meaning =
                "nearly incompressible Mooney-Rivlin: deviatoric and volumetric response "
                "uncoupled; rubber",
            .parameters =
                {
                    {"c1", "Pa", {}, -kInfinity, kInfinity, "of Ī₁; c1 + c2 is half of μ"},
                    {"c2", "Pa", 0.0, -kInfinity, kInfinity, "of Ī₂"},
                    {"bulk_modulus",
                     "Pa",
                     {},
                     std::numeric_limits<double>::min(),
                     kInfinity,
                     "K, some hundred to some thousand times c1 + c2"},
                },
            .uncoupled = true};
  }
  static MooneyRivlinUncoupled from(const ParameterValues& v) {
    const double c1 = v.at("c1"), c2 = v.at("c2");
    if (!(c1 + c2 > 0.0))
      throw InputError("moduli",
                       format("the shear modulus 2 (c1 + c2) is {:g} Pa", 2.0 * (c1 + c2)),
                       "Give c1 and c2 with a positive sum");
    return {c1, c2, v.at("bulk_modulus")};
  }
  [[nodiscard]] LinearModuli linear() const {
    const double shear = 2.0 * (c1 + c2);
    return {bulk - 2.0 / 3.0 * shear, shear};
  }

  template <class P>
  [[nodiscard]] P energy(const Strain<P>& e) const {
    const IsochoricInvariants<P> i(e);
    return c1 * i.first + c2 * i.second;
  }
  template <class P>
  [[nodiscard]] Coefficients<P> stress(const StrainPair<P>& e) const {
    const IsochoricSlopes<P> slopes(e);
    Coefficients<P> r;
    slopes.add_first(P(P{} + c1), r);
    slopes.add_second(P(P{} + c2), r);
    return r;
  }
};

}  // namespace polhode::solids
