// SPDX-License-Identifier: Apache-2.0
// Strains at both ends of a step, their invariants and the exact discrete derivatives of these.
// Derivation: docs/theory/solids.md.
#pragma once

#include <polhode/solids/simd/math.hpp>

namespace polhode::solids {

// Symmetric tensors are six numbers in the order 11 22 33 12 23 31.

template <class P>
inline void cofactor(const P* a, P* c) {
  c[0] = a[1] * a[2] - a[4] * a[4];
  c[1] = a[0] * a[2] - a[5] * a[5];
  c[2] = a[0] * a[1] - a[3] * a[3];
  c[3] = a[4] * a[5] - a[3] * a[2];
  c[4] = a[3] * a[5] - a[0] * a[4];
  c[5] = a[3] * a[4] - a[1] * a[5];
}

/// Green's strain E = (C − I)/2 at one time, with its invariants.
template <class P>
struct Strain {
  P E[6];
  P cof[6];  ///< cof E.
  P t;       ///< tr E = (I₁ − 3)/2.
  P II;      ///< tr cof E = (I₂ − 3)/4 − tr E.
  P III;     ///< det E.
  P s;       ///< c − 1 = det C − 1, by the expansion of det(I + 2E): no cancellation.

  explicit Strain(const P* strain) {
    for (int i = 0; i < 6; ++i) E[i] = strain[i];
    cofactor(E, cof);
    t = E[0] + E[1] + E[2];
    II = cof[0] + cof[1] + cof[2];
    III = E[0] * cof[0] + E[3] * cof[3] + E[5] * cof[5];
    s = 2.0 * t + 4.0 * II + 8.0 * III;
  }

  /// (I₁ − 3)/2 − ln J, of second order in E, without cancellation.
  [[nodiscard]] P t_less_log() const { return 0.5 * log1p_lack(s) - 2.0 * II - 4.0 * III; }
};

/// The two ends of a step, and the discrete derivatives of invariants between them.
///
/// Each satisfies Δ(invariant) = K : ΔC to round-off, for steps of any size:
/// @eq{solid-discrete-invariants}
///
///   I₁: K = I      I₂: K = tr C̄ I − C̄      c: K_a = (cof C_0 + 4 cof C̄ + cof C_1)/6
template <class P>
struct StrainPair {
  Strain<P> at_n, at_n1;
  P mean[6];   ///< Ē.
  P t;         ///< tr Ē.
  P k[6];      ///< K_a − I.
  P A[6];      ///< (C_1 + C_0/2)/3: D K_a[dC_1] = A ⨯ dC_1.
  P cof_1[6];  ///< cof C_1 = dc_1/dC_1.

  StrainPair(const P* E_0, const P* E_1) : at_n(E_0), at_n1(E_1) {
    P cof_mean[6];
    for (int i = 0; i < 6; ++i) mean[i] = 0.5 * (E_0[i] + E_1[i]);
    cofactor(mean, cof_mean);
    t = mean[0] + mean[1] + mean[2];
    for (int i = 0; i < 6; ++i) {
      const double one = i < 3 ? 1.0 : 0.0;
      k[i] = 2.0 * (one * t - mean[i]) +
             (2.0 / 3.0) * (at_n.cof[i] + 4.0 * cof_mean[i] + at_n1.cof[i]);
      A[i] = (2.0 / 3.0) * E_1[i] + (1.0 / 3.0) * E_0[i] + 0.5 * one;
      cof_1[i] = one + 2.0 * (one * at_n1.t - E_1[i]) + 4.0 * at_n1.cof[i];
    }
  }
};

/// A scalar function of C_1: its derivative in terms of three tensors.
template <class P>
struct Slope {
  P c{};   ///< Times cof C_1.
  P i1{};  ///< Times I.
  P i2{};  ///< Times I₁ I − C_1.
};

/// Discrete stress of an isotropic material, by invariants:
///
///   S/2 = w1 I + w2 (tr C̄ I − C̄) + q K_a = p I + 2 w2 (tr Ē I − Ē) + q (K_a − I)
///
/// with p = w1 + 2 w2 + q, computed by a material without cancellation: it vanishes at rest.
template <class P>
struct Coefficients {
  P p{}, w2{}, q{};
  Slope<P> dw1, dw2, dq;
};

/// Adds f times the 6×6 matrix of A ⨯ (tensor cross product), for strains with doubled shear.
template <class P>
inline void add_cross(const P& f, const P* A, P* D) {
  const P a0 = f * A[0], a1 = f * A[1], a2 = f * A[2], a3 = f * A[3], a4 = f * A[4], a5 = f * A[5];
  D[1] += a2, D[6] += a2, D[2] += a1, D[12] += a1, D[8] += a0, D[13] += a0;
  D[4] -= a4, D[24] -= a4, D[11] -= a5, D[31] -= a5, D[15] -= a3, D[20] -= a3;
  D[21] -= 0.5 * a2, D[28] -= 0.5 * a0, D[35] -= 0.5 * a1;
  D[22] += 0.5 * a5, D[27] += 0.5 * a5;
  D[23] += 0.5 * a4, D[33] += 0.5 * a4;
  D[29] += 0.5 * a3, D[34] += 0.5 * a3;
}

template <class P>
inline void add_dyad(const P* a, const P* b, P* D) {
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) D[6 * i + j] += a[i] * b[j];
}

/// Computes S and, if needed, D = ∂S/∂E_1, which acts on strains with doubled shear.
/// @eq{solid-discrete-stress}
template <class P>
inline void write_stress(const StrainPair<P>& pair, const Coefficients<P>& a, P* S, P* D) {
  P g2[6];  // tr Ē I − Ē
  for (int i = 0; i < 6; ++i) g2[i] = (i < 3 ? pair.t : P{}) - pair.mean[i];
  for (int i = 0; i < 6; ++i)
    S[i] = 2.0 * ((i < 3 ? a.p : P{}) + 2.0 * a.w2 * g2[i] + a.q * pair.k[i]);
  if (!D) return;
  const auto slope = [&](const Slope<P>& d, P* v) {
    const Strain<P>& e = pair.at_n1;
    for (int i = 0; i < 6; ++i) {
      const double one = i < 3 ? 1.0 : 0.0;
      v[i] = 4.0 *
             (d.c * pair.cof_1[i] + one * d.i1 + d.i2 * (2.0 * one * (1.0 + e.t) - 2.0 * e.E[i]));
    }
  };
  P dw1[6], dw2[6], dq[6];
  slope(a.dw1, dw1);
  slope(a.dw2, dw2);
  slope(a.dq, dq);
  for (int i = 0; i < 6; ++i) {
    const double one = i < 3 ? 1.0 : 0.0;
    const P K2 = 2.0 * (one + g2[i]), K_a = one + pair.k[i];
    for (int j = 0; j < 6; ++j) D[6 * i + j] = one * dw1[j] + K2 * dw2[j] + K_a * dq[j];
  }
  const P h = 2.0 * a.w2;  // 4 w2 · ½ (I⊗I − 𝕀)
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      if (i != j) D[6 * i + j] += h;
  for (int i = 3; i < 6; ++i) D[7 * i] -= 0.5 * h;
  add_cross(P(4.0 * a.q), pair.A, D);
}

}  // namespace polhode::solids
