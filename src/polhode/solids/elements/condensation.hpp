// SPDX-License-Identifier: Apache-2.0
// Elimination of enhanced modes α inside an element, kWidth elements at a time.
// Included by the files kernels_*.cpp only.
#pragma once

#include <polhode/solids/elements/kernels.hpp>
#include <polhode/solids/simd/pack.hpp>

namespace polhode::solids {

/// Inverse by Gauss-Jordan elimination in place, without pivoting: the matrices are nearly
/// symmetric, and positive definite as long as the element is stable.
template <class P, int n>
inline void invert(P (*A)[n]) {
  for (int k = 0; k < n; ++k) {
    const P pivot = 1.0 / A[k][k];
    A[k][k] = broadcast<P>(1.0);
    for (int j = 0; j < n; ++j) A[k][j] *= pivot;
    for (int i = 0; i < n; ++i) {
      if (i == k) continue;
      const P factor = A[i][k];
      A[i][k] = P{};
      for (int j = 0; j < n; ++j) A[i][j] -= factor * A[k][j];
    }
  }
}

/// y = Q x, or Qᵀ x, for vectors one after the other; Q row by row.
template <class P, int n>
inline void turned(const double* Q, bool back, const P* x, P* y) {
  for (int v = 0; v < n; v += 3)
    for (int i = 0; i < 3; ++i) {
      const double q0 = back ? Q[i] : Q[3 * i], q1 = back ? Q[3 + i] : Q[3 * i + 1],
                   q2 = back ? Q[6 + i] : Q[3 * i + 2];
      y[v + i] = q0 * x[v] + q1 * x[v + 1] + q2 * x[v + 2];
    }
}

/// Stored condensation, in the scratch of a block. @eq{solid-condensation}
template <class P, int kKind>
struct Condensation {
  static constexpr ElementSizes kSizes = kElementSizes[kKind];
  static constexpr int N = 3 * kSizes.nodes, M = kSizes.modes(), W = kWidth<P>;

  double* scratch;

  [[nodiscard]] P get(int at) const { return load<P>(scratch + at * W); }
  void put(int at, const P& x) const { store(scratch + at * W, x); }

  /// Condenses K (column by column: K[column][row], nodes first) and f in place, and stores the
  /// factors.
  void make(P (*K)[N + M], P* f) const {
    P inverse[M][M], move[M], left[N][M];
    for (int i = 0; i < M; ++i)
      for (int j = 0; j < M; ++j) inverse[i][j] = K[N + j][N + i];
    invert<P, M>(inverse);
    for (int i = 0; i < M; ++i) {
      move[i] = P{};
      for (int j = 0; j < M; ++j) {
        move[i] += inverse[i][j] * f[N + j];
        put(kSizes.at_inverse() + i * M + j, inverse[i][j]);
      }
      put(kSizes.at_move() + i, move[i]);
    }
    for (int a = 0; a < N; ++a)
      for (int j = 0; j < M; ++j) {
        P s{};
        for (int i = 0; i < M; ++i) s += K[N + i][a] * inverse[i][j];
        left[a][j] = s;
        put(kSizes.at_left() + a * M + j, s);
      }
    for (int a = 0; a < N; ++a)
      for (int j = 0; j < M; ++j) f[a] -= left[a][j] * f[N + j];
    for (int b = 0; b < N; ++b) {
      for (int i = 0; i < M; ++i) {
        P s{};
        for (int j = 0; j < M; ++j) s += inverse[i][j] * K[b][N + j];
        put(kSizes.at_right() + i * N + b, s);
      }
      for (int a = 0; a < N; ++a) {
        P s = K[b][a];
        for (int j = 0; j < M; ++j) s -= left[a][j] * K[b][N + j];
        K[b][a] = s;
      }
    }
  }

  /// Condenses f alone, with the stored factors, rotated by Q since then.
  void reuse(const double* Q, P* f) const {
    P r[M], x[M], y[M], g[N], h[N];
    turned<P, M>(Q, true, f + N, r);
    for (int i = 0; i < M; ++i) {
      x[i] = P{};
      for (int j = 0; j < M; ++j) x[i] += get(kSizes.at_inverse() + i * M + j) * r[j];
    }
    turned<P, M>(Q, false, x, y);
    for (int i = 0; i < M; ++i) put(kSizes.at_move() + i, y[i]);
    for (int a = 0; a < N; ++a) {
      g[a] = P{};
      for (int j = 0; j < M; ++j) g[a] += get(kSizes.at_left() + a * M + j) * r[j];
    }
    turned<P, N>(Q, false, g, h);
    for (int a = 0; a < N; ++a) f[a] -= h[a];
  }

  /// Updates α ← α − K_αα⁻¹ r_α − K_αα⁻¹ K_αu du. @returns the largest component of the change.
  [[nodiscard]] P advance(const double* Q, const P* du) const {
    P d[N], x[M], y[M], largest{};
    turned<P, N>(Q, true, du, d);
    for (int i = 0; i < M; ++i) {
      x[i] = P{};
      for (int b = 0; b < N; ++b) x[i] += get(kSizes.at_right() + i * N + b) * d[b];
    }
    turned<P, M>(Q, false, x, y);
    for (int i = 0; i < M; ++i) {
      const P move = -get(kSizes.at_move() + i) - y[i];
      put(i, get(i) + move);
      put(kSizes.at_move() + i, P{});
      const P size = move < 0.0 ? -move : move;
      largest = size <= largest ? largest : size;
    }
    return largest;
  }
};

}  // namespace polhode::solids
