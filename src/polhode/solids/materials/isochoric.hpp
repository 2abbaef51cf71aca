// SPDX-License-Identifier: Apache-2.0
// Invariants of the isochoric part of a deformation, and their exact discrete derivatives.
#pragma once

#include <polhode/solids/materials/strain_pair.hpp>

namespace polhode::solids {

/// Ī₁ − 3 and Ī₂ − 3 of one strain, of second order in it, without cancellation.
template <class P>
struct IsochoricInvariants {
  P first, second;

  explicit IsochoricInvariants(const Strain<P>& e) {
    const P L = log1p(e.s), y = e.t_less_log();
    const Exponential<P> a(-1.0 / 3.0 * L), b(-2.0 / 3.0 * L);
    // 2 t = 2 y + L = 2 y − 3 (−L/3), and 4 (t + II) = 4 (y + II) − 3 (−2L/3).
    first = 2.0 * y + 3.0 * a.excess + 2.0 * e.t * a.minus_one;
    second = 4.0 * (y + e.II) + 3.0 * b.excess + 4.0 * (e.t + e.II) * b.minus_one;
  }
};

/// Discrete derivatives of Ī₁ = a I₁ and Ī₂ = b I₂ over a step, with a = c^(−1/3) and b = a².
template <class P>
struct IsochoricSlopes {
  PowerDifference<P> a, b;
  P i1, i2;  ///< Means over the step of I₁ − 3, I₂ − 3 ...
  P am, bm;  ///< ... and of a − 1, b − 1.

  explicit IsochoricSlopes(const StrainPair<P>& e)
      : IsochoricSlopes(e, LogDifference<P>(e.at_n.s, e.at_n1.s)) {}

  /// Adds f times the derivative of Ī₁.
  void add_first(const P& f, Coefficients<P>& r) const {
    r.q += f * (3.0 + i1) * a.value;
    r.p += f * first_p();
    r.dw1.c += 0.5 * f * a.slope_1;
    r.dq.c += f * (3.0 + i1) * a.derivative;
    r.dq.i1 += 0.5 * f * a.value;
  }
  /// Adds f times the derivative of Ī₂.
  void add_second(const P& f, Coefficients<P>& r) const {
    r.w2 += f * (1.0 + bm);
    r.q += f * (3.0 + i2) * b.value;
    r.p += f * (2.0 * bm - 2.0 / 3.0 * i2 + (3.0 + i2) * b.plus_p);
    r.dw2.c += 0.5 * f * b.slope_1;
    r.dq.c += f * (3.0 + i2) * b.derivative;
    r.dq.i2 += 0.5 * f * b.value;
  }
  /// Adds the derivative of Ī₁ times a change of its factor with Ī₁ at the end of the step.
  /// @param slope  Derivative of the factor by Ī₁.
  void add_first_slope(const P& slope, const Strain<P>& at_n1, Coefficients<P>& r) const {
    const P by_c = slope * (3.0 + 2.0 * at_n1.t) * a.slope_1;
    const P by_i1 = slope * (1.0 + a.minus_one_1);
    const P w = 1.0 + am, q = (3.0 + i1) * a.value;
    r.dw1.c += w * by_c;
    r.dw1.i1 += w * by_i1;
    r.dq.c += q * by_c;
    r.dq.i1 += q * by_i1;
  }

 private:
  IsochoricSlopes(const StrainPair<P>& e, const LogDifference<P>& l)
      : a(1.0 / 3.0, l, P(1.0 + e.at_n1.s)),
        b(2.0 / 3.0, l, P(1.0 + e.at_n1.s)),
        i1(2.0 * e.t),
        i2(2.0 * (e.at_n.t + e.at_n1.t + e.at_n.II + e.at_n1.II)),
        am(0.5 * (a.minus_one_0 + a.minus_one_1)),
        bm(0.5 * (b.minus_one_0 + b.minus_one_1)) {}

  [[nodiscard]] P first_p() const { return am - 1.0 / 3.0 * i1 + (3.0 + i1) * a.plus_p; }
};

}  // namespace polhode::solids
