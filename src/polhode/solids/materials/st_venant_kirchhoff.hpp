// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/solids/materials/material_kind.hpp>
#include <polhode/solids/materials/strain_pair.hpp>

namespace polhode::solids {

/// Hooke's law between Green's strain and the second Piola-Kirchhoff stress:
///
///   W = ½ λ (tr E)² + μ E : E
///
/// For small strains with arbitrary rotations. It softens under strong compression and then
/// collapses.
struct StVenantKirchhoff {
  static constexpr const char* kKind = "elastic";
  static constexpr bool kUncoupled = false;
  LinearModuli moduli;

  static MaterialKind kind() {
    return {.name = kKind,
            .meaning = "St. Venant-Kirchhoff: linear between Green's strain and stress; metals",
            .parameters = isotropic_parameters(),
            .alternatives = isotropic_alternatives(),
            .also = "st_venant_kirchhoff"};
  }
  static StVenantKirchhoff from(const ParameterValues& values) {
    return {isotropic_moduli(values)};
  }
  [[nodiscard]] LinearModuli linear() const { return moduli; }

  template <class P>
  [[nodiscard]] P energy(const Strain<P>& e) const {
    return (0.5 * moduli.lame + moduli.shear) * e.t * e.t - 2.0 * moduli.shear * e.II;
  }
  template <class P>
  [[nodiscard]] Coefficients<P> stress(const StrainPair<P>& e) const {
    const double M = moduli.lame + 2.0 * moduli.shear;
    Coefficients<P> a;
    a.p = 0.5 * M * e.t;
    a.w2 = P{} - 0.5 * moduli.shear;
    a.dw1.i1 = P{} + 0.125 * M;
    return a;
  }
};

}  // namespace polhode::solids
