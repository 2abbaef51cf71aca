// SPDX-License-Identifier: Apache-2.0
// Stress that relaxes, at one point of kWidth elements. Included by the files kernels_*.cpp only.
#pragma once

#include <polhode/solids/elements/point_kernel.hpp>

namespace polhode::solids {

/// Places of the history of a point, by lane.
template <class P>
struct PointMemory {
  static constexpr int W = kWidth<P>;
  std::ptrdiff_t place[W];

  /// @param first  Number of the first element of the block.
  PointMemory(const ElementData& data, int first, int present, int points, int q) {
    for (int l = 0; l < W; ++l) {
      const std::ptrdiff_t e = first + (l < present ? l : present - 1);
      place[l] = data.first_memory + (e * points + q) * data.memory_size;
    }
  }
  [[nodiscard]] P get(const double* history, int k) const {
    P x;
    for (int l = 0; l < W; ++l) x[l] = history[place[l] + k];
    return x;
  }
  void put(double* history, int k, const P& x) const {
    for (int l = 0; l < W; ++l) history[place[l] + k] = x[l];
  }
};

template <class P>
inline P contraction(const P* S, const P* E) {
  return S[0] * E[0] + S[1] * E[1] + S[2] * E[2] + 2.0 * (S[3] * E[3] + S[4] * E[4] + S[5] * E[5]);
}

/// Energy density of a point, without the volumetric energy if that is averaged.
template <class P>
inline P energy_density(const ElementData& data, const double* fibres, bool whole, const P* E) {
  P W{};
  data.law_kernel.energy(data.law, whole, numbers(E), numbers(&W));
  for (int f = 0; f < data.family_count; ++f) {
    const FibreFamily& family = data.families[f];
    family.kernel.add_energy(family.law, data.uncoupled, family.dispersion,
                             fibres + 3 * kWidth<P> * f, numbers(E), numbers(&W));
  }
  return W;
}

/// Adds to the elastic stress what remembers, and to its derivative by E_1; D may be null.
/// @eq{solid-relaxation-step}
template <class P>
inline void add_memory(const ElementData& data, const ElementStep& step, const double* fibres,
                       const PointMemory<P>& at, const P* E_0, const P* E_1, P* S, P* D) {
  const MemoryWeights& w = step.memory;
  const bool whole = !data.uncoupled;
  P T[6], d[36];
  const auto add = [&](double weight) {
    for (int i = 0; i < 6; ++i) S[i] += weight * T[i];
  };
  const auto add_derivative = [&](double weight) {
    for (int i = 0; D && i < 36; ++i) D[i] += weight * d[i];
  };
  if (w.mean != 0.0) {
    stress_between<P>(data, fibres, whole, E_0, E_1, T, D ? d : nullptr);
    add(w.mean);
    add_derivative(w.mean);
  }
  if (w.end != 0.0) {
    stress_between<P>(data, fibres, whole, E_1, E_1, T, D ? d : nullptr);
    add(w.end);
    add_derivative(2.0 * w.end);
  }
  if (w.start != 0.0) {
    if (step.rate != 0.0)
      stress_between<P>(data, fibres, whole, E_0, E_0, T, static_cast<P*>(nullptr));
    else
      for (int i = 0; i < 6; ++i) T[i] = at.get(step.history, i);
    add(w.start);
  }
  for (int k = 0; k < w.terms; ++k) {
    if (w.term[k].relaxed == 0.0) continue;
    for (int i = 0; i < 6; ++i)
      S[i] += w.term[k].relaxed * at.get(step.history, kMemorySize * (k + 1) + i);
  }
}

/// Elastic stress and energies of a point at a time.
template <class P>
struct ElasticPoint {
  P S[6], energy, complementary;

  ElasticPoint(const ElementData& data, const double* fibres, const P* E) {
    stress_between<P>(data, fibres, !data.uncoupled, E, E, S, static_cast<P*>(nullptr));
    energy = energy_density<P>(data, fibres, !data.uncoupled, E);
    complementary = contraction(S, E) - energy;
  }
};

/// Energy of the terms at an instant, and of the change of the long-term part.
/// @eq{solid-relaxation-energy}
template <class P>
inline P memory_energy(const ElementData& data, const ElementStep& step, const double* fibres,
                       const PointMemory<P>& at, const P* E) {
  const MemoryWeights& w = step.memory;
  const P elastic = energy_density<P>(data, fibres, !data.uncoupled, E);
  P sum = (w.long_term - 1.0) * elastic;
  for (int k = 0; k < w.terms; ++k) {
    P Q[6];
    for (int i = 0; i < 6; ++i) Q[i] = at.get(step.history, kMemorySize * (k + 1) + i);
    sum += w.term[k].ratio *
           (elastic - contraction(Q, E) + at.get(step.history, kMemorySize * (k + 1) + 6));
  }
  return sum;
}

/// Energy at the end of a step as memory_energy() has it, and the energy that it dissipates.
/// @eq{solid-relaxation-loss}
template <class P>
inline P memory_energy_after(const ElementData& data, const ElementStep& step, const double* fibres,
                             const PointMemory<P>& at, const P* E_0, const P* E_1, P& dissipated) {
  const MemoryWeights& w = step.memory;
  const ElasticPoint<P> from(data, fibres, E_0), to(data, fibres, E_1);
  const P apart = to.energy - contraction(from.S, E_1) + from.complementary;
  P sum = (w.long_term - 1.0) * to.energy;
  for (int k = 0; k < w.terms; ++k) {
    const MemoryWeights::Term& t = w.term[k];
    P Q[6];
    for (int i = 0; i < 6; ++i) Q[i] = at.get(step.history, kMemorySize * (k + 1) + i);
    const P kept = at.get(step.history, kMemorySize * (k + 1) + 6);
    const P before = from.energy - contraction(Q, E_0) + kept;
    const P moved = to.energy - contraction(Q, E_1) + kept;
    sum += t.ratio * (t.past * moved + t.from_start * apart);
    dissipated += t.ratio * (t.from_end * before + t.from_start * moved);
  }
  return sum;
}

/// Memory at the end of a step. @eq{solid-relaxation-step}
template <class P>
inline void remember_point(const ElementData& data, const ElementStep& step, const double* fibres,
                           const PointMemory<P>& at, const P* E_0, const P* E_1, double* history) {
  const ElasticPoint<P> to(data, fibres, E_1);
  P from[kMemorySize], next[kMemorySize];
  for (int i = 0; i < 6; ++i) next[i] = to.S[i];
  next[6] = to.complementary;
  if (step.rate != 0.0) {
    const ElasticPoint<P> start(data, fibres, E_0);
    for (int i = 0; i < 6; ++i) from[i] = start.S[i];
    from[6] = start.complementary;
  } else {
    for (int i = 0; i < kMemorySize; ++i) from[i] = at.get(history, i);
  }
  for (int k = 0; k < step.memory.terms; ++k) {
    const MemoryWeights::Term& t = step.memory.term[k];
    for (int i = 0; i < kMemorySize; ++i) {
      const int n = kMemorySize * (k + 1) + i;
      at.put(history, n,
             P(t.past * at.get(history, n) + t.from_start * from[i] + t.from_end * next[i]));
    }
  }
  for (int i = 0; i < kMemorySize; ++i) at.put(history, i, next[i]);
}

}  // namespace polhode::solids
