// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/solids/materials/material_kind.hpp>
#include <polhode/solids/materials/strain_pair.hpp>

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
    const P L = log1p(e.s), y = e.t_less_log();
    const Exponential<P> a(-1.0 / 3.0 * L), b(-2.0 / 3.0 * L);
    // 2 t = 2 y + L = 2 y − 3 (−L/3), and 4 (t + II) = 4 (y + II) − 3 (−2L/3).
    return c1 * (2.0 * y + 3.0 * a.excess + 2.0 * e.t * a.minus_one) +
           c2 * (4.0 * (y + e.II) + 3.0 * b.excess + 4.0 * (e.t + e.II) * b.minus_one);
  }
  template <class P>
  [[nodiscard]] Coefficients<P> stress(const StrainPair<P>& e) const {
    const LogDifference<P> l(e.at_n.s, e.at_n1.s);
    const P c_1 = 1.0 + e.at_n1.s;
    const PowerDifference<P> a(1.0 / 3.0, l, c_1), b(2.0 / 3.0, l, c_1);
    // Means over the step: I₁ − 3, I₂ − 3, a − 1, b − 1.
    const P i1 = 2.0 * e.t;
    const P i2 = 2.0 * (e.at_n.t + e.at_n1.t + e.at_n.II + e.at_n1.II);
    const P am = 0.5 * (a.minus_one_0 + a.minus_one_1), bm = 0.5 * (b.minus_one_0 + b.minus_one_1);
    Coefficients<P> r;
    r.w2 = c2 * (1.0 + bm);
    r.q = c1 * (3.0 + i1) * a.value + c2 * (3.0 + i2) * b.value;
    r.p = c1 * (am - 1.0 / 3.0 * i1 + (3.0 + i1) * a.plus_p) +
          c2 * (2.0 * bm - 2.0 / 3.0 * i2 + (3.0 + i2) * b.plus_p);
    r.dw1.c = 0.5 * c1 * a.slope_1;
    r.dw2.c = 0.5 * c2 * b.slope_1;
    r.dq.c = c1 * (3.0 + i1) * a.derivative + c2 * (3.0 + i2) * b.derivative;
    r.dq.i1 = 0.5 * c1 * a.value;
    r.dq.i2 = 0.5 * c2 * b.value;
    return r;
  }
};

}  // namespace polhode::solids
