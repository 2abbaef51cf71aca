// SPDX-License-Identifier: Apache-2.0
// Elementary functions of packs, and their divided differences without loss of digits for close
// arguments. Relative errors are a few units of the last place.
#pragma once

#include <polhode/solids/simd/pack.hpp>

namespace polhode::solids {

/// Σ_{k≥1} z²ᵏ/(2k+1) = atanh(z)/z − 1, for |z| ≤ 0.172.
template <class P>
inline P atanh_ratio_near(P z2) {
  P r = P{} + 1.0 / 23.0;
  r = r * z2 + 1.0 / 21.0;
  r = r * z2 + 1.0 / 19.0;
  r = r * z2 + 1.0 / 17.0;
  r = r * z2 + 1.0 / 15.0;
  r = r * z2 + 1.0 / 13.0;
  r = r * z2 + 1.0 / 11.0;
  r = r * z2 + 1.0 / 9.0;
  r = r * z2 + 1.0 / 7.0;
  r = r * z2 + 1.0 / 5.0;
  r = r * z2 + 1.0 / 3.0;
  return r * z2;
}

/// ln of numbers not necessarily near 1; NaN if not positive.
template <class P>
inline P log_far(P c) {
  using M = MaskOf<P>;
  const M bits = reinterpret_cast<M>(c);
  M exponent = (bits >> 52) - 1023;
  P mantissa = reinterpret_cast<P>((bits & 0x000fffffffffffffL) | 0x3ff0000000000000L);
  const M large = mantissa > 1.4142135623730951;
  mantissa = large ? 0.5 * mantissa : mantissa;
  exponent -= large;  // a mask is −1 where it holds
  const P z = (mantissa - 1.0) / (mantissa + 1.0);
  const P log_mantissa = 2.0 * (z + z * atanh_ratio_near(z * z));
  const P e = __builtin_convertvector(exponent, P);
  const P r = e * 0.6931471805599453 + log_mantissa;
  return c > 0.0 ? r : P{} + __builtin_nan("");
}

/// ln(1 + s).
template <class P>
inline P log1p(P s) {
  const auto near = (s > -0.29) & (s < 0.41);
  const P f = near ? s : P{};
  const P z = f / (2.0 + f);
  P r = 2.0 * (z + z * atanh_ratio_near(z * z));
  if (any(~near)) r = near ? r : log_far(1.0 + s);
  return r;
}

/// s − ln(1 + s), which is s²/2 for small s.
template <class P>
inline P log1p_lack(P s) {
  const auto near = (s > -0.29) & (s < 0.41);
  const P f = near ? s : P{};
  const P z = f / (2.0 + f);
  P r = f * z - 2.0 * z * atanh_ratio_near(z * z);
  if (any(~near)) r = near ? r : s - log_far(1.0 + s);
  return r;
}

/// eˣ − 1 with |x| up to 700, beyond which x is taken as 700; and eˣ − 1 − x.
template <class P>
struct Exponential {
  P minus_one, excess;

  explicit Exponential(P x) {
    using M = MaskOf<P>;
    x = x > 700.0 ? P{} + 700.0 : (x < -700.0 ? P{} - 700.0 : x);
    const P half = x < 0.0 ? P{} - 0.5 : P{} + 0.5;
    const M k = __builtin_convertvector(x * 1.4426950408889634 + half, M);  // to the nearest
    const P n = __builtin_convertvector(k, P);
    const P r = (x - n * 0.693147180369123816490) - n * 1.90821492927058770002e-10;
    P y = P{} + 1.0 / 87178291200.0;
    y = y * r + 1.0 / 6227020800.0;
    y = y * r + 1.0 / 479001600.0;
    y = y * r + 1.0 / 39916800.0;
    y = y * r + 1.0 / 3628800.0;
    y = y * r + 1.0 / 362880.0;
    y = y * r + 1.0 / 40320.0;
    y = y * r + 1.0 / 5040.0;
    y = y * r + 1.0 / 720.0;
    y = y * r + 1.0 / 120.0;
    y = y * r + 1.0 / 24.0;
    y = y * r + 1.0 / 6.0;
    y = y * r + 0.5;
    y = y * r * r;
    const P power = reinterpret_cast<P>((k + 1023) << 52);
    minus_one = power * (y + r) + (power - 1.0);
    excess = k == 0 ? y : minus_one - x;
  }
};

template <class P>
inline P expm1(P x) {
  return Exponential<P>(x).minus_one;
}

/// sinh(x)/x − 1 and its derivative.
template <class P>
struct SinhRatio {
  P minus_one, derivative;

  explicit SinhRatio(P x) {
    const auto near = (x > -1.0) & (x < 1.0);
    const P f = near ? x : P{};
    const P x2 = f * f;
    // x²ⁿ/(2n+1)!, and (cosh x − sinh(x)/x)/x.
    P r = P{} + 1.0 / 51090942171709440000.0;
    P d = 20.0 * r;
    const double terms[9] = {1.0 / 121645100408832000.0,
                             1.0 / 355687428096000.0,
                             1.0 / 1307674368000.0,
                             1.0 / 6227020800.0,
                             1.0 / 39916800.0,
                             1.0 / 362880.0,
                             1.0 / 5040.0,
                             1.0 / 120.0,
                             1.0 / 6.0};
    for (int i = 0; i < 9; ++i) {
      r = r * x2 + terms[i];
      d = d * x2 + (18.0 - 2.0 * i) * terms[i];
    }
    minus_one = r * x2;
    derivative = d * f;
    if (any(~near)) {
      const P g = near ? P{} + 1.0 : x;
      const P up = expm1(g), down = expm1(-g);
      const P ratio = 0.5 * (up - down) / g;
      const P cosh = 1.0 + 0.5 * (up + down);
      minus_one = near ? minus_one : ratio - 1.0;
      derivative = near ? derivative : (cosh - ratio) / g;
    }
  }
};

/// Divided difference of the logarithm: l = (ln c_1 − ln c_0)/(c_1 − c_0), of c = 1 + s.
///
/// @eq{solid-log-difference}
///
///   l = 2/(c_0 + c_1) · atanh(z)/z,   z = (c_1 − c_0)/(c_1 + c_0)
template <class P>
struct LogDifference {
  P value;         ///< l [-].
  P minus_one;     ///< l − 1, without cancellation.
  P derivative;    ///< ∂l/∂c_1.
  P log_0, log_1;  ///< ln c_0, ln c_1.
  P step;          ///< ln c_1 − ln c_0.

  LogDifference(P s_0, P s_1) : LogDifference(s_0, s_1, log1p(s_0), log1p(s_1)) {}
  /// With the logarithms at both ends.
  LogDifference(P s_0, P s_1, P given_0, P given_1) : log_0(given_0), log_1(given_1) {
    const P sum = 2.0 + s_0 + s_1, difference = s_1 - s_0;
    const P inverse = 1.0 / sum;
    const P z = difference * inverse;
    const auto near = (z > -0.17) & (z < 0.17);
    const P f = near ? z : P{};
    const P z2 = f * f;
    P A = atanh_ratio_near(z2);
    P B = P{} + 24.0 / 25.0;  // (dA/dz)/z
    for (int k = 11; k >= 1; --k) B = B * z2 + 2.0 * k / (2.0 * k + 1.0);
    if (any(~near)) {
      const P g = near ? P{} + 0.25 : z;
      const P ratio = 0.5 * (log1p(g) - log1p(-g)) / g;
      A = near ? A : ratio - 1.0;
      B = near ? B : (1.0 / (1.0 - g * g) - ratio) / (g * g);
    }
    value = 2.0 * inverse * (1.0 + A);
    minus_one = (2.0 * A - (s_0 + s_1)) * inverse;
    derivative = inverse * (4.0 * (1.0 + s_0) * inverse * inverse * z * B - value);
    step = value * difference;
  }
};

/// The power a = c⁻ᵖ at both ends, and its divided difference.
template <class P>
struct PowerDifference {
  P minus_one_0, minus_one_1;  ///< a_0 − 1, a_1 − 1.
  P value;                     ///< a[c_0, c_1].
  P plus_p;                    ///< a[c_0, c_1] + p, without cancellation: zero at c_0 = c_1 = 1.
  P derivative;                ///< ∂a[c_0, c_1]/∂c_1.
  P slope_1;                   ///< a'(c_1).

  PowerDifference(double p, const LogDifference<P>& l, P c_1) {
    minus_one_0 = expm1(-p * l.log_0);
    minus_one_1 = expm1(-p * l.log_1);
    // a_1 − a_0 = −2 e^{−p mean} sinh(p step/2), and step = l (c_1 − c_0).
    const P mean = expm1(-0.5 * p * (l.log_0 + l.log_1));
    const SinhRatio<P> h(0.5 * p * l.step);
    const P hl = h.minus_one * l.value + l.minus_one;  // sinh ratio · l − 1
    plus_p = -p * (mean * (1.0 + hl) + hl);
    value = plus_p - p;
    const P half = 0.5 * p / c_1;
    derivative = -p * (1.0 + mean) *
                 (half * l.value * (h.derivative - (1.0 + h.minus_one)) +
                  (1.0 + h.minus_one) * l.derivative);
    slope_1 = -p * (1.0 + minus_one_1) / c_1;
  }
};

/// Square root of every lane.
template <class P>
inline P square_root(P x) {
  P r;
  for (int i = 0; i < kWidth<P>; ++i) r[i] = __builtin_sqrt(x[i]);
  return r;
}

/// Three arguments x, y, z close to each other, for divided differences by Taylor's series about
/// their mean m: f[x, y, z] = Σ_k f⁽ᵏ⁾(m)/k! h_{k−2}, where h are the complete homogeneous
/// polynomials in the distances from m, and h_1 = 0.
template <class P>
struct CloseTriple {
  P h_2, h_3, h_4;  ///< Of distances relative to m.

  /// @param d  x/m − 1, y/m − 1, z/m − 1.
  CloseTriple(P d_0, P d_1, P d_2) {
    const P a = d_0 * d_0, b = d_1 * d_1, c = d_2 * d_2;
    const P p_2 = a + b + c;
    h_2 = 0.5 * p_2;
    h_3 = (1.0 / 3.0) * (a * d_0 + b * d_1 + c * d_2);
    h_4 = 0.25 * (a * a + b * b + c * c) + 0.125 * p_2 * p_2;
  }
  /// m^(2−q) times the difference of xᵠ.
  [[nodiscard]] P power(double q) const {
    const double second = 0.5 * q * (q - 1.0), fourth = second * (q - 2.0) * (q - 3.0) / 12.0;
    return second + fourth * (h_2 + 0.2 * (q - 4.0) * (h_3 + (1.0 / 6.0) * (q - 5.0) * h_4));
  }
  /// m² times the difference of ln x.
  [[nodiscard]] P log() const { return -0.5 - 0.25 * h_2 + 0.2 * h_3 - (1.0 / 6.0) * h_4; }
  /// Whether the series is more accurate than quotients, for powers of an exponent q.
  /// @param spread  (largest − smallest)/m.
  [[nodiscard]] static auto is_close(P spread, double q) {
    return spread * (2.0 + (q < 0.0 ? -q : q)) < 0.02;
  }
};

}  // namespace polhode::solids
