// SPDX-License-Identifier: Apache-2.0
// The kernels of all laws for packs of one width. Included by the files kernels_*.cpp only.
#pragma once

#include <polhode/solids/materials/kernels.hpp>
#include <polhode/solids/materials/laws.hpp>

namespace polhode::solids {

template <class P>
inline const P* packs(const double* p) {
  return reinterpret_cast<const P*>(p);
}
template <class P>
inline P* packs(double* p) {
  return reinterpret_cast<P*>(p);
}

template <class Law>
constexpr VolumeRule volume_rule() {
  if constexpr (requires { Law::kVolume; })
    return Law::kVolume;
  else
    return VolumeRule::kLogarithm;
}

/// Adds ½ K ln² J, or ½ K ((J² − 1)/2 − ln J), as a function of c = J². @eq{solid-discrete-volume}
template <class P, VolumeRule kRule>
inline void add_volume(double K, const StrainPair<P>& e, Coefficients<P>& a) {
  const LogDifference<P> l(e.at_n.s, e.at_n1.s);
  if constexpr (kRule == VolumeRule::kSquare) {
    a.p -= 0.25 * K * l.minus_one;
    a.q -= 0.25 * K * l.minus_one;
    a.dq.c -= 0.25 * K * l.derivative;
    return;
  }
  const P f = 0.125 * K * (l.log_0 + l.log_1);
  a.p += f * l.value;
  a.q += f * l.value;
  a.dq.c += 0.125 * K * l.value / (1.0 + e.at_n1.s) + f * l.derivative;
}

template <class P, class Law>
void law_stress(const void* law, bool whole, const double* E_0, const double* E_1, double* S,
                double* D) {
  const Law& m = *static_cast<const Law*>(law);
  const StrainPair<P> e(packs<P>(E_0), packs<P>(E_1));
  const auto write = [&](Coefficients<P> a) {
    if constexpr (Law::kUncoupled) {
      if (whole) add_volume<P, volume_rule<Law>()>(m.bulk, e, a);
    }
    write_stress(e, a, packs<P>(S), D ? packs<P>(D) : nullptr);
  };
  if constexpr (requires { Law::kPrincipal; }) {
    const PrincipalPair<P> pair(e);
    write(m.stress(e, pair));
    m.add_principal(e, pair, packs<P>(S), D ? packs<P>(D) : nullptr);
  } else {
    write(m.stress(e));
  }
}

template <class P, class Law>
void law_energy(const void* law, bool whole, const double* E, double* W) {
  const Law& m = *static_cast<const Law*>(law);
  const Strain<P> e(packs<P>(E));
  P w = m.energy(e);
  if constexpr (Law::kUncoupled) {
    if (whole && volume_rule<Law>() == VolumeRule::kSquare) {
      w += 0.25 * m.bulk * log1p_lack(e.s);
    } else if (whole) {
      const P L = log1p(e.s);
      w += 0.125 * m.bulk * L * L;
    }
  }
  *packs<P>(W) = w;
}

/// κ I + (1 − 3κ) A ⊗ A as six numbers, and its product with a symmetric tensor.
/// @eq{solid-fibre-dispersion}
template <class P>
struct FibreDyad {
  P a[6];
  FibreDyad(const P* A, double kappa)
      : a{A[0] * A[0], A[1] * A[1], A[2] * A[2], A[0] * A[1], A[1] * A[2], A[2] * A[0]} {
    for (int i = 0; i < 6; ++i) a[i] = (1.0 - 3.0 * kappa) * a[i] + (i < 3 ? kappa : 0.0);
  }
  P dot(const P* E) const {
    return a[0] * E[0] + a[1] * E[1] + a[2] * E[2] +
           2.0 * (a[3] * E[3] + a[4] * E[4] + a[5] * E[5]);
  }
};

/// @eq{solid-fibre-stress}
template <class P, class Law>
void fibre_add_stress(const void* law, bool uncoupled, double dispersion, const double* A,
                      const double* E_0, const double* E_1, double* S_out, double* D_out) {
  const Law& m = *static_cast<const Law*>(law);
  const StrainPair<P> e(packs<P>(E_0), packs<P>(E_1));
  const FibreDyad<P> dyad(packs<P>(A), dispersion);
  P* S = packs<P>(S_out);
  P* D = D_out ? packs<P>(D_out) : nullptr;
  const LogDifference<P> l(e.at_n.s, e.at_n1.s);
  const P c_1 = 1.0 + e.at_n1.s;
  const PowerDifference<P> power(1.0 / 3.0, l, c_1);
  // I₄ and the factor a that removes volume changes from it.
  const P one = P{} + 1.0;
  const P i_0 = 2.0 * dyad.dot(e.at_n.E), i_1 = 2.0 * dyad.dot(e.at_n1.E);
  const P I_0 = 1.0 + i_0, I_1 = 1.0 + i_1;
  const P a_0 = uncoupled ? 1.0 + power.minus_one_0 : one;
  const P a_1 = uncoupled ? 1.0 + power.minus_one_1 : one;
  const P y_0 = uncoupled ? power.minus_one_0 * I_0 + i_0 : i_0;
  const P y_1 = uncoupled ? power.minus_one_1 * I_1 + i_1 : i_1;
  // Tension only, exact across the transition: there is no contribution below y = 0.
  const P zero = P{};
  const P u_0 = y_0 > 0.0 ? y_0 : zero, u_1 = y_1 > 0.0 ? y_1 : zero;
  if (!any(u_0 + u_1 != 0.0)) return;
  const FibreDifference<P> d = m.difference(u_0, u_1);
  const P step = y_1 - y_0, on = y_1 > 0.0 ? one : zero;
  const auto still = step == 0.0;
  const P safe = still ? one : step;
  const P ratio = still ? on : (u_1 - u_0) / safe;
  const P f = d.value * ratio;
  const P df = d.derivative * on * ratio + (still ? zero : d.value * (on - ratio) / safe);
  const P a = 0.5 * (a_0 + a_1), I = 0.5 * (I_0 + I_1);
  for (int i = 0; i < 6; ++i) {
    S[i] += 2.0 * f * a * dyad.a[i];
    if (uncoupled) S[i] += 2.0 * f * I * power.value * ((i < 3 ? 1.0 : 0.0) + e.k[i]);
  }
  if (!D) return;
  if (!uncoupled) {
    const P h = 4.0 * df;
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j) D[6 * i + j] += h * dyad.a[i] * dyad.a[j];
    return;
  }
  P K_a[6], dA[6], dK[6];
  for (int i = 0; i < 6; ++i) {
    const P dy = a_1 * dyad.a[i] + I_1 * power.slope_1 * e.cof_1[i];
    K_a[i] = (i < 3 ? 1.0 : 0.0) + e.k[i];
    dA[i] = 4.0 * (df * a * dy + 0.5 * f * power.slope_1 * e.cof_1[i]);
    dK[i] = 4.0 * (df * I * power.value * dy + 0.5 * f * power.value * dyad.a[i] +
                   f * I * power.derivative * e.cof_1[i]);
  }
  add_dyad(dyad.a, dA, D);
  add_dyad(K_a, dK, D);
  add_cross(P(4.0 * f * I * power.value), e.A, D);
}

template <class P, class Law>
void fibre_add_energy(const void* law, bool uncoupled, double dispersion, const double* A,
                      const double* E, double* W) {
  const Law& m = *static_cast<const Law*>(law);
  const Strain<P> e(packs<P>(E));
  const FibreDyad<P> dyad(packs<P>(A), dispersion);
  P y = 2.0 * dyad.dot(e.E);
  if (uncoupled) y += expm1(P(-1.0 / 3.0 * log1p(e.s))) * (1.0 + y);
  *packs<P>(W) += m.energy(P(y > 0.0 ? y : P{}));
}

template <class P, VolumeRule kRule>
void volume_pressure(double K, const double* tau_0, const double* tau_1, double* p, double* dp) {
  const LogDifference<P> l(*packs<P>(tau_0), *packs<P>(tau_1));
  if constexpr (kRule == VolumeRule::kSquare) {
    *packs<P>(p) = 0.5 * K * (0.5 * (*packs<P>(tau_0) + *packs<P>(tau_1)) - l.minus_one);
    *packs<P>(dp) = 0.5 * K * (0.5 - l.derivative);
    return;
  }
  const P f = 0.5 * K * (l.log_0 + l.log_1);
  *packs<P>(p) = f * l.value;
  *packs<P>(dp) = 0.5 * K * l.value / (1.0 + *packs<P>(tau_1)) + f * l.derivative;
}

template <class P, VolumeRule kRule>
void volume_energy(double K, const double* tau, double* U) {
  if constexpr (kRule == VolumeRule::kSquare) {
    const P t = *packs<P>(tau);
    *packs<P>(U) = 0.5 * K * (0.5 * t * t + log1p_lack(t));
    return;
  }
  const P L = log1p(*packs<P>(tau));
  *packs<P>(U) = 0.5 * K * L * L;
}

template <class P>
struct VolumeTable {
  VolumeKernel entry[2] = {
      {volume_pressure<P, VolumeRule::kLogarithm>, volume_energy<P, VolumeRule::kLogarithm>},
      {volume_pressure<P, VolumeRule::kSquare>, volume_energy<P, VolumeRule::kSquare>}};
};

template <class P, class... Law>
constexpr auto law_table(LawList<Law...>) {
  struct Table {
    LawKernel entry[sizeof...(Law)];
  };
  return Table{{LawKernel{law_stress<P, Law>, law_energy<P, Law>}...}};
}
template <class P, class... Law>
constexpr auto fibre_table(LawList<Law...>) {
  struct Table {
    FibreKernel entry[sizeof...(Law)];
  };
  return Table{{FibreKernel{fibre_add_stress<P, Law>, fibre_add_energy<P, Law>}...}};
}

}  // namespace polhode::solids
