// SPDX-License-Identifier: Apache-2.0
// Elimination along the tree at an instant, body by body: once for the matrix, again for each
// right-hand side. Derivation: docs/theory/elimination_along_the_tree.md, "At an instant".
#pragma once

#include <polhode/kernels/instant_joints.hpp>
#include <polhode/kernels/small_inverse.hpp>

namespace polhode::POLHODE_ISA {

/// 0 in one column, 1 in all others.
alignas(64) inline constexpr double kWithout[8][8] = {
    {0, 1, 1, 1, 1, 1, 1, 1}, {1, 0, 1, 1, 1, 1, 1, 1}, {1, 1, 0, 1, 1, 1, 1, 1},
    {1, 1, 1, 0, 1, 1, 1, 1}, {1, 1, 1, 1, 0, 1, 1, 1}, {1, 1, 1, 1, 1, 0, 1, 1},
    {1, 1, 1, 1, 1, 1, 0, 1}, {1, 1, 1, 1, 1, 1, 1, 0}};

/// Inverse of a symmetric positive definite matrix in place. False: a pivot is not positive.
template <int n, int c = 0>
POLHODE_INLINE bool invert_positive(Row* a) {
  if constexpr (c < n) {
    const double pivot = a[c][c];
    if (!(pivot > 0.0)) return false;
    const Row others = row_load(kWithout[c]);
    const Row row = (1.0 / pivot) * (multiply(a[c], others) + unit(c));
#pragma GCC unroll 8
    for (int i = 0; i < n; ++i)
      if (i != c) a[i] = multiply(a[i], others) - multiply(spread<c>(a[i]), row);
    a[c] = row;
    return invert_positive<n, c + 1>(a);
  } else {
    return true;
  }
}

/// Calls f.template operator()<n>() for n from 0 to 6.
template <class F>
POLHODE_INLINE auto with_size(int n, F&& f) {
  switch (n) {
    case 0:
      return f.template operator()<0>();
    case 1:
      return f.template operator()<1>();
    case 2:
      return f.template operator()<2>();
    case 3:
      return f.template operator()<3>();
    case 4:
      return f.template operator()<4>();
    case 5:
      return f.template operator()<5>();
    default:
      return f.template operator()<6>();
  }
}

/// xᵀX: a row of forces and moments on a body as one on its parent.
POLHODE_INLINE Row on_parent(const InstantBody& b, const Row& x) {
  return ((x + multiply(spread<0>(x), row_load(b.T[0]))) +
          multiply(spread<1>(x), row_load(b.T[1]))) +
         multiply(spread<2>(x), row_load(b.T[2]));
}
/// Σ x_i rows_i of numbers in memory.
template <int n>
POLHODE_INLINE Row combine(const double* x, const double (*rows)[8]) {
  Row sum = x[0] * row_load(rows[0]);
  for (int i = 1; i < n; ++i) sum += x[i] * row_load(rows[i]);
  return sum;
}
/// Products of rows with one row, as the columns of a row.
template <int n>
POLHODE_INLINE Row products(const double (*rows)[8], const Row& x) {
  if constexpr (n == 1) {
    return row_sum(multiply(row_load(rows[0]), x)) * unit(0);
  } else {
    Row p[6] = {row_zero(), row_zero(), row_zero(), row_zero(), row_zero(), row_zero()};
    for (int i = 0; i < n; ++i) p[i] = multiply(row_load(rows[i]), x);
    return row_sums(p);
  }
}

/// Row i of Gᵀ of a loop at a body.
POLHODE_INLINE double* transposed_row(const InstantView& v, int pair, int i) {
  return v.pair_rows + 8 * (pair + i);
}

/// Passes the loops open at a body on to its parent while the body is eliminated.
inline void carry_at_instant(const InstantView& v, int slot) {
  const InstantBody& body = v.body[slot];
  for (int o = v.first_open[slot]; o < v.first_open[slot + 1]; ++o) {
    const LoopAtBody& here = v.open[o];
    Row G[6], e[6];
    for (int i = 0; i < 6; ++i) G[i] = row_load(transposed_row(v, here.pair, i));
    RowData* kept = v.kept + 12 * o;
    for (int k = 0; k < 6; ++k) {
      const double* B = body.B[k];
      e[k] =
          ((B[0] * G[0] + B[1] * G[1]) + B[2] * G[2]) + ((B[3] * G[3] + B[4] * G[4]) + B[5] * G[5]);
      row_store(kept[k], e[k]);
    }
    for (int k = 0; k < 6; ++k) {
      const double* D = body.D[k];
      row_store(kept[6 + k], ((D[0] * e[0] + D[1] * e[1]) + D[2] * e[2]) +
                                 ((D[3] * e[3] + D[4] * e[4]) + D[5] * e[5]));
    }
    if (here.parent_pair < 0) continue;
    const double c[3] = {body.T[1][5], body.T[2][3], body.T[0][4]};
    shift_rows(c, G);
    for (int i = 0; i < 6; ++i) {
      for (int k = 0; k < 6; ++k) G[i] -= body.Y[k][i] * e[k];
      double* to = transposed_row(v, here.parent_pair, i);
      row_store(to, here.first_at_parent ? G[i] : row_load(to) + G[i]);
    }
  }
  // S(l, l') += e_lᵀ D e_l'
  for (int u = v.first_update[slot]; u < v.first_update[slot + 1]; ++u) {
    const LoopUpdate& update = v.update[u];
    const int row = v.first_open[slot] + update.row_loop;
    const RowData* e = v.kept + 12 * row;
    const RowData* gamma = v.kept + 12 * (v.first_open[slot] + update.column_loop) + 6;
    double* S = v.S + update.block;
    const int n = v.loop[v.open[row].loop].unknowns;
    for (int i = 0; i < n; ++i) {
      Row s = row_load(S + 8 * i);
      for (int k = 0; k < 6; ++k) s += e[k][i] * row_load(gamma[k]);
      row_store(S + 8 * i, s);
    }
  }
}

/// Factors L D Lᵀ of the block of a loop; stored are L below the diagonal and the inverse of D on
/// it. (Redundant rows make the block nearly singular: an explicit inverse would not solve it.)
template <int n>
bool factor_block(double (*S)[8]) {
  for (int c = 0; c < n; ++c) {
    if (!(S[c][c] > 0.0)) return false;
    const double inverse = 1.0 / S[c][c];
    for (int i = c + 1; i < n; ++i) {
      const double factor = inverse * S[i][c];
      for (int j = c + 1; j <= i; ++j) S[i][j] -= factor * S[j][c];
    }
    for (int i = c + 1; i < n; ++i) S[i][c] *= inverse;
    S[c][c] = inverse;
  }
  return true;
}
/// Solves with it, for numbers or rows of numbers.
template <int n, class T>
POLHODE_INLINE void solve_block(const double (*S)[8], T* x) {
#pragma GCC unroll 8
  for (int i = 1; i < n; ++i)
#pragma GCC unroll 8
    for (int j = 0; j < i; ++j) x[i] -= S[i][j] * x[j];
#pragma GCC unroll 8
  for (int i = n - 1; i >= 0; --i) {
    x[i] = S[i][i] * x[i];
#pragma GCC unroll 8
    for (int j = i + 1; j < n; ++j) x[i] -= S[j][i] * x[j];
  }
}

/// Eliminates the n rows of a loop at its common ancestor.
template <int n>
bool eliminate_block(const InstantView& v, const TreeLoop& loop, InstantLoop& data) {
  const double* own = v.S + loop.S;
  for (int i = 0; i < n; ++i)
    row_store(data.S[i], row_load(own + 8 * i) + data.softness[i] * unit(i));
  if (!factor_block<n>(data.S)) return false;
  Row U[n > 0 ? n : 1];  // S⁻¹ G at the ancestor
  alignas(64) double u[6][8];
  if (loop.common >= 0) {
    alignas(64) double G[6][8] = {};
    for (int i = 0; i < 6; ++i) {
      const double* row = transposed_row(v, loop.common_pair, i);
      for (int j = 0; j < n; ++j) G[j][i] = row[j];
    }
    for (int i = 0; i < n; ++i) U[i] = row_load(G[i]);
    solve_block<n>(data.S, U);
    for (int i = 0; i < n; ++i) row_store(u[i], U[i]);
    RowData* A = v.body[loop.common].A;
    for (int i = 0; i < 6; ++i) {
      const double* row = transposed_row(v, loop.common_pair, i);
      Row a = row_load(A[i]);
      for (int j = 0; j < n; ++j) a += row[j] * U[j];
      row_store(A[i], a);
    }
  }
  const int count = loop.last_later - loop.first_later;
  for (int a = 0; a < count; ++a) {
    const LaterLoop& column = v.later[loop.first_later + a];
    const double* to_later = v.S + column.S_row;  // S(l, a)
    if (loop.common >= 0 && column.common_pair >= 0)
      for (int i = 0; i < 6; ++i) {
        double* to = transposed_row(v, column.common_pair, i);
        Row g = row_load(to);
        for (int j = 0; j < n; ++j) g -= u[j][i] * row_load(to_later + 8 * j);
        row_store(to, g);
      }
    Row X[n > 0 ? n : 1];  // S⁻¹ S(l, a)
    for (int j = 0; j < n; ++j) X[j] = row_load(to_later + 8 * j);
    solve_block<n>(data.S, X);
    for (int b = 0; b < count; ++b) {
      const LaterLoop& row = v.later[loop.first_later + b];
      const double* from_later = v.S + row.S_column;  // S(b, l)
      double* Q = v.S + v.product[loop.first_product + count * b + a];
      for (int i = 0; i < v.loop[row.loop].unknowns; ++i) {
        Row q = row_load(Q + 8 * i);
        for (int j = 0; j < n; ++j) q -= from_later[8 * i + j] * X[j];
        row_store(Q + 8 * i, q);
      }
    }
  }
  return true;
}
inline bool eliminate_loop_at_instant(const InstantView& v, int index) {
  const TreeLoop& loop = v.loop[index];
  return with_size(loop.unknowns,
                   [&]<int n>() { return eliminate_block<n>(v, loop, v.loop_data[index]); });
}

/// Eliminates a body. @param free  Number of its joint's free directions.
template <int n>
bool factor_body(const InstantView& v, int slot, int free, double stiffness) {
  InstantBody& b = v.body[slot];
  const int parent = v.parent[slot];
  const bool gives = parent < v.blocks * kLanes;
  alignas(64) double N[6][8], Q[6][8];
  if constexpr (n > 0) {
    Row D[6] = {row_zero(), row_zero(), row_zero(), row_zero(), row_zero(), row_zero()};
    for (int k = 0; k < n; ++k) {
      const double* B = b.B[k];
      const Row row =
          ((B[0] * row_load(b.A[0]) + B[1] * row_load(b.A[1])) + B[2] * row_load(b.A[2])) +
          ((B[3] * row_load(b.A[3]) + B[4] * row_load(b.A[4])) + B[5] * row_load(b.A[5]));
      row_store(N[k], row);
      D[k] = products<n>(b.B, row);
      if (k >= free) D[k] += stiffness * unit(k);
    }
    if (!invert_positive<n>(D)) return false;
    for (int k = 0; k < n; ++k) row_store(b.D[k], D[k]);
    if (v.first_open[slot] == v.first_open[slot + 1] && !gives) return true;
    for (int k = 0; k < n; ++k) row_store(Q[k], on_parent(b, row_load(N[k])));
    asm volatile("" ::: "memory");
    for (int k = 0; k < n; ++k) row_store(b.Y[k], combine<n>(b.D[k], Q));
    if (v.first_open[slot] != v.first_open[slot + 1]) carry_at_instant(v, slot);
  }
  if (!gives) return true;
  Row M[6];
  for (int i = 0; i < 6; ++i) M[i] = row_load(b.A[i]) + combine<3>(b.A[i], b.T);
  const double c[3] = {b.T[1][5], b.T[2][3], b.T[0][4]};
  shift_rows(c, M);
  RowData* A = v.body[parent].A;
  for (int i = 0; i < 6; ++i) {
    for (int k = 0; k < n; ++k) M[i] -= Q[k][i] * row_load(b.Y[k]);
    row_store(A[i], row_load(A[i]) + M[i]);
  }
  return true;
}

/// Sets A to the inertia of the bodies themselves.
inline void set_inertia(const InstantView& v) {
  for (int block = 0; block < v.blocks; ++block)
    for (int at = 0; at < kLanes; at += kWidth) {
      const InstantBlock& m = v.motion[block];
      Pack J[6];
      for (int i = 0; i < 6; ++i) J[i] = v.inverse_mass * load(m.J[i] + at);
      const Pack mass = v.inverse_mass * load(v.mass[block].mass + at), zero{};
      const int entry[3][3] = {{0, 3, 4}, {3, 1, 5}, {4, 5, 2}};
      alignas(64) double rows[kWidth][8];
      InstantBody* body = v.body + block * kLanes + at;
      for (int i = 0; i < 6; ++i) {
        Pack columns[8] = {zero, zero, zero, zero, zero, zero, zero, zero};
        if (i < 3)
          columns[i] = mass;
        else
          for (int j = 0; j < 3; ++j) columns[3 + j] = J[entry[i - 3][j]];
        to_rows(columns, rows[0]);
        for (int k = 0; k < kWidth; ++k) row_store(body[k].A[i], row_load(rows[k]));
      }
    }
}

inline bool factor_at_instant(const InstantView* view) {
  const InstantView& v = *view;
  set_inertia(v);
  const double stiffness = v.soft ? 1.0 / v.epsilon : 0.0;
  for (int k = v.bodies - 1; k >= 0; --k) {
    const int slot = v.slot_in_order[k];
    for (int i = v.first_common[slot]; i < v.first_common[slot + 1]; ++i)
      if (!eliminate_loop_at_instant(v, v.common[i])) return false;
    const int free = JointLayout::of_code(v.block_shape[slot / kLanes]).free();
    if (!with_size(v.soft ? 6 : free,
                   [&]<int n>() { return factor_body<n>(v, slot, free, stiffness); }))
      return false;
  }
  for (int i = 0; i < v.ground_loops; ++i)
    if (!eliminate_loop_at_instant(v, v.ground_loop[i])) return false;
  return true;
}

/// Right-hand side of a loop at its common ancestor.
POLHODE_INLINE void eliminate_right_side(const InstantView& v, int index) {
  const TreeLoop& loop = v.loop[index];
  InstantLoop& data = v.loop_data[index];
  const int n = loop.unknowns;
  alignas(64) double u[8];
  row_store(u, row_load(data.nu));
  with_size(n, [&]<int k>() { solve_block<k>(data.S, u); });
  const Row U = row_load(u);
  if (loop.common >= 0) {
    double* rho = v.body[loop.common].rho;
    row_store(rho, row_load(rho) - products<6>(reinterpret_cast<const RowData*>(
                                                   transposed_row(v, loop.common_pair, 0)),
                                               U));
  }
  for (int b = loop.first_later; b < loop.last_later; ++b) {
    double* nu = v.loop_data[v.later[b].loop].nu;
    Row s = row_load(nu);
    for (int j = 0; j < n; ++j) s -= u[j] * row_load(v.S + v.later[b].S_row + 8 * j);
    row_store(nu, s);
  }
}

/// Multipliers of a loop from the motion of the common ancestor and the loops after it.
POLHODE_INLINE void solve_loop_at_instant(const InstantView& v, int index) {
  const TreeLoop& loop = v.loop[index];
  InstantLoop& data = v.loop_data[index];
  Row t = row_load(data.nu);
  if (loop.common >= 0)
    t += combine<6>(v.body[loop.common].X,
                    reinterpret_cast<const RowData*>(transposed_row(v, loop.common_pair, 0)));
  for (int a = loop.first_later; a < loop.last_later; ++a) {
    const double* y = v.loop_data[v.later[a].loop].y;
    const int m = v.loop[v.later[a].loop].unknowns;
    for (int j = 0; j < m; ++j) t += y[j] * row_load(v.S + v.later[a].S_column + 8 * j);
  }
  row_store(data.y, -1.0 * t);
  with_size(loop.unknowns, [&]<int k>() { solve_block<k>(data.S, data.y); });
}

template <int n>
POLHODE_INLINE void reduce_body(const InstantView& v, int slot, int free) {
  InstantBody& b = v.body[slot];
  const int parent = v.parent[slot];
  const JointLanes& lanes = v.lanes[slot / kLanes];
  const int lane = slot % kLanes;
  Row x_g = row_zero();
  for (int i = 0; i < 6 - free; ++i) {
    const double value = lanes.value[i][lane] - v.epsilon * lanes.centre[i][lane];
    x_g -= value * row_load(b.B[free + i]);
  }
  row_store(b.x_g, x_g);
  asm volatile("" ::: "memory");
  const Row r = row_load(b.rho) - combine<6>(b.x_g, b.A);
  Row p = row_zero();
  alignas(64) double beta[8];
  if constexpr (n > 0) {
    row_store(beta, products<n>(b.B, r));
    asm volatile("" ::: "memory");
    p = combine<n>(beta, b.D);
  }
  row_store(b.p, p);
  for (int o = v.first_open[slot]; o < v.first_open[slot + 1]; ++o) {
    const LoopAtBody& here = v.open[o];
    double* nu = v.loop_data[here.loop].nu;
    row_store(nu, (row_load(nu) + combine<6>(b.x_g, reinterpret_cast<const RowData*>(
                                                        transposed_row(v, here.pair, 0)))) +
                      combine<6>(b.p, v.kept + 12 * o));
  }
  if (parent == v.blocks * kLanes) return;
  Row out = on_parent(b, r);
  if constexpr (n > 0) out -= combine<n>(beta, b.Y);
  double* rho = v.body[parent].rho;
  row_store(rho, row_load(rho) + out);
}

template <int n>
POLHODE_INLINE void move_body(const InstantView& v, int slot, int free) {
  InstantBody& b = v.body[slot];
  const Row x_p = row_load(v.body[v.parent[slot]].X);
  Row p = row_load(b.p);
  if constexpr (n > 0) {
    p -= products<n>(b.Y, x_p);
    for (int o = v.first_open[slot]; o < v.first_open[slot + 1]; ++o)
      p += products<6>(v.kept + 12 * o + 6, row_load(v.loop_data[v.open[o].loop].y));
    row_store(b.p, p);
    asm volatile("" ::: "memory");
  }
  Row x = x_p + (row_load(b.x_g) + products<3>(b.T, x_p));
  if constexpr (n > 0) x += combine<n>(b.p, b.B);
  row_store(b.X, x);
  JointLanes& lanes = v.lanes[slot / kLanes];
  const int lane = slot % kLanes;
  if (v.soft) {  // multipliers by the softness of the row
    const double stiffness = 1.0 / v.epsilon;
    for (int i = free; i < 6; ++i) lanes.lambda[i - free][lane] = -stiffness * b.p[i];
  } else if (free < 6) {  // multipliers by the balance of the subtree
    asm volatile("" ::: "memory");
    const Row w = combine<6>(b.X, b.A) - row_load(b.rho);
    alignas(64) double force[8];
    row_store(force, products<6>(b.B, w));
    for (int i = free; i < 6; ++i) lanes.lambda[i - free][lane] = force[i];
  }
}

/// Largest change of the multipliers since the centres were set, times ε, and size of the
/// solution; the centres of a soft system are moved to the multipliers.
inline InstantResidual review(const InstantView& v) {
  InstantResidual done;
  Pack change{}, size{}, value{};
  for (int block = 0; block < v.blocks; ++block)
    for (int at = 0; at < kLanes; at += kWidth) {
      JointLanes& lanes = v.lanes[block];
      for (int i = 0; i < 6; ++i) {
        change =
            max_keeping_nan(change, abs(load(lanes.lambda[i] + at) - load(lanes.centre[i] + at)));
        value = max_keeping_nan(value, abs(load(lanes.value[i] + at)));
      }
    }
  alignas(64) const double units[8] = {1, 1, 1, v.length, v.length, v.length, 0, 0};
  Row most = row_zero();
  for (int k = 0; k < v.bodies; ++k) {
    const Row x = abs(multiply(row_load(units), row_load(v.body[v.slot_in_order[k]].X)));
    for (int i = 0; i < kParts; ++i) most.part[i] = max_keeping_nan(most.part[i], x.part[i]);
  }
  for (int i = 0; i < kParts; ++i) size = max_keeping_nan(size, most.part[i]);
  double loops = 0.0;
  for (int l = 0; l < v.loops; ++l) {
    const InstantLoop& loop = v.loop_data[l];
    for (int i = 0; i < v.loop[l].unknowns; ++i) {
      const double x = __builtin_fabs(loop.softness[i] * (loop.y[i] - loop.centre[i]));
      if (!(x <= loops)) loops = x;
      const double g = __builtin_fabs(loop.value[i]);
      if (!(g <= done.scale)) done.scale = g;
    }
  }
  const double of_tree = v.epsilon * largest(change);
  done.residual = !v.soft || loops > of_tree || loops != loops ? loops : of_tree;
  const double sizes[2] = {largest(size), largest(value)};
  for (const double x : sizes)
    if (!(x <= done.scale)) done.scale = x;
  if (of_tree != of_tree) done.residual = of_tree;
  return done;
}

inline InstantResidual solve_at_instant(const InstantView* view) {
  const InstantView& v = *view;
  for (int k = 0; k < v.bodies; ++k) {
    InstantBody& b = v.body[v.slot_in_order[k]];
    row_store(b.rho, row_load(b.load));
  }
  for (int l = 0; l < v.loops; ++l) {
    InstantLoop& loop = v.loop_data[l];
    row_store(loop.nu,
              row_load(loop.value) - multiply(row_load(loop.softness), row_load(loop.centre)));
  }
  const auto free_of = [&](int slot) {
    return JointLayout::of_code(v.block_shape[slot / kLanes]).free();
  };
  for (int k = v.bodies - 1; k >= 0; --k) {
    const int slot = v.slot_in_order[k], free = free_of(slot);
    for (int i = v.first_common[slot]; i < v.first_common[slot + 1]; ++i)
      eliminate_right_side(v, v.common[i]);
    with_size(v.soft ? 6 : free, [&]<int n>() { reduce_body<n>(v, slot, free); });
  }
  for (int i = 0; i < v.ground_loops; ++i) eliminate_right_side(v, v.ground_loop[i]);
  for (int i = v.ground_loops - 1; i >= 0; --i) solve_loop_at_instant(v, v.ground_loop[i]);
  for (int k = 0; k < v.bodies; ++k) {
    const int slot = v.slot_in_order[k], free = free_of(slot);
    with_size(v.soft ? 6 : free, [&]<int n>() { move_body<n>(v, slot, free); });
    for (int i = v.first_common[slot + 1] - 1; i >= v.first_common[slot]; --i)
      solve_loop_at_instant(v, v.common[i]);
  }
  return review(v);
}

constexpr InstantKernels make_instant_kernels() {
  return {place_at_instant, assemble_at_instant, rates_at_instant, velocity_terms_at_instant,
          loads_at_instant, factor_at_instant,   solve_at_instant, add_velocities_at_instant};
}

}  // namespace polhode::POLHODE_ISA
