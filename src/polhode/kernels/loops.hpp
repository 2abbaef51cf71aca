// SPDX-License-Identifier: Apache-2.0
// Loops carried along the tree. A loop has unknowns y besides the bodies' increments:
//   rows of its bodies:   ... + C y = ρ,        its own rows:   R Δx + S y = −ν.
// Its columns C and rows R are carried from its bodies towards the roots and meet at the lowest
// common ancestor, where the loop is eliminated; loops on the ground come last.
#pragma once

#include <polhode/kernels/pack.hpp>
#include <polhode/kernels/tree_data.hpp>

namespace polhode::POLHODE_ISA {

/// Row i of a body's C: panels rows of 8; Rᵀ follows after 6 · panels rows.
POLHODE_INLINE double* pair_row(const TreeView& v, int pair, int panels, int i) {
  return v.pair_rows + 8 * (pair + panels * i);
}

/// Row c: ones in the columns beyond c.
alignas(64) inline constexpr double kBeyond[8][8] = {
    {0, 1, 1, 1, 1, 1, 1, 1}, {0, 0, 1, 1, 1, 1, 1, 1}, {0, 0, 0, 1, 1, 1, 1, 1},
    {0, 0, 0, 0, 1, 1, 1, 1}, {0, 0, 0, 0, 0, 1, 1, 1}, {0, 0, 0, 0, 0, 0, 1, 1},
    {0, 0, 0, 0, 0, 0, 0, 1}, {0, 0, 0, 0, 0, 0, 0, 0}};

/// LU of the loop's own block with row exchanges, in place, inverses of the pivots on the
/// diagonal; its rows are 8 · panels apart.
inline bool factor_loop(const TreeView& v, const TreeLoop& loop) {
  const int n = loop.unknowns, panels = loop.panels, w = 8 * panels;
  double* S = v.S + loop.S;
  int* pivots = v.pivots + loop.nu;
  for (int c = 0; c < n; ++c) {
    int p = c;
    double most = __builtin_fabs(S[c * w + c]);
    for (int i = c + 1; i < n; ++i) {
      const double size = __builtin_fabs(S[i * w + c]);
      if (size > most) {
        most = size;
        p = i;
      }
    }
    pivots[c] = p;
    if (!(most > 0.0)) return false;
    if (p != c)
      for (int k = 0; k < w; k += 8) {
        const Row x = row_load(S + c * w + k), y = row_load(S + p * w + k);
        row_store(S + c * w + k, y);
        row_store(S + p * w + k, x);
      }
    const double inverse = 1.0 / S[c * w + c];
    S[c * w + c] = inverse;
    const int first = c / 8;
    const Row beyond = multiply(row_load(S + c * w + 8 * first), row_load(kBeyond[c % 8]));
    for (int i = c + 1; i < n; ++i) {
      const double factor = S[i * w + c] * inverse;
      row_store(S + i * w + 8 * first, row_load(S + i * w + 8 * first) - factor * beyond);
      for (int k = first + 1; k < panels; ++k)
        row_store(S + i * w + 8 * k,
                  row_load(S + i * w + 8 * k) - factor * row_load(S + c * w + 8 * k));
      S[i * w + c] = factor;
    }
  }
  return true;
}

/// Applies the inverse of a factored block of n unknowns to one panel of rows `width` apart.
template <int n>
POLHODE_INLINE void solve_panel(const double* S, const int* pivots, double* x, int width) {
  Row r[n];
  for (int c = 0; c < n; ++c)
    if (pivots[c] != c) {
      const Row t = row_load(x + c * width);
      row_store(x + c * width, row_load(x + pivots[c] * width));
      row_store(x + pivots[c] * width, t);
    }
  for (int i = 0; i < n; ++i) r[i] = row_load(x + i * width);
#pragma GCC unroll 8
  for (int c = 0; c < n; ++c)
#pragma GCC unroll 8
    for (int i = c + 1; i < n; ++i) r[i] -= S[i * 8 + c] * r[c];
#pragma GCC unroll 8
  for (int c = n - 1; c >= 0; --c) {
    r[c] = S[c * 8 + c] * r[c];
#pragma GCC unroll 8
    for (int i = 0; i < c; ++i) r[i] -= S[i * 8 + c] * r[c];
  }
  for (int i = 0; i < n; ++i) row_store(x + i * width, r[i]);
}

/// Applies the factored block's inverse to `panels` × 8 columns, rows `width` doubles apart.
inline void solve_rows(const TreeView& v, const TreeLoop& loop, double* x, int panels, int width) {
  const int n = loop.unknowns, w = 8 * loop.panels;
  const double* S = v.S + loop.S;
  const int* pivots = v.pivots + loop.nu;
  for (int k = 0; k < panels; ++k) {
    double* column = x + 8 * k;
    switch (n) {
      case 3:
        solve_panel<3>(S, pivots, column, width);
        continue;
      case 5:
        solve_panel<5>(S, pivots, column, width);
        continue;
      case 6:
        solve_panel<6>(S, pivots, column, width);
        continue;
      case 8:
        solve_panel<8>(S, pivots, column, width);
        continue;
      default:
        break;
    }
    Row r[24];
    for (int i = 0; i < n; ++i) r[i] = row_load(column + i * width);
    for (int c = 0; c < n; ++c)
      if (pivots[c] != c) {
        const Row t = r[c];
        r[c] = r[pivots[c]];
        r[pivots[c]] = t;
      }
    for (int c = 0; c < n; ++c)
      for (int i = c + 1; i < n; ++i) r[i] -= S[i * w + c] * r[c];
    for (int c = n - 1; c >= 0; --c) {
      r[c] = S[c * w + c] * r[c];
      for (int i = 0; i < c; ++i) r[i] -= S[i * w + c] * r[c];
    }
    for (int i = 0; i < n; ++i) row_store(column + i * width, r[i]);
  }
}

/// Eliminates a loop: its unknowns become U = S⁻¹[S_later | R_common | ν].
inline bool eliminate_loop(const TreeView& v, int index) {
  const TreeLoop& loop = v.loop[index];
  const int n = loop.unknowns;
  if (!factor_loop(v, loop)) return false;
  // U: columns 0..5 the common ancestor's increment, 7 the constant.
  double* U = v.U + 8 * loop.U;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < 7; ++j) U[8 * i + j] = 0.0;
    U[8 * i + 7] = v.nu[loop.nu + i];
  }
  if (loop.common >= 0)
    for (int j = 0; j < 6; ++j) {
      const double* Rt = pair_row(v, loop.common_pair, loop.panels, 6 + j);
      for (int i = 0; i < n; ++i) U[8 * i + j] = Rt[i];
    }
  solve_rows(v, loop, U, 1, 8);
  for (int a = loop.first_later; a < loop.last_later; ++a) {
    const TreeLoop& other = v.loop[v.later[a].loop];
    solve_rows(v, loop, v.S + v.later[a].S_row, other.panels, 8 * other.panels);
  }
  // Later loops: S(b, a) −= S(b, l) U(a), ν_b −= S(b, l) U_7, and at the common ancestor
  // R_b −= S(b, l) U_R, C_b −= C_l U(b).
  for (int b = loop.first_later; b < loop.last_later; ++b) {
    const LaterLoop& row = v.later[b];
    const TreeLoop& other = v.loop[row.loop];
    const double* L = v.S + row.S_column;  // S(b, l): other.unknowns rows of loop.panels × 8
    for (int a = loop.first_later; a < loop.last_later; ++a) {
      const LaterLoop& column = v.later[a];
      const TreeLoop& target = v.loop[column.loop];
      const int count = loop.last_later - loop.first_later;
      double* Q =
          v.S +
          v.product[loop.first_product + count * (b - loop.first_later) + a - loop.first_later];
      const double* Ua = v.S + column.S_row;
      const int w = 8 * target.panels;
      for (int i = 0; i < other.unknowns; ++i)
        for (int k = 0; k < target.panels; ++k) {
          Row q = row_load(Q + i * w + 8 * k);
          for (int j = 0; j < n; ++j)
            q -= L[i * 8 * loop.panels + j] * row_load(Ua + j * w + 8 * k);
          row_store(Q + i * w + 8 * k, q);
        }
    }
    for (int i = 0; i < other.unknowns; ++i) {
      double s0 = 0.0, s1 = 0.0;
      const double* l = L + i * 8 * loop.panels;
      for (int j = 0; j + 1 < n; j += 2) {
        s0 += l[j] * U[8 * j + 7];
        s1 += l[j + 1] * U[8 * j + 15];
      }
      if (n % 2) s0 += l[n - 1] * U[8 * n - 1];
      v.nu[other.nu + i] -= s0 + s1;
    }
    if (loop.common >= 0 && row.common_pair >= 0) {
      for (int c = 0; c < 6; ++c) {
        double* Rt = pair_row(v, row.common_pair, other.panels, 6 + c);
        for (int i = 0; i < other.unknowns; ++i) {
          double s = 0.0;
          for (int j = 0; j < n; ++j) s += L[i * 8 * loop.panels + j] * U[8 * j + c];
          Rt[i] -= s;
        }
        const double* C = pair_row(v, loop.common_pair, loop.panels, c);
        double* other_C = pair_row(v, row.common_pair, other.panels, c);
        const double* Ub = v.S + row.S_row;
        for (int k = 0; k < other.panels; ++k) {
          Row q = row_load(other_C + 8 * k);
          for (int j = 0; j < n; ++j) q -= C[j] * row_load(Ub + j * 8 * other.panels + 8 * k);
          row_store(other_C + 8 * k, q);
        }
      }
    }
  }
  if (loop.common >= 0) {
    RowData* A = v.body[loop.common].A;
    for (int i = 0; i < 6; ++i) {
      const double* C = pair_row(v, loop.common_pair, loop.panels, i);
      Row a = row_load(A[i]);
      for (int j = 0; j < n; ++j) a -= C[j] * row_load(U + 8 * j);
      row_store(A[i], a);
    }
  }
  return true;
}

inline bool eliminate_common_loops(const TreeView& v, int slot) {
  for (int i = v.first_common[slot]; i < v.first_common[slot + 1]; ++i)
    if (!eliminate_loop(v, v.common[i])) return false;
  return true;
}

/// Passes the loops open at a body on to its parent while the body is eliminated.
/// S_l, S_r: nq × 6; P: 6 rows of nq; D_inverse: rows of 8; Y = D⁻¹[Qᵀ | · | −β].
template <int nq>
__attribute__((noinline)) void carry_loops(const TreeView& v, int slot, const double* S_l,
                                           const double* S_r, const double* x_g, const double* c_l,
                                           const double* c_r, const double* P,
                                           const double* D_inverse, const Row* Y) {
  for (int o = v.first_open[slot]; o < v.first_open[slot + 1]; ++o) {
    const LoopAtBody& here = v.open[o];
    TreeLoop& loop = v.loop[here.loop];
    for (int k = 0; k < loop.panels; ++k) {
      constexpr int most = nq > 0 ? nq : 1;  // NOLINT(bugprone-branch-clone): the two agree for one
      Row C[6], R[6], e[most], gamma[most], projected[most];
      for (int i = 0; i < 6; ++i) {
        C[i] = row_load(pair_row(v, here.pair, loop.panels, i) + 8 * k);
        R[i] = row_load(pair_row(v, here.pair, loop.panels, 6 + i) + 8 * k);
      }
      for (int d = 0; d < nq; ++d) {
        const double *l = S_l + 6 * d, *r = S_r + 6 * d;
        projected[d] = ((l[0] * C[0] + l[1] * C[1]) + l[2] * C[2]) +
                       ((l[3] * C[3] + l[4] * C[4]) + l[5] * C[5]);
        e[d] = ((r[0] * R[0] + r[1] * R[1]) + r[2] * R[2]) +
               ((r[3] * R[3] + r[4] * R[4]) + r[5] * R[5]);
      }
      Row nu = row_load(v.nu + loop.nu + 8 * k);
      for (int i = 0; i < 6; ++i) nu += x_g[i] * R[i];
      for (int d = 0; d < nq; ++d) {
        gamma[d] = D_inverse[8 * d] * projected[0];
        for (int j = 1; j < nq; ++j) gamma[d] += D_inverse[8 * d + j] * projected[j];
        nu -= Y[d][7] * e[d];
        row_store(v.kept_rows + 8 * (here.kept + loop.panels * d + k), gamma[d]);
        row_store(v.kept_rows + 8 * (here.kept + loop.panels * (nq + d) + k), e[d]);
      }
      row_store(v.nu + loop.nu + 8 * k, nu);
      if (here.parent_pair < 0) continue;
      C[3] += c_l[1] * C[2] - c_l[2] * C[1];
      C[4] += c_l[2] * C[0] - c_l[0] * C[2];
      C[5] += c_l[0] * C[1] - c_l[1] * C[0];
      R[3] += c_r[1] * R[2] - c_r[2] * R[1];
      R[4] += c_r[2] * R[0] - c_r[0] * R[2];
      R[5] += c_r[0] * R[1] - c_r[1] * R[0];
      for (int i = 0; i < 6; ++i) {
        for (int d = 0; d < nq; ++d) {
          C[i] -= P[nq * i + d] * gamma[d];
          R[i] -= Y[d][i] * e[d];
        }
        double* to_C = pair_row(v, here.parent_pair, loop.panels, i) + 8 * k;
        double* to_R = pair_row(v, here.parent_pair, loop.panels, 6 + i) + 8 * k;
        if (here.first_at_parent) {
          row_store(to_C, C[i]);
          row_store(to_R, R[i]);
        } else {
          row_store(to_C, row_load(to_C) + C[i]);
          row_store(to_R, row_load(to_R) + R[i]);
        }
      }
    }
  }
  // S(l, l') −= e_lᵀ γ_l'
  for (int u = v.first_update[slot]; u < v.first_update[slot + 1]; ++u) {
    const LoopUpdate& update = v.update[u];
    const LoopAtBody& row = v.open[v.first_open[slot] + update.row_loop];
    const LoopAtBody& column = v.open[v.first_open[slot] + update.column_loop];
    const TreeLoop& row_loop = v.loop[row.loop];
    const TreeLoop& column_loop = v.loop[column.loop];
    double* S = v.S + update.block;
    for (int d = 0; d < nq; ++d) {
      const double* e = v.kept_rows + 8 * (row.kept + row_loop.panels * (nq + d));
      const double* gamma = v.kept_rows + 8 * (column.kept + column_loop.panels * d);
      for (int k = 0; k < column_loop.panels; ++k) {
        const Row g = row_load(gamma + 8 * k);
        for (int i = 0; i < row_loop.unknowns; ++i) {
          double* to = S + 8 * (column_loop.panels * i + k);
          row_store(to, row_load(to) - e[i] * g);
        }
      }
    }
  }
}

/// y of a loop from the common ancestor's increment and the loops eliminated after it.
inline void solve_loop(const TreeView& v, int index) {
  const TreeLoop& loop = v.loop[index];
  const double* U = v.U + 8 * loop.U;
  const Row x = row_load(v.body[loop.common >= 0 ? loop.common : v.blocks * kLanes].X);
  double* y = v.y + loop.nu;
  for (int i = 0; i < loop.unknowns; ++i) {
    Row s = multiply(row_load(U + 8 * i), x);  // U_i · [Δx_common, 0, 1]
    for (int a = loop.first_later; a < loop.last_later; ++a) {
      const TreeLoop& other = v.loop[v.later[a].loop];
      const double* S = v.S + v.later[a].S_row + 8 * other.panels * i;
      for (int k = 0; k < other.panels; ++k)
        s += multiply(row_load(S + 8 * k), row_load(v.y + other.nu + 8 * k));
    }
    y[i] = -row_sum(s);
  }
}

inline void solve_common_loops(const TreeView& v, int slot) {
  for (int i = v.first_common[slot + 1] - 1; i >= v.first_common[slot]; --i)
    solve_loop(v, v.common[i]);
}

/// q −= Σ γ y over the loops open at a body.
inline void subtract_loops(const TreeView& v, int slot, int nq, double* q) {
  for (int o = v.first_open[slot]; o < v.first_open[slot + 1]; ++o) {
    const LoopAtBody& here = v.open[o];
    const TreeLoop& loop = v.loop[here.loop];
    for (int k = 0; k < loop.panels; ++k) {
      const Row y = row_load(v.y + loop.nu + 8 * k);
      for (int d = 0; d < nq; ++d)
        q[d] -= row_sum(multiply(row_load(v.kept_rows + 8 * (here.kept + loop.panels * d + k)), y));
    }
  }
}

/// wrench += Σ C y over the loops open at a body.
inline void add_loop_forces(const TreeView& v, int slot, double* wrench) {
  for (int o = v.first_open[slot]; o < v.first_open[slot + 1]; ++o) {
    const LoopAtBody& here = v.open[o];
    const TreeLoop& loop = v.loop[here.loop];
    for (int k = 0; k < loop.panels; ++k) {
      const Row y = row_load(v.y + loop.nu + 8 * k);
      for (int i = 0; i < 6; ++i)
        wrench[i] += row_sum(multiply(row_load(pair_row(v, here.pair, loop.panels, i) + 8 * k), y));
    }
  }
}

}  // namespace polhode::POLHODE_ISA
