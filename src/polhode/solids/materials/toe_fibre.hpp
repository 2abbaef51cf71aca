// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/solids/materials/fibre_difference.hpp>
#include <polhode/solids/materials/material_kind.hpp>
#include <polhode/solids/simd/pack.hpp>

namespace polhode::solids {

/// Fibre with a toe: an exponential start, followed by an optional straight line.
///
///   λ dF/dλ = c₃ (exp(c₄ (λ − 1)) − 1)    for 1 < λ < λ_m
///   λ dF/dλ = c₅ λ + c₆                   beyond, c₆ such that the force does not jump
///
/// J. A. Weiss, B. N. Maker, S. Govindjee: Finite element implementation of incompressible,
/// transversely isotropic hyperelasticity, Computer Methods in Applied Mechanics and Engineering
/// 135 (1996) 107-128.
struct ToeFibre {
  static constexpr const char* kKind = "toe";
  double c3, c4, c5, stretch_m;

  static MaterialKind kind();
  static ToeFibre from(const ParameterValues& values);

  /// F(y) [Pa], y = I₄ − 1 ≥ 0.
  [[nodiscard]] double energy_of(double y) const;
  /// F[y_0, y_1] and its derivative by y_1, exact to rounding for any step.
  void difference_of(double y_0, double y_1, double* value, double* derivative) const;

  template <class P>
  [[nodiscard]] P energy(P y) const {
    P r;
    for (int i = 0; i < kWidth<P>; ++i) r[i] = energy_of(y[i]);
    return r;
  }
  template <class P>
  [[nodiscard]] FibreDifference<P> difference(P y_0, P y_1) const {
    FibreDifference<P> r{};
    for (int i = 0; i < kWidth<P>; ++i) {
      double value, derivative;
      difference_of(y_0[i], y_1[i], &value, &derivative);
      r.value[i] = value;
      r.derivative[i] = derivative;
    }
    return r;
  }
};

}  // namespace polhode::solids
