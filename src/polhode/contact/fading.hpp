// SPDX-License-Identifier: Apache-2.0
// Weights of potentials that fade, see Fade, as functions of the cosine y of the angle between two
// directions. @eq{contact-fading} @eq{contact-rim-fading}
#pragma once

#include <cmath>

#include <polhode/contact/gap.hpp>

namespace polhode::contact {

/// Argument x of the weight: sin²/fade_square, or for a cone's flank the square of the distance
/// from being parallel.
template <class T>
struct FadingArgument {
  T x, z;

  FadingArgument(const FeaturePair& pair, const T& y)
      : z(((y - pair.aligned) * (y - pair.opposed)) * (1.0 / pair.fade_square)) {
    x = pair.fade == Fade::flank ? z * z
                                 : (1.0 - pair.fade_from - y * y) * (1.0 / pair.fade_square);
  }
};

/// m of a Fade: x(2 − x), or x²(3 − 2x) if it begins at an angle; 1 beyond x = 1.
template <class T>
[[nodiscard]] T fading(const FeaturePair& pair, const T& y) {
  const T x = FadingArgument<T>(pair, y).x;
  const bool near = value(x) < 1.0;
  T m = near ? x * (2.0 - x) : T(1.0);
  if (near && pair.fade_from > 0.0) m = value(x) > 0.0 ? x * x * (3.0 - 2.0 * x) : T(0.0);
  if (pair.fade == Fade::parallel || pair.fade == Fade::flank) return m;
  return near && (pair.fade == Fade::aligned || value(y) < 0.0) ? 1.0 - m : T(0.0);
}

/// (m(y_1) − m(y_0))/(y_1 − y_0), evaluated without the difference where both fade.
template <class T>
[[nodiscard]] T fading_quotient(const FeaturePair& pair, double y_0, const T& y_1) {
  const double square = pair.fade_square;
  const FadingArgument<double> at_0(pair, y_0);
  const FadingArgument<T> at_1(pair, y_1);
  const double x_0 = at_0.x;
  const T x_1 = at_1.x;
  const bool in_0 = x_0 < 1.0, in_1 = value(x_1) < 1.0;
  if (!in_0 && !in_1) return T(0.0);
  if (pair.fade == Fade::flat && (in_0 ? y_0 : value(y_1)) > 0.0) return T(0.0);
  if (in_0 && in_1 && pair.fade == Fade::flank)
    return (1.0 / square) *
           (((y_0 + y_1 - (pair.aligned + pair.opposed)) * (at_0.z + at_1.z)) * (2.0 - x_0 - x_1));
  // Derivative of x by y², with the sign of m in the weight.
  const double slope = (pair.fade == Fade::parallel ? -1.0 : 1.0) / square;
  if (pair.fade_from > 0.0) {
    if (x_0 <= 0.0 && value(x_1) <= 0.0) return T(0.0);
    if (in_0 && in_1 && x_0 > 0.0 && value(x_1) > 0.0)
      return slope *
             ((y_0 + y_1) * (3.0 * (x_0 + x_1) - 2.0 * (x_0 * x_0 + x_0 * x_1 + x_1 * x_1)));
  } else if (in_0 && in_1) {
    return slope * ((y_0 + y_1) * (2.0 - x_0 - x_1));
  }
  const T change = y_1 - y_0;
  if (std::abs(value(change)) < 1e-14) return T(0.0);
  return (fading(pair, y_1) - fading(pair, y_0)) / change;
}

}  // namespace polhode::contact
