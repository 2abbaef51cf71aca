// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/solids/materials/material_kind.hpp>
#include <polhode/solids/materials/strain_pair.hpp>

namespace polhode::solids {

/// Compressible Mooney-Rivlin solid:
///
///   W = c₁ (I₁ − 3) + c₂ (I₂ − 3) − 2 (c₁ + 2 c₂) ln J + ½ λ' ln² J,   λ' = λ − 4 c₂
///
/// so that λ and μ = 2 (c₁ + c₂) are the moduli at small strains.
struct MooneyRivlin {
  static constexpr const char* kKind = "mooney_rivlin";
  static constexpr bool kUncoupled = false;
  double c1, c2, log_lame;  // the last is λ'

  static MaterialKind kind() {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    constexpr double kPositive = std::numeric_limits<double>::min();
    return {.name = kKind,
            .meaning = "compressible Mooney-Rivlin: deviatoric and volumetric response coupled",
            .parameters =
                {
                    {"c1", "Pa", {}, -kInfinity, kInfinity, "of I₁; c1 + c2 is half of μ"},
                    {"c2", "Pa", 0.0, -kInfinity, kInfinity, "of I₂"},
                    {"bulk_modulus", "Pa", {}, kPositive, kInfinity, "K = λ + 2μ/3"},
                    {"lame", "Pa", {}, -kInfinity, kInfinity, "first Lamé constant λ"},
                },
            .alternatives = {{"bulk_modulus"}, {"lame"}}};
  }
  static MooneyRivlin from(const ParameterValues& v) {
    const double c1 = v.at("c1"), c2 = v.at("c2"), shear = 2.0 * (c1 + c2);
    if (!(shear > 0.0))
      throw InputError("moduli", format("the shear modulus 2 (c1 + c2) is {:g} Pa", shear),
                       "Give c1 and c2 with a positive sum");
    const double lame =
        v.count("lame") > 0 ? v.at("lame") : v.at("bulk_modulus") - 2.0 / 3.0 * shear;
    if (lame < 4.0 * c2 || !(lame + 2.0 / 3.0 * shear > 0.0))
      throw InputError(
          "moduli",
          format("the first Lamé constant is {:g} Pa; below 4 c2 = {:g} Pa the material would "
                 "collapse when compressed",
                 lame, 4.0 * c2),
          format("Give a bulk modulus of at least {:g} Pa", 4.0 * c2 + 2.0 / 3.0 * shear));
    return {c1, c2, lame - 4.0 * c2};
  }
  [[nodiscard]] LinearModuli linear() const { return {log_lame + 4.0 * c2, 2.0 * (c1 + c2)}; }

  template <class P>
  [[nodiscard]] P energy(const Strain<P>& e) const {
    const P L = log1p(e.s), y = e.t_less_log();
    return 2.0 * c1 * y + 4.0 * c2 * (y + e.II) + 0.125 * log_lame * L * L;
  }
  template <class P>
  [[nodiscard]] Coefficients<P> stress(const StrainPair<P>& e) const {
    const LogDifference<P> l(e.at_n.s, e.at_n1.s);
    const double m = c1 + 2.0 * c2;
    const P f = 0.125 * log_lame * (l.log_0 + l.log_1);
    Coefficients<P> a;
    a.p = f * l.value - m * l.minus_one;
    a.w2 = P{} + c2;
    a.q = (f - m) * l.value;
    a.dq.c = 0.125 * log_lame * l.value / (1.0 + e.at_n1.s) + (f - m) * l.derivative;
    return a;
  }
};

}  // namespace polhode::solids
