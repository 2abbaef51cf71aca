// SPDX-License-Identifier: Apache-2.0
// Inverses of the small matrices of a joint's free directions.
#pragma once

#include <polhode/kernels/pack.hpp>

namespace polhode::POLHODE_ISA {

/// Inverse of a small matrix by Gauss-Jordan elimination with pivoting. False: a zero pivot.
template <int n>
POLHODE_INLINE bool invert(const double (*D)[8], double (*inverse)[8]) {
  double a[n][n], e[n][n];
  double largest = 0.0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      a[i][j] = D[i][j];
      e[i][j] = i == j ? 1.0 : 0.0;
      largest = __builtin_fabs(a[i][j]) > largest ? __builtin_fabs(a[i][j]) : largest;
    }
  for (int c = 0; c < n; ++c) {
    int p = c;
    for (int i = c + 1; i < n; ++i)
      if (__builtin_fabs(a[i][c]) > __builtin_fabs(a[p][c])) p = i;
    if (!(__builtin_fabs(a[p][c]) > 1e-14 * largest)) return false;
    if (p != c)
      for (int j = 0; j < n; ++j) {
        const double x = a[c][j], y = e[c][j];
        a[c][j] = a[p][j];
        e[c][j] = e[p][j];
        a[p][j] = x;
        e[p][j] = y;
      }
    const double pivot = 1.0 / a[c][c];
    for (int j = 0; j < n; ++j) {
      a[c][j] *= pivot;
      e[c][j] *= pivot;
    }
    for (int i = 0; i < n; ++i) {
      if (i == c) continue;
      const double factor = a[i][c];
      for (int j = 0; j < n; ++j) {
        a[i][j] -= factor * a[c][j];
        e[i][j] -= factor * e[c][j];
      }
    }
  }
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) inverse[i][j] = e[i][j];
  return true;
}

/// Inverse in closed form.
template <>
POLHODE_INLINE bool invert<2>(const double (*D)[8], double (*inverse)[8]) {
  const double det = D[0][0] * D[1][1] - D[0][1] * D[1][0];
  const double size = __builtin_fabs(D[0][0] * D[1][1]) + __builtin_fabs(D[0][1] * D[1][0]);
  if (!(__builtin_fabs(det) > 1e-14 * size)) return false;
  const double k = 1.0 / det;
  inverse[0][0] = k * D[1][1];
  inverse[0][1] = -k * D[0][1];
  inverse[1][0] = -k * D[1][0];
  inverse[1][1] = k * D[0][0];
  return true;
}

template <>
POLHODE_INLINE bool invert<3>(const double (*D)[8], double (*inverse)[8]) {
  const double c00 = D[1][1] * D[2][2] - D[1][2] * D[2][1];
  const double c01 = D[1][2] * D[2][0] - D[1][0] * D[2][2];
  const double c02 = D[1][0] * D[2][1] - D[1][1] * D[2][0];
  const double det = D[0][0] * c00 + D[0][1] * c01 + D[0][2] * c02;
  const double size = __builtin_fabs(D[0][0] * D[1][1] * D[2][2]) +
                      __builtin_fabs(D[0][1] * D[1][2] * D[2][0]) +
                      __builtin_fabs(D[0][2] * D[1][0] * D[2][1]);
  if (!(__builtin_fabs(det) > 1e-15 * size)) return false;
  const double k = 1.0 / det;
  inverse[0][0] = k * c00;
  inverse[1][0] = k * c01;
  inverse[2][0] = k * c02;
  inverse[0][1] = k * (D[0][2] * D[2][1] - D[0][1] * D[2][2]);
  inverse[1][1] = k * (D[0][0] * D[2][2] - D[0][2] * D[2][0]);
  inverse[2][1] = k * (D[0][1] * D[2][0] - D[0][0] * D[2][1]);
  inverse[0][2] = k * (D[0][1] * D[1][2] - D[0][2] * D[1][1]);
  inverse[1][2] = k * (D[0][2] * D[1][0] - D[0][0] * D[1][2]);
  inverse[2][2] = k * (D[0][0] * D[1][1] - D[0][1] * D[1][0]);
  return true;
}

}  // namespace polhode::POLHODE_ISA
