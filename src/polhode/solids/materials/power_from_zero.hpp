// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/solids/simd/math.hpp>

namespace polhode::solids {

/// yᵖ of y ≥ 0, with p > 0, to a relative error of p |ln y| units of the last place.
template <class P>
inline P power_from_zero(P y, double p) {
  if (p == 1.0) return y;
  if (p == 2.0) return y * y;
  const auto none = y == 0.0;
  const P x = p * log_far(P(none ? P{} + 1.0 : y));
  const P power = 1.0 + expm1(P(x < 0.0 ? -x : x));
  return none ? P{} : (x < 0.0 ? 1.0 / power : power);
}

/// The power h = yᵝ of y ≥ 0 at both ends of a step, β ≥ 2, and its divided difference, without
/// cancellation and also where one end or both are zero.
template <class P>
struct PowerFromZero {
  P at_0, at_1;
  P value;       ///< h[y_0, y_1].
  P derivative;  ///< ∂h[y_0, y_1]/∂y_1.
  P slope_1;     ///< h'(y_1).

  PowerFromZero(double beta, P y_0, P y_1)
      : at_0(power_from_zero(y_0, beta)), at_1(power_from_zero(y_1, beta)) {
    if (beta == 2.0) {
      value = y_0 + y_1;
      derivative = P{} + 1.0;
      slope_1 = 2.0 * y_1;
      return;
    }
    slope_1 = beta * power_from_zero(y_1, beta - 1.0);
    // With the larger end M and 1 − d the ratio of both: Mᵝ⁻¹ (1 − (1 − d)ᵝ)/d.
    const P one = P{} + 1.0, gap = y_1 - y_0, size = gap < 0.0 ? -gap : gap;
    const P larger = y_0 > y_1 ? y_0 : y_1;
    const auto zero = larger == 0.0;
    const P M = zero ? one : larger;
    const P d = size / M;
    const auto still = d == 0.0, whole = d == 1.0;
    const P e = (still | whole) ? P{} + 0.5 : d;
    const P Q = -expm1(P(beta * log1p(P(-e)))) / e;
    const P level = power_from_zero(larger, beta - 1.0);
    value = level * (whole ? one : (still ? P{} + beta : Q));
    // (h'(y_1) − h[y_0, y_1])/(y_1 − y_0), or a series about the mean of y_0, y_1, y_1.
    const P mean = zero ? one : (1.0 / 3.0) * (y_0 + 2.0 * y_1);
    const auto close = CloseTriple<P>::is_close(P(size / mean), beta);
    derivative = (slope_1 - value) / (close ? one : gap);
    if (!any(close)) return;
    const P a = (y_0 - mean) / mean, b = (y_1 - mean) / mean;
    const P near = CloseTriple<P>(a, b, b).power(beta) * power_from_zero(mean, beta - 2.0);
    derivative = zero ? P{} : (close ? near : derivative);
  }
};

}  // namespace polhode::solids
