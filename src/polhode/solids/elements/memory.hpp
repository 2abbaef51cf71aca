// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/solids/materials/kernels.hpp>

namespace polhode::solids {

class Material;

/// Numbers of history at a point, first the elastic stress at t_n and its complementary energy
/// S:E − W, then the same of each term's memory: means over the past.
inline constexpr int kMemorySize = 7;

/// Weights of a step for a material whose stress relaxes. @eq{solid-relaxation-step}
struct MemoryWeights {
  int terms = 0;  ///< Zero: no memory, and no other number counts.
  double long_term = 1.0;
  /// Weights of S[E_0, E_1], S(E_0) and S(E_1) in what is added to the elastic stress [-].
  double mean = 0.0, start = 0.0, end = 0.0;
  struct Term {
    double ratio;
    double relaxed;  ///< Weight of the memory at t_n in the stress [-].
    /// Weights of the memory at t_n, of E_0 and of E_1 in that at t_{n+1}; their sum is one [-].
    double past, from_start, from_end;
  };
  Term term[kMostRelaxations];

  /// @param time  Length of the step [s]; 0: nothing relaxes, infinite: everything does.
  /// @param alpha_f  Weight of t_{n+1}; 1: the stress is that at t_{n+1}.
  MemoryWeights(const Material& material, double time, double alpha_f);
  MemoryWeights() = default;
};

}  // namespace polhode::solids
