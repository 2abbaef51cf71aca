// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

#include <polhode/solids/materials/ogden_terms.hpp>

namespace polhode::solids {

/// Nearly incompressible Ogden solid with uncoupled volumetric and isochoric parts:
///
///   W = Σ_k c_k/m_k² (λ̄_1^m_k + λ̄_2^m_k + λ̄_3^m_k − 3) + ½ K ln² J,   λ̄ = J^(−1/3) λ
///
/// This struct is the isochoric part, c^(−q/3) Σ_i C_iᵠ − 3 with q = m/2 and c = J² in each term.
struct OgdenUncoupled {
  static constexpr const char* kKind = "ogden_uncoupled";
  static constexpr bool kPrincipal = true;
  static constexpr bool kUncoupled = true;
  OgdenTerms terms;
  double bulk;

  static MaterialKind kind() {
    MaterialKind k{.name = kKind,
                   .meaning =
                       "nearly incompressible Ogden: powers of the principal stretches, deviatoric "
                       "and volumetric response uncoupled; rubber, skin",
                   .parameters = OgdenTerms::parameters(),
                   .uncoupled = true};
    k.parameters.push_back({"bulk_modulus",
                            "Pa",
                            {},
                            std::numeric_limits<double>::min(),
                            std::numeric_limits<double>::infinity(),
                            "K, some hundred to some thousand times the sum of c"});
    return k;
  }
  static OgdenUncoupled from(const ParameterValues& v) {
    return {OgdenTerms::from(v), v.at("bulk_modulus")};
  }
  [[nodiscard]] LinearModuli linear() const {
    return {bulk - 2.0 / 3.0 * terms.shear(), terms.shear()};
  }

  template <class P>
  [[nodiscard]] P energy(const Strain<P>& e) const {
    const PrincipalStrain<P> principal(e);
    const P* L = principal.log;
    const P mean = (1.0 / 3.0) * (L[0] + L[1] + L[2]);
    P sum{};
    for (int k = 0; k < terms.count; ++k)
      for (int i = 0; i < 3; ++i)
        sum += terms.weight[k] * Exponential<P>(terms.exponent[k] * (L[i] - mean)).excess;
    return sum;
  }
  /// The part of the product rule that is a multiple of I or of K_a.
  template <class P>
  [[nodiscard]] Coefficients<P> stress(const StrainPair<P>& e, const PrincipalPair<P>& pair) const {
    const LogDifference<P> l(e.at_n.s, e.at_n1.s);
    Coefficients<P> r;
    for (int k = 0; k < terms.count; ++k) {
      const double q = terms.exponent[k], w = terms.weight[k];
      const PowerDifference<P> a(q / 3.0, l, P(1.0 + e.at_n1.s));
      const P a_mean = 0.5 * (a.minus_one_0 + a.minus_one_1);
      const P b = mean_sum(q, pair);
      r.p += w * (q * a_mean - (q / 3.0) * b + (3.0 + b) * a.plus_p);
      r.q += w * (3.0 + b) * a.value;
      r.dq.c += w * (3.0 + b) * a.derivative;
      r.dw1.c += 0.5 * w * q * a.slope_1;
    }
    return r;
  }
  /// The rest: sums over principal axes.
  template <class P>
  void add_principal(const StrainPair<P>& e, const PrincipalPair<P>& pair, P* S, P* D) const {
    const LogDifference<P> l(e.at_n.s, e.at_n1.s);
    P weight[OgdenTerms::kMost], turned[OgdenTerms::kMost], along[3]{};
    for (int k = 0; k < terms.count; ++k) {
      const double q = terms.exponent[k], w = terms.weight[k];
      const PowerDifference<P> a(q / 3.0, l, P(1.0 + e.at_n1.s));
      weight[k] = w * (1.0 + 0.5 * (a.minus_one_0 + a.minus_one_1));
      turned[k] = 0.5 * w * a.slope_1;
      for (int j = 0; j < 3; ++j)
        along[j] += 0.5 * w * q * a.value * (1.0 + expm1(P((q - 1.0) * pair.at_n1.log[j])));
    }
    PrincipalSlopes<P> f;
    pair.set_slopes(terms.count, terms.exponent, weight, P{}, D != nullptr, f);
    pair.add_stress(f, S);
    if (!D) return;
    pair.add_tangent(f, D);
    // Ā depends on c_1, and B̄, times a[c_0, c_1] K_a, on C_1.
    PrincipalSlopes<P> g;
    pair.set_slopes(terms.count, terms.exponent, turned, P{}, false, g);
    P G[6]{}, cof[6], K_a[6], slope[6]{};
    pair.add_stress(g, G);
    for (int j = 0; j < 3; ++j) {
      P dyad[6];
      symmetric_dyad(pair.at_n1.axis[j], pair.at_n1.axis[j], dyad);
      for (int i = 0; i < 6; ++i) slope[i] += 4.0 * along[j] * dyad[i];
    }
    for (int i = 0; i < 6; ++i) {
      cof[i] = 2.0 * e.cof_1[i];
      K_a[i] = (i < 3 ? 1.0 : 0.0) + e.k[i];
    }
    add_dyad(G, cof, D);
    add_dyad(K_a, slope, D);
  }

 private:
  /// Mean over the ends of Σ_i C_iᵠ − 3.
  template <class P>
  static P mean_sum(double q, const PrincipalPair<P>& pair) {
    P sum{};
    for (int i = 0; i < 3; ++i)
      sum += expm1(P(q * pair.at_n.log[i])) + expm1(P(q * pair.at_n1.log[i]));
    return 0.5 * sum;
  }
};

}  // namespace polhode::solids
