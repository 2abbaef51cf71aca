// SPDX-License-Identifier: Apache-2.0
// Operations at one point of kWidth elements: strains, stress, derivative. Included by the files
// kernels_*.cpp only.
#pragma once

#include <polhode/solids/elements/kernels.hpp>
#include <polhode/solids/materials/strain_pair.hpp>

namespace polhode::solids {

/// H = Σ u_r ⊗ G_r, row by row.
template <class P, int kRows>
inline void displacement_gradient(const P (*u)[3], const P* G, P* H) {
  for (int i = 0; i < 9; ++i) H[i] = P{};
  for (int r = 0; r < kRows; ++r)
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) H[3 * i + j] += u[r][i] * G[3 * r + j];
}

/// E = (H + Hᵀ + HᵀH)/2: exact digits for small displacements.
template <class P>
inline void green_strain(const P* H, P* E) {
  const auto entry = [&](int i, int j) {
    return 0.5 *
           (H[3 * i + j] + H[3 * j + i] + H[i] * H[j] + H[3 + i] * H[3 + j] + H[6 + i] * H[6 + j]);
  };
  E[0] = entry(0, 0);
  E[1] = entry(1, 1);
  E[2] = entry(2, 2);
  E[3] = entry(0, 1);
  E[4] = entry(1, 2);
  E[5] = entry(2, 0);
}

template <class P>
inline void add_identity(const P* H, P* F) {
  for (int i = 0; i < 9; ++i) F[i] = H[i] + (i % 4 == 0 ? 1.0 : 0.0);
}

template <class P>
inline P determinant(const P* F) {
  return F[0] * (F[4] * F[8] - F[5] * F[7]) - F[1] * (F[3] * F[8] - F[5] * F[6]) +
         F[2] * (F[3] * F[7] - F[4] * F[6]);
}

/// A = F S, S symmetric.
template <class P>
inline void times_symmetric(const P* F, const P* S, P* A) {
  for (int i = 0; i < 3; ++i) {
    const P* f = F + 3 * i;
    A[3 * i] = f[0] * S[0] + f[1] * S[3] + f[2] * S[5];
    A[3 * i + 1] = f[0] * S[3] + f[1] * S[1] + f[2] * S[4];
    A[3 * i + 2] = f[0] * S[5] + f[1] * S[4] + f[2] * S[2];
  }
}

/// sym(e_c·F ⊗ G) with doubled shear: the strain by displacing row G along world axis c.
template <class P>
inline void strain_of_move(const P* f, const P* G, P* B) {
  B[0] = f[0] * G[0];
  B[1] = f[1] * G[1];
  B[2] = f[2] * G[2];
  B[3] = f[0] * G[1] + f[1] * G[0];
  B[4] = f[1] * G[2] + f[2] * G[1];
  B[5] = f[2] * G[0] + f[0] * G[2];
}

/// Data of a point for the tangent.
template <class P>
struct PointRecord {
  P F_alpha[9];  ///< With the weight of the point.
  P F_t[9];      ///< Strains of displacements at t_{n+1} are sym(F_tᵀ ∇δu).
  P S[6];        ///< For the geometric part, including α_f and the weight.
  P D[36];
  P F_v[9], F_ve[9];  ///< Strain rates of displacements of nodes and of enhanced modes.
};

/// The two strains of the discrete stress.
///
/// At α_f = 1, at an instant, and for midpoint stress both are equal, and the derivative by one of
/// them is half of the derivative: `factor` corrects for that.
template <class P>
struct StressEnds {
  const P *E_a, *E_b;
  P J_a, J_b;
  double factor;
};

/// Stress of material and fibres together. D may be null.
/// @param fibres  Directions: 3 packs by family.
template <class P>
inline void stress_between(const ElementData& data, const double* fibres, bool whole, const P* E_a,
                           const P* E_b, P* S, P* D) {
  double* d = D ? numbers(D) : nullptr;
  data.law_kernel.stress(data.law, whole, numbers(E_a), numbers(E_b), numbers(S), d);
  for (int f = 0; f < data.family_count; ++f) {
    const FibreFamily& family = data.families[f];
    family.kernel.add_stress(family.law, data.uncoupled, family.dispersion,
                             fibres + 3 * kWidth<P> * f, numbers(E_a), numbers(E_b), numbers(S), d);
  }
}

/// Adds (α_f − 1/2)(S_1 − S_0): second order for ρ∞ < 1. @eq{solid-stress-alpha}
template <class P>
inline void add_shift(const ElementData& data, const double* fibres, bool whole, double shift,
                      const P* E_0, const P* E_1, P* S, P* D) {
  P S_0[6], S_1[6], D_1[36];
  stress_between<P>(data, fibres, whole, E_0, E_0, S_0, nullptr);
  stress_between<P>(data, fibres, whole, E_1, E_1, S_1, D ? D_1 : nullptr);
  for (int i = 0; i < 6; ++i) S[i] += shift * (S_1[i] - S_0[i]);
  if (D)
    for (int i = 0; i < 36; ++i) D[i] += 2.0 * shift * D_1[i];
}

/// Discrete derivative of J by E: J_b − J_a = g : (E_b − E_a), and the data of its own derivative.
/// @eq{solid-mean-dilatation}
template <class P>
struct VolumeGradient {
  P g[6];    ///< 2 K_a/(J_a + J_b).
  P g_b[6];  ///< J_b C_b⁻¹.
  P inverse;

  VolumeGradient(const StrainPair<P>& pair, P J_a, P J_b) {
    inverse = 1.0 / (J_a + J_b);
    const P at_b = 1.0 / J_b;
    for (int i = 0; i < 6; ++i) {
      g[i] = 2.0 * inverse * ((i < 3 ? 1.0 : 0.0) + pair.k[i]);
      g_b[i] = at_b * pair.cof_1[i];
    }
  }
  /// Adds p ∂g/∂E_b.
  void add_derivative(const P& p, const StrainPair<P>& pair, P* D) const {
    add_cross(P(4.0 * p * inverse), pair.A, D);
    const P h = -p * inverse;
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j) D[6 * i + j] += h * g[i] * g_b[j];
  }
};

/// Kelvin-Voigt: Ė_α = sym(F_αᵀ Ḟ_α), S_v = λ_v tr Ė I + 2 μ_v Ė. @eq{solid-viscosity}
template <class P>
inline void strain_rate(const P* F, const P* F_dot, P* rate) {
  const auto entry = [&](int i, int j) {
    P s = P{};
    for (int k = 0; k < 3; ++k)
      s += F[3 * k + i] * F_dot[3 * k + j] + F[3 * k + j] * F_dot[3 * k + i];
    return 0.5 * s;
  };
  rate[0] = entry(0, 0);
  rate[1] = entry(1, 1);
  rate[2] = entry(2, 2);
  rate[3] = entry(0, 1);
  rate[4] = entry(1, 2);
  rate[5] = entry(2, 0);
}

template <class P>
inline void add_viscous_stress(const ElementData& data, const P* rate, P* S) {
  const P pressure = data.viscous_lame * (rate[0] + rate[1] + rate[2]);
  for (int i = 0; i < 6; ++i) S[i] += 2.0 * data.viscous_shear * rate[i] + (i < 3 ? pressure : P{});
}

template <class P>
inline P viscous_power(const ElementData& data, const P* rate) {
  const P trace = rate[0] + rate[1] + rate[2];
  const P squares = rate[0] * rate[0] + rate[1] * rate[1] + rate[2] * rate[2] +
                    2.0 * (rate[3] * rate[3] + rate[4] * rate[4] + rate[5] * rate[5]);
  return data.viscous_lame * trace * trace + 2.0 * data.viscous_shear * squares;
}

}  // namespace polhode::solids
