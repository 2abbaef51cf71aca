// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/solids/materials/material_kind.hpp>
#include <polhode/solids/materials/strain_pair.hpp>

namespace polhode::solids {

/// Compressible neo-Hookean solid:
///
///   W = ½ μ (I₁ − 3) − μ ln J + ½ λ ln² J
///
/// J. Bonet, R. D. Wood: Nonlinear Continuum Mechanics for Finite Element Analysis, 2nd ed.,
/// Cambridge University Press 2008, section 6.4.3.
struct NeoHookean {
  static constexpr const char* kKind = "neo_hookean";
  static constexpr bool kUncoupled = false;
  LinearModuli moduli;

  static MaterialKind kind() {
    return {.name = kKind,
            .meaning = "compressible neo-Hookean: rubber, foam, tissue at large strains",
            .parameters = isotropic_parameters(),
            .alternatives = isotropic_alternatives()};
  }
  static NeoHookean from(const ParameterValues& values) { return {isotropic_moduli(values)}; }
  [[nodiscard]] LinearModuli linear() const { return moduli; }

  template <class P>
  [[nodiscard]] P energy(const Strain<P>& e) const {
    const P L = log1p(e.s);
    return moduli.shear * e.t_less_log() + 0.125 * moduli.lame * L * L;
  }
  template <class P>
  [[nodiscard]] Coefficients<P> stress(const StrainPair<P>& e) const {
    const LogDifference<P> l(e.at_n.s, e.at_n1.s);
    const P f = 0.125 * moduli.lame * (l.log_0 + l.log_1);
    Coefficients<P> a;
    a.p = f * l.value - 0.5 * moduli.shear * l.minus_one;
    a.q = (f - 0.5 * moduli.shear) * l.value;
    a.dq.c =
        0.125 * moduli.lame * l.value / (1.0 + e.at_n1.s) + (f - 0.5 * moduli.shear) * l.derivative;
    return a;
  }
};

}  // namespace polhode::solids
