// SPDX-License-Identifier: Apache-2.0
// Energies that are sums over principal stretches, and their exact discrete derivatives.
// Derivation: docs/theory/solids.md.
#pragma once

#include <polhode/solids/materials/strain_pair.hpp>

namespace polhode::solids {

/// Principal values and axes of Green's strain, by Jacobi's rotations: errors of a few units of the
/// last place of the largest value, also where values are equal.
template <class P>
struct PrincipalStrain {
  P s[3];        ///< C_i − 1.
  P log[3];      ///< ln C_i.
  P axis[3][3];  ///< By value: unit vector.

  explicit PrincipalStrain(const Strain<P>& e) {
    P A[3][3] = {{e.E[0], e.E[3], e.E[5]}, {e.E[3], e.E[1], e.E[4]}, {e.E[5], e.E[4], e.E[2]}};
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) axis[i][j] = P{} + (i == j ? 1.0 : 0.0);
    constexpr int kSweeps = 8;  // five are enough for any matrix seen; convergence is quadratic
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
      const P off = A[0][1] * A[0][1] + A[1][2] * A[1][2] + A[0][2] * A[0][2];
      const P size = A[0][0] * A[0][0] + A[1][1] * A[1][1] + A[2][2] * A[2][2];
      if (!any(off > 1e-36 * size)) break;
      rotate(A, 0, 1, 2);
      rotate(A, 1, 2, 0);
      rotate(A, 0, 2, 1);
    }
    for (int i = 0; i < 3; ++i) {
      s[i] = 2.0 * A[i][i];
      log[i] = log1p(s[i]);
    }
  }

 private:
  /// Makes A_pq zero; r is the third index.
  void rotate(P (*A)[3], int p, int q, int r) {
    const P off = A[p][q], gap = A[q][q] - A[p][p];
    const P size = gap < 0.0 ? -gap : gap;
    const P down = size + square_root(P(gap * gap + 4.0 * off * off));
    const auto none = down == 0.0;
    const P ratio = none ? P{} : 2.0 * off / (none ? P{} + 1.0 : down);
    const P t = gap < 0.0 ? -ratio : ratio;
    const P c = 1.0 / square_root(P(1.0 + t * t)), n = t * c;
    A[p][p] -= t * off;
    A[q][q] += t * off;
    A[p][q] = A[q][p] = P{};
    const P a = A[r][p], b = A[r][q];
    A[r][p] = A[p][r] = c * a - n * b;
    A[r][q] = A[q][r] = n * a + c * b;
    for (int i = 0; i < 3; ++i) {
      const P u = axis[p][i], v = axis[q][i];
      axis[p][i] = c * u - n * v;
      axis[q][i] = n * u + c * v;
    }
  }
};

/// Symmetric part of u ⊗ v.
template <class P>
inline void symmetric_dyad(const P* u, const P* v, P* t) {
  for (int i = 0; i < 3; ++i) t[i] = u[i] * v[i];
  t[3] = 0.5 * (u[0] * v[1] + u[1] * v[0]);
  t[4] = 0.5 * (u[1] * v[2] + u[2] * v[1]);
  t[5] = 0.5 * (u[2] * v[0] + u[0] * v[2]);
}

/// Divided differences of a function of the principal values C_i between the ends of a step.
template <class P>
struct PrincipalSlopes {
  P across[3][3];    ///< f[C_i of E_0, C_j of E_1], less that at rest.
  P within[3][3];    ///< f[C_j, C_k] of E_1, less that at rest.
  P twice[3][3][3];  ///< f[C_i of E_0, C_j, C_k of E_1].
};

/// The two ends of a step by principal values a_i, b_j and axes u_i, v_j.
///
/// A sum over principal values, tr f(C), has the exact discrete derivative
/// @eq{solid-principal-derivative}
///
///   K = Σ_ij f[a_i, b_j] (u_i · v_j) sym(u_i ⊗ v_j)
///
/// without a division by differences of the values of one end.
template <class P>
struct PrincipalPair {
  PrincipalStrain<P> at_n, at_n1;
  P cosine[3][3];  ///< u_i · v_j.

  explicit PrincipalPair(const StrainPair<P>& e) : at_n(e.at_n), at_n1(e.at_n1) {
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        const P *u = at_n.axis[i], *v = at_n1.axis[j];
        cosine[i][j] = u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
      }
  }

  /// Computes the differences of Σ_k weight_k xᵠᵏ + log_weight ln x.
  /// @param second  Whether those of second order are needed.
  void set_slopes(int terms, const double* q, const P* weight, const P& log_weight, bool second,
                  PrincipalSlopes<P>& f) const {
    const auto first = [&](P s_0, P s_1, P log_0, P log_1) {
      const LogDifference<P> l(s_0, s_1, log_0, log_1);
      P sum = log_weight * l.minus_one;
      for (int k = 0; k < terms; ++k)
        sum += weight[k] * PowerDifference<P>(-q[k], l, P(1.0 + s_1)).plus_p;
      return sum;
    };
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        f.across[i][j] = first(at_n.s[i], at_n1.s[j], at_n.log[i], at_n1.log[j]);
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k <= j; ++k)
        f.within[j][k] = f.within[k][j] = first(at_n1.s[j], at_n1.s[k], at_n1.log[j], at_n1.log[k]);
    if (!second) return;
    double steepest = 0.0;
    for (int k = 0; k < terms; ++k) {
      const double size = q[k] < 0.0 ? -q[k] : q[k];
      steepest = size > steepest ? size : steepest;
    }
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        for (int k = 0; k <= j; ++k)
          f.twice[i][j][k] = f.twice[i][k][j] =
              second_difference(terms, q, weight, log_weight, steepest, f, i, j, k);
  }

  /// Adds K of the differences, times two.
  void add_stress(const PrincipalSlopes<P>& f, P* S) const {
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        P dyad[6];
        symmetric_dyad(at_n.axis[i], at_n1.axis[j], dyad);
        const P w = 2.0 * f.across[i][j] * cosine[i][j];
        for (int c = 0; c < 6; ++c) S[c] += w * dyad[c];
      }
  }

  /// Adds four times the derivative of K by C_1.
  ///
  ///   DK[H] = Σ_ik sym(u_i ⊗ v_k) Σ_j f[a_i, b_j, b_k] (u_i · v_j) v_j · H v_k
  void add_tangent(const PrincipalSlopes<P>& f, P* D) const {
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k) {
        P left[6], right[6], sum[3]{};
        for (int j = 0; j < 3; ++j) {
          const P w = 4.0 * f.twice[i][j][k] * cosine[i][j];
          for (int c = 0; c < 3; ++c) sum[c] += w * at_n1.axis[j][c];
        }
        symmetric_dyad(at_n.axis[i], at_n1.axis[k], left);
        symmetric_dyad(sum, at_n1.axis[k], right);
        add_dyad(left, right, D);
      }
  }

 private:
  P second_difference(int terms, const double* q, const P* weight, const P& log_weight,
                      double steepest, const PrincipalSlopes<P>& f, int i, int j, int k) const {
    const auto size = [](P x) { return x < 0.0 ? -x : x; };
    const P a = at_n.s[i], b = at_n1.s[j], c = at_n1.s[k];
    const P ab = a - b, ac = a - c, bc = b - c;
    const P g_ab = size(ab), g_ac = size(ac), g_bc = size(bc);
    // A quotient over the widest gap ...
    const auto by_bc = (g_bc >= g_ab) & (g_bc >= g_ac), by_ab = g_ab >= g_ac;
    const P up = by_bc
                     ? f.across[i][j] - f.across[i][k]
                     : (by_ab ? f.across[i][k] - f.within[j][k] : f.across[i][j] - f.within[j][k]);
    const P gap = by_bc ? bc : (by_ab ? ab : ac);
    const P spread = size(gap), mean = 1.0 + (1.0 / 3.0) * (a + b + c);
    const auto close = CloseTriple<P>::is_close(P(spread / mean), steepest);
    const P far = up / (close ? P{} + 1.0 : gap);
    if (!any(close)) return far;
    // ... or a series about the mean.
    const P inverse = 1.0 / mean, s = (1.0 / 3.0) * (a + b + c);
    const CloseTriple<P> near(P((a - s) * inverse), P((b - s) * inverse), P((c - s) * inverse));
    const P L = log1p(s);
    P sum = log_weight * near.log();
    for (int n = 0; n < terms; ++n)
      sum += weight[n] * (1.0 + expm1(P(q[n] * L))) * near.power(q[n]);
    return close ? sum * inverse * inverse : far;
  }
};

}  // namespace polhode::solids
