// SPDX-License-Identifier: Apache-2.0
// Elimination along the tree, body by body: towards the roots (up) and back (down).
// Derivation: docs/theory/elimination_along_the_tree.md.
#pragma once

#include <polhode/kernels/joint_sums.hpp>
#include <polhode/kernels/loop_joints.hpp>
#include <polhode/kernels/loops.hpp>
#include <polhode/kernels/small_inverse.hpp>

namespace polhode::POLHODE_ISA {

/// Collects the body's rows: own balance, off-tree interactions, children.
POLHODE_INLINE void collect_rows(const TreeView& v, int slot, int lane, const BlockScratch& s,
                                 Row* A) {
  EliminatedBody& e = v.body[slot];
  for (int i = 0; i < 3; ++i) {
    A[i] = s.mass[lane] * unit(i) + s.rhs[i][lane] * unit(7);
    A[3 + i] = row_load(s.theta[i][lane]);
  }
  if (v.has_children[slot])
    for (int i = 0; i < 6; ++i) A[i] += row_load(e.A[i]);
  if (v.extra[slot] >= 0)
    for (int i = 0; i < 6; ++i) A[i] += row_load(v.extra_rows[v.extra[slot]].A[i]);
  for (int i = 0; i < 6; ++i) row_store(e.A[i], A[i]);
}

/// bottom += c × top, for rows: X_lᵀ applied to the rows of a wrench.
POLHODE_INLINE void shift_rows(const double* c, Row* M) {
  M[3] += c[1] * M[2] - c[2] * M[1];
  M[4] += c[2] * M[0] - c[0] * M[2];
  M[5] += c[0] * M[1] - c[1] * M[0];
}

/// Adds the rows M of an eliminated body to its parent.
POLHODE_INLINE void give_to_parent(const TreeView& v, int slot, int lane, const BlockScratch& s,
                                   Row* M) {
  // The joint's force on the parent rotates with its lever arm: arm Fᵀ − F·arm I.
  const double along = s.F_dot_arm[lane];
  const Row F = row_load(s.F_rows[lane]);
  for (int i = 0; i < 3; ++i) M[3 + i] += s.arm[i][lane] * F - along * unit(3 + i);
  EliminatedBody& p = v.body[v.parent[slot]];
  if (v.first_child[slot])
    for (int i = 0; i < 6; ++i) row_store(p.A[i], M[i]);
  else
    for (int i = 0; i < 6; ++i) row_store(p.A[i], row_load(p.A[i]) + M[i]);
}

/// Eliminates a body on a spherical joint without loops. Its unknowns are the displacement of the
/// joint's point, Δx = Δr_a + Δθ_a × arm, which couples to the parent, and its whole rotation: Δr_b
/// = Δx + z_b × Δθ_b + x_g. The remainder is a 3×3 matrix at the point.
POLHODE_INLINE bool eliminate_ball(const TreeView& v, int slot, int lane, const BlockScratch& s) {
  if (v.first_common[slot] != v.first_common[slot + 1] && !eliminate_common_loops(v, slot))
    return false;
  Row M[6];
  collect_rows(v, slot, lane, s, M);
  const double(*a)[8] = v.body[slot].A;
  asm volatile("" ::: "memory");
  // Columns [Δx | Δθ_b | · | A x_g − ρ], then moments about the point.
  const Row T[3] = {row_load(s.T[0][lane]), row_load(s.T[1][lane]), row_load(s.T[2][lane])};
  for (int i = 0; i < 6; ++i) M[i] = (M[i] + a[i][0] * T[0] + a[i][1] * T[1]) + a[i][2] * T[2];
  const double minus_z[3] = {-s.z_l[0][lane], -s.z_l[1][lane], -s.z_l[2][lane]};
  shift_rows(minus_z, M);
  alignas(64) double m[6][8], D_inverse[3][8];
  for (int i = 0; i < 6; ++i) row_store(m[i], M[i]);
  asm volatile("" ::: "memory");
  const double D[3][8] = {
      {m[3][3], m[3][4], m[3][5]}, {m[4][3], m[4][4], m[4][5]}, {m[5][3], m[5][4], m[5][5]}};
  if (!invert<3>(D, D_inverse)) return false;
  Row Y[3];
  RowData* y = v.Y + v.y_row[slot];
  for (int k = 0; k < 3; ++k) {
    Y[k] = (D_inverse[k][0] * M[3] + D_inverse[k][1] * M[4]) + D_inverse[k][2] * M[5];
    row_store(y[k], Y[k]);
  }
  if (v.parent[slot] < 0) return true;
  for (int i = 0; i < 3; ++i) {
    M[i] = ((M[i] - m[i][3] * Y[0]) - m[i][4] * Y[1]) - m[i][5] * Y[2];
    row_store(m[i], M[i]);
  }
  asm volatile("" ::: "memory");
  alignas(64) static constexpr double kOthers[8] = {1, 1, 1, 0, 0, 0, 0, 1};
  const Row others = row_load(kOthers);
  const Row arm[3] = {row_load(s.arm_rows[0][lane]), row_load(s.arm_rows[1][lane]),
                      row_load(s.arm_rows[2][lane])};
  for (int i = 0; i < 3; ++i)
    M[i] = ((multiply(M[i], others) + m[i][0] * arm[0]) + m[i][1] * arm[1]) + m[i][2] * arm[2];
  M[3] = M[4] = M[5] = row_zero();
  const double arm_l[3] = {s.arm_l[0][lane], s.arm_l[1][lane], s.arm_l[2][lane]};
  shift_rows(arm_l, M);
  give_to_parent(v, slot, lane, s, M);
  return true;
}

/// Whether eliminate_ball() applies to a body on a spherical joint.
POLHODE_INLINE bool plain_ball(const TreeView& v, int slot) {
  return v.first_open[slot] == v.first_open[slot + 1] && v.edge[slot] < 0;
}

/// Eliminates a body whose joint has kFree free directions.
template <class S>
bool eliminate(const TreeView& v, int slot, int lane, const BlockScratch& s) {
  constexpr int nq = S::free;
  constexpr JointLayout l = S::layout;
  if constexpr (S::ball)
    if (plain_ball(v, slot)) return eliminate_ball(v, slot, lane, s);
  const double* data = v.joint_data + v.joint[slot / kLanes] + lane;
  const auto kept = [&](int field) { return data[8 * field]; };
  // Free directions k, component i; a spherical joint stores only the lever arms z_b from which
  // they follow.
  const auto turn = [](int k, int i, const auto& z) {
    if (i >= 3) return i - 3 == k ? 1.0 : 0.0;
    return i == k ? 0.0 : i == (k + 1) % 3 ? z(3 - i - k) : -z(3 - i - k);
  };
  const auto right = [&](int k, int i) {
    if constexpr (S::ball) return turn(k, i, [&](int j) { return kept(l.z_b() + j); });
    return kept(l.S_r() + 6 * k + i);
  };
  const auto left = [&](int k, int i) {
    if constexpr (S::ball) return turn(k, i, [&](int j) { return s.z_l[j][lane]; });
    return s.S_l[k][i][lane];
  };
  if (v.first_common[slot] != v.first_common[slot + 1] && !eliminate_common_loops(v, slot))
    return false;
  Row M[6];
  collect_rows(v, slot, lane, s, M);
  // From memory on purpose: scalars of a row that was just stored.
  const double(*a)[8] = v.body[slot].A;
  asm volatile("" ::: "memory");

  // M = [A X_r | A S_r | A x_g − ρ] for one free direction, [A X_r | · | A x_g − ρ] and N = A S_r
  // otherwise.
  Row T[6], N[6], Sr[6];
  for (int i = 0; i < 3; ++i) {
    if constexpr (S::ball) {
      alignas(64) double row[8] = {0, 0, 0, 0, 0, 0, 0, kept(l.x_g() + i)};  // [−ĉ_r | · | x_g]
      row[3 + (i + 1) % 3] = kept(l.c_r() + (i + 2) % 3);
      row[3 + (i + 2) % 3] = -kept(l.c_r() + (i + 1) % 3);
      T[i] = row_load(row);
    } else {
      T[i] = row_load(s.T[i][lane]);
    }
    T[3 + i] = kept(l.x_g() + 3 + i) * unit(7);
    if constexpr (nq == 1) T[3 + i] += kept(l.S_r() + 3 + i) * unit(6);
  }
  for (int i = 0; i < 6; ++i) {
    M[i] = (M[i] + a[i][0] * T[0] + a[i][1] * T[1]) + a[i][2] * T[2];
    if constexpr (S::ND > 0 || nq == 1) M[i] += (a[i][3] * T[3] + a[i][4] * T[4]) + a[i][5] * T[5];
  }
  if constexpr (nq > 1) {
    for (int i = 0; i < 6; ++i) {
      if constexpr (S::ball) {
        alignas(64) const double row[8] = {right(0, i), right(1, i), right(2, i)};
        Sr[i] = row_load(row);
      } else {
        Sr[i] = row_load(s.S_rows[i][lane]);
      }
    }
    for (int i = 0; i < 6; ++i)
      N[i] = ((a[i][0] * Sr[0] + a[i][1] * Sr[1]) + a[i][2] * Sr[2]) +
             ((a[i][3] * Sr[3] + a[i][4] * Sr[4]) + a[i][5] * Sr[5]);
  }
  const EdgeRows* edge = v.edge[slot] >= 0 ? &v.edge_rows[v.edge[slot]] : nullptr;
  if (edge)
    for (int i = 0; i < 6; ++i) M[i] += row_load(edge->K_bp[i]);

  // Projected rows Y = [Qᵀ | D or · | −β].
  Row Y[nq > 0 ? nq : 1];
  alignas(64) double D[nq > 0 ? nq : 1][8] = {}, D_inverse[nq > 0 ? nq : 1][8] = {};
  for (int k = 0; k < nq; ++k) {
    double w[6];
    for (int i = 0; i < 6; ++i) w[i] = left(k, i);
    Y[k] =
        ((w[0] * M[0] + w[1] * M[1]) + w[2] * M[2]) + ((w[3] * M[3] + w[4] * M[4]) + w[5] * M[5]);
    if constexpr (nq == 1) {
      Y[k] += row_load(s.k_rows[lane]);
    } else if constexpr (!S::ball) {
      alignas(64) const double stiffness[8] = {
          0, 0, 0, s.k_a[k][0][lane], s.k_a[k][1][lane], s.k_a[k][2][lane], 0, 0};
      Y[k] += row_load(stiffness);
    }
    if constexpr (nq > 1) {
      const Row d =
          ((w[0] * N[0] + w[1] * N[1]) + w[2] * N[2]) + ((w[3] * N[3] + w[4] * N[4]) + w[5] * N[5]);
      row_store(D[k], d);
    } else {
      D[0][0] = Y[0][6];
      Row size = abs(w[0] * M[0]);
      for (int i = 1; i < 6; ++i) size += abs(w[i] * M[i]);
      if (!(__builtin_fabs(D[0][0]) > 1e-12 * size[6])) return false;
    }
  }
  if constexpr (S::ND == 1) {  // stiffness on Δθ_b = Δθ_a + (S_r q)_θ + w
    constexpr int k = S::taus + 1;
    const double kb[3] = {s.k_b[0][lane], s.k_b[1][lane], s.k_b[2][lane]};
    double constant = 0.0;
    for (int i = 0; i < 3; ++i) constant += kb[i] * kept(l.x_g() + 3 + i);
    alignas(64) const double row[8] = {0, 0, 0, kb[0], kb[1], kb[2], 0, constant};
    Y[k] += row_load(row);
    for (int j = 0; j < nq; ++j)
      for (int i = 0; i < 3; ++i) D[k][j] += kb[i] * right(j, 3 + i);
  }
  if constexpr (nq == 1) {
    D_inverse[0][0] = 1.0 / D[0][0];
    Y[0] = D_inverse[0][0] * Y[0];
  } else if constexpr (nq > 1) {
    if (!invert<nq>(D, D_inverse)) return false;
    Row fresh[nq];
    for (int k = 0; k < nq; ++k) {
      fresh[k] = D_inverse[k][0] * Y[0];
      for (int j = 1; j < nq; ++j) fresh[k] += D_inverse[k][j] * Y[j];
    }
    for (int k = 0; k < nq; ++k) Y[k] = fresh[k];
  }
  RowData* y = v.Y + v.y_row[slot];
  for (int k = 0; k < nq; ++k) row_store(y[k], Y[k]);

  const int open = v.first_open[slot + 1] - v.first_open[slot];
  if (v.parent[slot] < 0 && open == 0) return true;
  const double c_l[3] = {s.c_l[0][lane], s.c_l[1][lane], s.c_l[2][lane]};
  shift_rows(c_l, M);
  if constexpr (nq > 1) shift_rows(c_l, N);
  if (edge)
    for (int i = 0; i < 6; ++i) {
      const double* K = edge->K_pb[i];
      Row KX = row_load(K);
      for (int j = 0; j < 6; ++j) KX += K[j] * T[j];
      M[i] += KX;
      if constexpr (nq > 1)
        for (int j = 0; j < 6; ++j) N[i] += K[j] * Sr[j];
    }
  if constexpr (S::sliding)
    for (int i = 0; i < 3; ++i) {
      alignas(64) double slide[8] = {};
      for (int k = 0; k < S::taus; ++k) slide[nq == 1 ? 6 : k] = s.F_tau[k][i][lane];
      if constexpr (nq == 1) {
        slide[7] = s.F_t[i][lane];
        M[3 + i] += row_load(slide);
      } else {
        N[3 + i] += row_load(slide);
        M[3 + i] += s.F_t[i][lane] * unit(7);
      }
    }
  double P[6][nq > 0 ? nq : 1];  // X_lᵀ A S_r + K_pb S_r
  for (int i = 0; i < 6; ++i)
    for (int k = 0; k < nq; ++k) P[i][k] = nq == 1 ? M[i][6] : N[i][k];
  if (open > 0) {
    double S_l[nq > 0 ? nq : 1][6], S_r[nq > 0 ? nq : 1][6], x_g[6], c_r[3];
    for (int k = 0; k < nq; ++k)
      for (int i = 0; i < 6; ++i) {
        S_l[k][i] = left(k, i);
        S_r[k][i] = right(k, i);
      }
    for (int i = 0; i < 6; ++i) x_g[i] = kept(l.x_g() + i);
    for (int i = 0; i < 3; ++i) c_r[i] = kept(l.c_r() + i);
    carry_loops<nq>(v, slot, &S_l[0][0], &S_r[0][0], x_g, c_l, c_r, &P[0][0], &D_inverse[0][0], Y);
  }
  if (v.parent[slot] < 0) return true;
  for (int i = 0; i < 6; ++i)
    if constexpr (nq == 1)
      M[i] -= multiply(spread<6>(M[i]), Y[0]);
    else
      for (int k = 0; k < nq; ++k) M[i] -= P[i][k] * Y[k];
  give_to_parent(v, slot, lane, s, M);
  return true;
}

/// Eliminates a free body: six directions, no parent.
inline bool eliminate_root(const TreeView& v, int slot, int lane, const BlockScratch& s) {
  if (v.first_common[slot] != v.first_common[slot + 1] && !eliminate_common_loops(v, slot))
    return false;
  Row A[6], Y[6];
  collect_rows(v, slot, lane, s, A);
  alignas(64) double D_inverse[6][8];
  asm volatile("" ::: "memory");
  if (!invert<6>(v.body[slot].A, D_inverse)) return false;
  RowData* y = v.Y + v.y_row[slot];
  for (int k = 0; k < 6; ++k) {
    Y[k] = D_inverse[k][0] * A[0];
    for (int j = 1; j < 6; ++j) Y[k] += D_inverse[k][j] * A[j];
    for (int j = 0; j < 6; ++j) Y[k] -= Y[k][j] * unit(j);  // no parent: only the right-hand side
    row_store(y[k], Y[k]);
  }
  if (v.first_open[slot] == v.first_open[slot + 1]) return true;
  double unit6[6][6] = {}, P[6][6] = {};
  const double zero[6] = {};
  for (int k = 0; k < 6; ++k) unit6[k][k] = 1.0;
  carry_loops<6>(v, slot, &unit6[0][0], &unit6[0][0], zero, zero, zero, &P[0][0], &D_inverse[0][0],
                 Y);
  return true;
}

/// Shape of a root, which has no joint.
struct RootShape {
  static constexpr JointLayout layout{0, 0};
  static constexpr int free = 6;
};

/// Increment of a body from its parent's, and A Δx − ρ. Loops are already solved.
template <class S>
void back_substitute(const TreeView& v, int slot, int lane, double* wrench) {
  constexpr int nq = S::free;
  constexpr JointLayout l = S::layout;
  EliminatedBody& e = v.body[slot];
  const double* x_a = v.parent[slot] < 0 ? v.body[v.blocks * kLanes].X : v.body[v.parent[slot]].X;
  const RowData* y = v.Y + v.y_row[slot];
  const bool open = v.first_open[slot + 1] != v.first_open[slot];
  const double* data = l.root() ? nullptr : v.joint_data + v.joint[slot / kLanes] + lane;
  const auto kept = [&](int field) { return data[8 * field]; };
  double x[6], q[nq > 0 ? nq : 1];
  const auto from_parent = [&] {  // X_r x_a + x_g
    const double cx = kept(l.c_r()), cy = kept(l.c_r() + 1), cz = kept(l.c_r() + 2);
    x[0] = x_a[0] + (x_a[4] * cz - x_a[5] * cy) + kept(l.x_g());
    x[1] = x_a[1] + (x_a[5] * cx - x_a[3] * cz) + kept(l.x_g() + 1);
    x[2] = x_a[2] + (x_a[3] * cy - x_a[4] * cx) + kept(l.x_g() + 2);
    for (int i = 3; i < 6; ++i) x[i] = x_a[i] + kept(l.x_g() + i);
  };
  const auto turn_about_point = [&](const double* turn) {  // of a spherical joint
    const double zx = kept(l.z_b()), zy = kept(l.z_b() + 1), zz = kept(l.z_b() + 2);
    x[0] += zy * turn[2] - zz * turn[1];
    x[1] += zz * turn[0] - zx * turn[2];
    x[2] += zx * turn[1] - zy * turn[0];
  };
  if (S::layout.ball() && plain_ball(v, slot)) {
    // Δx of the point, without x_g: Δr_a + Δθ_a × arm, arm = c_r + z_b.
    double arm[3], p[3];
    for (int i = 0; i < 3; ++i) arm[i] = kept(l.c_r() + i) + kept(l.z_b() + i);
    p[0] = x_a[0] + (x_a[4] * arm[2] - x_a[5] * arm[1]);
    p[1] = x_a[1] + (x_a[5] * arm[0] - x_a[3] * arm[2]);
    p[2] = x_a[2] + (x_a[3] * arm[1] - x_a[4] * arm[0]);
    for (int k = 0; k < 3; ++k) {
      x[k] = p[k] + kept(l.x_g() + k);
      x[3 + k] = -((y[k][0] * p[0] + y[k][1] * p[1]) + (y[k][2] * p[2] + y[k][7]));
    }
    turn_about_point(x + 3);
  } else {
    for (int k = 0; k < nq; ++k) {
      const double* Y = y[k];
      q[k] = -(((Y[0] * x_a[0] + Y[1] * x_a[1]) + Y[2] * x_a[2]) +
               ((Y[3] * x_a[3] + Y[4] * x_a[4]) + Y[5] * x_a[5]) + Y[7]);
    }
    if (open) subtract_loops(v, slot, nq, q);
    if constexpr (l.root()) {
      for (int i = 0; i < 6; ++i) x[i] = q[i];
    } else if constexpr (l.ball()) {
      from_parent();
      for (int k = 0; k < 3; ++k) x[3 + k] += q[k];
      turn_about_point(q);
    } else {
      from_parent();
      for (int k = 0; k < nq; ++k)
        for (int i = 0; i < 6; ++i) x[i] += q[k] * kept(l.S_r() + 6 * k + i);
    }
  }
  for (int i = 0; i < 6; ++i) e.X[i] = x[i];
  e.X[6] = 0.0;
  e.X[7] = 1.0;
  const Row X = row_load(e.X);
  Row products[6];
  for (int i = 0; i < 6; ++i) products[i] = multiply(row_load(e.A[i]), X);
  row_store(wrench, row_sums(products));
  if (v.edge[slot] >= 0) {
    const EdgeRows& edge = v.edge_rows[v.edge[slot]];
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j) wrench[i] += edge.K_bp[i][j] * x_a[j];
  }
  if (open) add_loop_forces(v, slot, wrench);
  if (v.first_common[slot] != v.first_common[slot + 1]) solve_common_loops(v, slot);
}

/// Largest number of blocks of a chunk: its bodies, and a partly filled block for each shape.
inline constexpr int kChunkBlocks = kChunkBodies / kLanes + 16;

inline bool up(const TreeView* view, int* failed_slot) {
  const TreeView& v = *view;
  const bool rho1 = v.c == 2.0;
  assemble_all_loop_joints(v);
  static thread_local BlockScratch scratch[kChunkBlocks];
  for (int c = v.chunks - 1; c >= 0; --c) {
    const TreeChunk& chunk = v.chunk[c];
    const int first_block = v.run[chunk.first_run].first_block;
    for (int r = chunk.first_run; r < chunk.last_run; ++r) {
      const TreeRun& run = v.run[r];
      for (int b = run.first_block; b < run.first_block + run.blocks; ++b) {
        BlockScratch& s = scratch[b - first_block];
        if (run.shape == 0) {
          rho1 ? assemble_root_block<true>(v, b, s) : assemble_root_block<false>(v, b, s);
        } else {
          with_shape(run.shape, [&]<class S>() {
            rho1 ? assemble_block<S, true>(v, b, s) : assemble_block<S, false>(v, b, s);
          });
        }
      }
    }
    for (int i = chunk.last - 1; i >= chunk.first; --i) {
      const int slot = v.slot_in_order[i], lane = slot % kLanes;
      const BlockScratch& s = scratch[slot / kLanes - first_block];
      bool fine = true;
      if (v.shape[slot] == 0)
        fine = eliminate_root(v, slot, lane, s);
      else
        with_shape(v.shape[slot], [&]<class S>() { fine = eliminate<S>(v, slot, lane, s); });
      if (!fine) {
        *failed_slot = slot;
        return false;
      }
    }
  }
  for (int i = 0; i < v.ground_loops; ++i)
    if (!eliminate_loop(v, v.ground_loop[i])) {
      *failed_slot = -1;
      return false;
    }
  return true;
}

inline SweepResult down(const TreeView* view) {
  const TreeView& v = *view;
  for (int i = v.ground_loops - 1; i >= 0; --i) solve_loop(v, v.ground_loop[i]);
  static thread_local struct alignas(64) {
    double X[kChunkBlocks][8][8], X_a[kChunkBlocks][8][8], wrench[kChunkBlocks][8][8];
  } scratch;
  BlockMaxima most;
  for (int c = 0; c < v.chunks; ++c) {
    const TreeChunk& chunk = v.chunk[c];
    const int first_block = v.run[chunk.first_run].first_block;
    for (int r = chunk.first_run; r < chunk.last_run; ++r) {  // padding lanes stay at rest
      const int b = v.run[r].first_block + v.run[r].blocks - 1 - first_block;
      for (int lane = 0; lane < 8; ++lane)
        for (int i = 0; i < 8; ++i)
          scratch.X[b][lane][i] = scratch.X_a[b][lane][i] = scratch.wrench[b][lane][i] = 0.0;
    }
    for (int i = chunk.first; i < chunk.last; ++i) {
      const int slot = v.slot_in_order[i], lane = slot % kLanes, b = slot / kLanes - first_block;
      if (v.shape[slot] == 0)
        back_substitute<RootShape>(v, slot, lane, scratch.wrench[b][lane]);
      else
        with_shape(v.shape[slot],
                   [&]<class S>() { back_substitute<S>(v, slot, lane, scratch.wrench[b][lane]); });
      row_store(scratch.X[b][lane], row_load(v.body[slot].X));
      const double* x_a =
          v.parent[slot] < 0 ? v.body[v.blocks * kLanes].X : v.body[v.parent[slot]].X;
      row_store(scratch.X_a[b][lane], row_load(x_a));
    }
    for (int r = chunk.first_run; r < chunk.last_run; ++r) {
      const TreeRun& run = v.run[r];
      for (int block = run.first_block; block < run.first_block + run.blocks; ++block) {
        const int b = block - first_block;
        if (run.shape == 0)
          update_root_block(v, block, scratch.X[b], most);
        else
          with_shape(run.shape, [&]<class S>() {
            update_block<S>(v, block, scratch.X[b], scratch.X_a[b], scratch.wrench[b], most);
          });
      }
    }
  }
  move_all_loop_multipliers(v);
  return {largest(most.increment), largest(most.rotation)};
}

inline void check(const TreeView* view, const int* body_of_slot, LaneCheck* result) {
  const TreeView& v = *view;
  for (int c = 0; c < v.chunks; ++c)
    for (int r = v.chunk[c].first_run; r < v.chunk[c].last_run; ++r) {
      const TreeRun& run = v.run[r];
      if (run.shape == 0) continue;
      for (int b = run.first_block; b < run.first_block + run.blocks; ++b)
        with_shape(run.shape, [&]<class S>() { check_block<S>(v, body_of_slot, b, *result); });
    }
  check_all_loop_joints(v, *result);
}

/// Sum over blocks with a joint to the ground.
inline void ground(const TreeView* view, const int* body_of_slot, double* force, double* moment) {
  const TreeView& v = *view;
  for (int c = 0; c < v.chunks; ++c)
    for (int r = v.chunk[c].first_run; r < v.chunk[c].last_run; ++r) {
      const TreeRun& run = v.run[r];
      if (run.shape == 0) continue;
      for (int b = run.first_block; b < run.first_block + run.blocks; ++b) {
        bool any = false;
        for (int i = 0; i < kLanes; ++i)
          any = any || (body_of_slot[b * kLanes + i] >= 0 && v.parent[b * kLanes + i] < 0);
        if (!any) continue;
        with_shape(run.shape,
                   [&]<class S>() { ground_block<S>(v, body_of_slot, b, force, moment); });
      }
    }
}

}  // namespace polhode::POLHODE_ISA
