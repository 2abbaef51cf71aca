// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>

#include <polhode/math/dual.hpp>

namespace polhode::contact {

/// Bristle of t_n in the tangent plane of the step: rotated with the normal by the smallest
/// rotation, and about it with the bodies. Zero if `before`, the normal that left it, is.
template <class T>
[[nodiscard]] V3<T> transported(const Vec3& bristle, const Vec3& before, const V3<T>& n,
                                const T& spin) {
  if (before.isZero(0.0)) return constant<T>(Vec3::Zero());
  const V3<double> s = v3(bristle), from = v3(before);
  const T cosine = dot(from, n);
  V3<T> turned = constant<T>(bristle);
  if (value(cosine) > -0.5) {
    const V3<T> axis = cross(from, n), once = cross(axis, s);
    turned = s + once + (1.0 / (1.0 + cosine)) * cross(axis, once);
  }
  turned = turned - dot(n, turned) * n;
  const T square = 0.25 * spin * spin, scale = 1.0 / (1.0 + square);
  return scale * ((1.0 - square) * turned + spin * cross(n, turned));
}

/// Set of bristle deflections that stick: |s| ≤ R, or in the tangent plane an ellipse with the half
/// axes R along e and R·ratio along f.
template <class T>
struct Cone {
  T radius{};
  double ratio = 1.0;
  V3<T> e, f;  ///< Used if ratio ≠ 1: unit, normal to each other and to the contact normal.

  /// Nearest deflection that sticks, in the metric of the bristle's energy: the dissipation of a
  /// step is then never negative. @eq{contact-bristle}
  [[nodiscard]] V3<T> nearest(const V3<T>& s) const {
    if (ratio != 1.0) return nearest_in_ellipse(s);
    const double r = value(radius), square = value(dot(s, s));
    if (square <= r * r) return s;
    return (radius / norm(s)) * s;
  }
  [[nodiscard]] bool outside(const Vec3& s) const {
    const double r = value(radius);
    if (ratio == 1.0) return s.squaredNorm() > r * r;
    const double x = value(e).dot(s), y = value(f).dot(s) / ratio;
    return x * x + y * y > r * r;
  }

 private:
  /// Root of (a x/(a² + t))² + (b y/(b² + t))² = 1, t > 0; a step in T gives its derivatives.
  [[nodiscard]] V3<T> nearest_in_ellipse(const V3<T>& s) const {
    const T x = dot(e, s), y = dot(f, s);
    if (!outside(value(s))) return s;
    const T a = radius, b = ratio * radius;
    const double A = value(a), B = value(b), X = value(x), Y = value(y);
    if (A <= 0.0) return 0.0 * s;
    double t = 0.0, slope = -1.0;
    for (int k = 0; k < 60; ++k) {  // convex and decreasing: from t = 0 monotone
      const double p = A * X / (A * A + t), q = B * Y / (B * B + t);
      const double rest = p * p + q * q - 1.0;
      slope = -2.0 * (p * p / (A * A + t) + q * q / (B * B + t));
      const double step = -rest / slope;
      t += step;
      if (std::abs(step) <= 1e-15 * (A * A + t)) break;
    }
    const T d_a = a * a + t, d_b = b * b + t;
    const T p = a * x / d_a, q = b * y / d_b;
    const T root = t - (1.0 / slope) * (p * p + q * q - 1.0);
    return (a * a * x / (a * a + root)) * e + (b * b * y / (b * b + root)) * f;
  }
};

}  // namespace polhode::contact
