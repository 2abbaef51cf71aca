// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include <polhode/solids/materials/ogden_terms.hpp>

namespace polhode::solids {

/// Compressible Ogden solid:
///
///   W = Σ_k c_k/m_k² (λ_1^m_k + λ_2^m_k + λ_3^m_k − 3 − m_k ln J) + ½ λ' (J − 1)²
///
/// so that λ' and μ = ½ Σ c_k are the moduli at small strains.
///
/// R. W. Ogden: Large deformation isotropic elasticity: on the correlation of theory and experiment
/// for compressible rubberlike solids, Proceedings of the Royal Society A 328 (1972) 567-583.
struct Ogden {
  static constexpr const char* kKind = "ogden";
  static constexpr bool kPrincipal = true;
  static constexpr bool kUncoupled = false;
  OgdenTerms terms;
  double lame;

  static MaterialKind kind() {
    MaterialKind k{.name = kKind,
                   .meaning = "compressible Ogden: powers of the principal stretches; foam, tissue",
                   .parameters = OgdenTerms::parameters()};
    k.parameters.push_back({"lame",
                            "Pa",
                            {},
                            0.0,
                            std::numeric_limits<double>::infinity(),
                            "first Lamé constant λ, of ½ λ (J − 1)²"});
    return k;
  }
  static Ogden from(const ParameterValues& v) { return {OgdenTerms::from(v), v.at("lame")}; }
  [[nodiscard]] LinearModuli linear() const { return {lame, terms.shear()}; }

  template <class P>
  [[nodiscard]] P energy(const Strain<P>& e) const {
    const PrincipalStrain<P> principal(e);
    // Σ_i ln C_i = 2 ln J, so that all terms are of second order in the strains.
    P sum{};
    for (int k = 0; k < terms.count; ++k)
      for (int i = 0; i < 3; ++i)
        sum += terms.weight[k] * Exponential<P>(terms.exponent[k] * principal.log[i]).excess;
    const P j = expm1(P(0.5 * log1p(e.s)));
    return sum + 0.5 * lame * j * j;
  }
  template <class P>
  [[nodiscard]] Coefficients<P> stress(const StrainPair<P>& e,
                                       const PrincipalPair<P>& /*pair*/) const {
    // ½ λ' (J_0 + J_1 − 2)/(J_0 + J_1) for ½ λ' (J − 1)².
    const P j_0 = expm1(P(0.5 * log1p(e.at_n.s))), j_1 = expm1(P(0.5 * log1p(e.at_n1.s)));
    const P inverse = 1.0 / (2.0 + j_0 + j_1);
    Coefficients<P> a;
    a.p = a.q = 0.5 * lame * (j_0 + j_1) * inverse;
    a.dq.c = 0.5 * lame * inverse * inverse / (1.0 + j_1);
    return a;
  }
  template <class P>
  void add_principal(const StrainPair<P>& /*e*/, const PrincipalPair<P>& pair, P* S, P* D) const {
    P weight[OgdenTerms::kMost];
    double log_weight = 0.0;
    for (int k = 0; k < terms.count; ++k) {
      weight[k] = P{} + terms.weight[k];
      log_weight -= terms.weight[k] * terms.exponent[k];
    }
    PrincipalSlopes<P> f;
    pair.set_slopes(terms.count, terms.exponent, weight, P(P{} + log_weight), D != nullptr, f);
    pair.add_stress(f, S);
    if (D) pair.add_tangent(f, D);
  }
};

}  // namespace polhode::solids
