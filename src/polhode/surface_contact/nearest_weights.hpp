// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <type_traits>

#include <polhode/math/dual.hpp>
#include <polhode/surface_contact/nearest_four.hpp>

namespace polhode::surface_contact {

/// Weights c of the nearest points in scalar type T: where they are free, the derivatives of |Σ c
/// x|² by their directions vanish.
template <class T>
void nearest_weights(const NearestFour& nearest, const contact::V3<T> (&x)[4], T (&c)[4]) {
  for (int k = 0; k < 4; ++k) c[k] = T(nearest.c[k]);
  if constexpr (std::is_same_v<T, double>) {
    return;
  } else {
    const auto sum = [&](const auto& a) {
      contact::V3<T> s = a[0] * (x[0] - x[3]);
      for (int k = 1; k < 3; ++k) s = s + a[k] * (x[k] - x[3]);
      return s;
    };
    const contact::V3<T> y = sum(c);
    contact::V3<T> way[2];
    for (int i = 0; i < nearest.free_count; ++i) way[i] = sum(nearest.free[i]);
    // One Newton step from the solution leaves the values and gives the derivatives.
    T step[2];
    if (nearest.free_count == 1) {
      step[0] = -dot(way[0], y) / dot(way[0], way[0]);
    } else if (nearest.free_count == 2) {
      const T a = dot(way[0], way[0]), b = dot(way[0], way[1]), d = dot(way[1], way[1]);
      const T p = dot(way[0], y), q = dot(way[1], y), scale = 1.0 / (a * d - b * b);
      step[0] = scale * (b * q - d * p);
      step[1] = scale * (b * p - a * q);
    }
    for (int i = 0; i < nearest.free_count; ++i)
      for (int k = 0; k < 4; ++k) c[k] = c[k] + nearest.free[i][k] * step[i];
  }
}

}  // namespace polhode::surface_contact
