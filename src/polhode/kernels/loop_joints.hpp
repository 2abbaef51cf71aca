// SPDX-License-Identifier: Apache-2.0
// Loop joints with coincident points, kWidth at a time: their rows and columns, their contributions
// to the rows of their bodies, their multipliers and sums over them. Derivation:
// docs/theory/elimination_along_the_tree.md, "What the tree does not hold".
//
// Names as in joint_kernels.hpp. y_i = d_i × e_i are the directions of the couple's multipliers.
#pragma once

#include <polhode/kernels/joint_geometry.hpp>

namespace polhode::POLHODE_ISA {

/// Assembled data of eight loop joints, one row of eight numbers per joint: [row][joint]. Only
/// moment rows; those of forces are constant except for the force itself.
struct alignas(64) LoopScratch {
  double own_a[3][8][8], own_b[3][8][8];  ///< [0 | K | 0 | −ρ] of the bodies.
  double C_a[3][8][8], C_b[3][8][8];
  double R_a[3][8][8], R_b[3][8][8];  ///< Of the transposed rows.
  double S[3][8][8];                  ///< Rows of the couple.
  double nu[8][8];
  Lane3 force;  ///< s f.
};

/// Moment rows: sign × hat(z) in three columns, `directions` columns y after them.
POLHODE_INLINE void put_moment_rows(const P3& z, double sign, const P3* y, int directions, int at,
                                    double (*to)[8][8]) {
  const Pack zero{};
  for (int i = 0; i < 3; ++i) {
    Pack columns[8] = {zero, zero, zero, zero, zero, zero, zero, zero};
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    columns[j] = -sign * z[k];
    columns[k] = sign * z[j];
    for (int d = 0; d < directions; ++d) columns[3 + d] = y[d][i];
    to_rows(columns, to[i][at]);
  }
}

/// Joints of one shape. kCouple: between moving bodies, with direction rows; the couple is then the
/// unknown.
template <class S, bool kCouple>
void assemble_loop_joints(const TreeView& v, const LoopJoints& block, LoopScratch& s) {
  constexpr JointLayout l = S::layout;
  double* data = v.loop_data + block.data;
  const double weight = v.alpha_f, stiffness = v.scale * v.alpha_f;
  const Pack zero{};
  for (int at = 0; at < kLanes; at += kWidth) {
    if (v.first_iteration)
      joint_at_n<S>(data, at, gather_at_n(v, block.from_a + at), gather_at_n(v, block.from_b + at));
    const JointGeometry<S> q = joint_geometry<S>(data, at, gather_at_n1(v, block.from_a + at),
                                                 gather_at_n1(v, block.from_b + at));
    const auto average = [&](int field, const P3& at_n1) {
      return (1.0 - weight) * get3(data, field, at) + weight * at_n1;
    };
    const P3 z_a_al = average(l.arm_a_n(), q.arm), z_b_al = average(l.arm_b_n(), q.z_b);
    P3 director_al[S::directors > 0 ? S::directors : 1];
    for (int i = 0; i < S::directors; ++i) {
      director_al[i] = average(l.director_n() + 3 * i, q.director[i]);
      put3(data, l.director_alpha() + 3 * i, at, director_al[i]);
      put3(data, l.director_n1() + 3 * i, at, q.director[i]);
    }
    Pack lambda[6], nu[8] = {zero, zero, zero, zero, zero, zero, zero, zero};
    for (int i = 0; i < 3 + S::ND; ++i) {
      lambda[i] = gather(v.lambda + i, block.row + at);
      const Pack centre = gather(v.lambda_centre + i, block.row + at);
      nu[i] = q.g[i] + (v.proximal * v.scale) * (lambda[i] - centre);
    }
    to_rows(nu, s.nu[at]);

    // Wrenches at t_{n+αf}; forces rotate with their lever arms.
    const P3 f = {lambda[0], lambda[1], lambda[2]}, F = stiffness * f;
    P3 y_al[3], y[3], couple = {zero, zero, zero};
    for (int i = 0; i < S::ND; ++i) {
      y_al[i] = cross(director_al[S::left(i)], director_al[S::right(i)]);
      y[i] = cross(q.director[S::left(i)], q.director[S::right(i)]);
      couple = couple + lambda[3 + i] * y_al[i];
    }
    store3(s.force, at, v.scale * f);
    const P3 rho_a = v.scale * (cross(z_a_al, f) - couple);
    const P3 rho_b = v.scale * (couple - cross(z_b_al, f));
    P3 own_a[3], own_b[3];
    const Pack F_a = dot(F, q.arm), F_b = dot(F, q.z_b);
    for (int i = 0; i < 3; ++i) {
      own_a[i] = q.arm[i] * F;
      own_a[i][i] -= F_a;
      own_b[i] = -q.z_b[i] * F;
      own_b[i][i] += F_b;
    }
    if constexpr (!kCouple)  // on one body: the couple rotates with its directors
      for (int i = 0; i < S::ND; ++i) {
        const P3 &d = q.director[S::left(i)], &e = q.director[S::right(i)];
        const P3 &d_al = director_al[S::left(i)], &e_al = director_al[S::right(i)];
        const Pack L = stiffness * lambda[3 + i], a = L * dot(d, e_al), b = L * dot(d_al, e);
        for (int j = 0; j < 3; ++j) {
          own_a[j] = own_a[j] - (L * d[j]) * e_al;
          own_a[j][j] += a;
          own_b[j] = own_b[j] - (L * e[j]) * d_al;
          own_b[j][j] += b;
        }
      }
    for (int i = 0; i < 3; ++i) {
      const Pack a[8] = {zero, zero, zero, own_a[i][0], own_a[i][1], own_a[i][2], zero, rho_a[i]};
      const Pack b[8] = {zero, zero, zero, own_b[i][0], own_b[i][1], own_b[i][2], zero, rho_b[i]};
      to_rows(a, s.own_a[i][at]);
      to_rows(b, s.own_b[i][at]);
    }

    // Columns −B and rows G.
    P3 C_a[3], C_b[3], R_a[3], R_b[3];
    for (int i = 0; i < 3; ++i) C_a[i] = C_b[i] = R_a[i] = R_b[i] = {zero, zero, zero};
    if constexpr (kCouple) {
      // Rows of the couple M = Σ Δλ̂_i y_i + σ: softness of its multipliers, and w·(M − σ) = 0 for
      // each w normal to all y_i.
      P3 row[3];
      if constexpr (S::ND == 1) {
        row[0] = (v.proximal / dot(y_al[0], y_al[0])) * y_al[0];
        row[1] = director_al[0];
        row[2] = director_al[1];
      } else if constexpr (S::ND == 2) {
        const Pack k = v.proximal / dot(director_al[0], cross(director_al[1], director_al[2]));
        row[0] = k * director_al[2];
        row[1] = -k * director_al[1];
        row[2] = director_al[0];
      } else {
        const P3 y12 = cross(y_al[1], y_al[2]);
        const Pack k = v.proximal / dot(y_al[0], y12);
        row[0] = k * y12;
        row[1] = k * cross(y_al[2], y_al[0]);
        row[2] = k * cross(y_al[0], y_al[1]);
      }
      for (int i = 0; i < 3; ++i) {
        const Pack columns[8] = {zero, zero, zero, row[i][0], row[i][1], row[i][2], zero, zero};
        to_rows(columns, s.S[i][at]);
        C_a[i][i] = broadcast(-1.0);
        C_b[i][i] = broadcast(1.0);
      }
      for (int j = 0; j < S::ND; ++j) {
        R_a[j] = y[j];
        R_b[j] = -1.0 * y[j];
      }
      for (int j = S::ND; j < 3; ++j)
        for (int i = 0; i < S::ND; ++i) {
          const P3 &d = q.director[S::left(i)], &e = q.director[S::right(i)];
          const P3 &d_al = director_al[S::left(i)], &e_al = director_al[S::right(i)];
          const Pack L = stiffness * lambda[3 + i];
          R_a[j] = R_a[j] - L * cross(d, cross(e_al, row[j]));
          R_b[j] = R_b[j] + L * cross(e, cross(d_al, row[j]));
        }
    } else {
      for (int j = 0; j < S::ND; ++j) {
        C_a[j] = -1.0 * y_al[j];
        C_b[j] = y_al[j];
        R_a[j] = y[j];
        R_b[j] = -1.0 * y[j];
      }
    }
    constexpr int more = kCouple ? 3 : S::ND;
    put_moment_rows(z_a_al, 1.0, C_a, more, at, s.C_a);
    put_moment_rows(z_b_al, -1.0, C_b, more, at, s.C_b);
    put_moment_rows(q.arm, -1.0, R_a, more, at, s.R_a);
    put_moment_rows(q.z_b, 1.0, R_b, more, at, s.R_b);
  }
}

/// One side of a joint: its force and moment rows are added to the body's, its columns and rows
/// stored where the loop begins. `sign`: of the force on this body.
POLHODE_INLINE void put_side(const TreeView& v, int extra, int pair, int lane, double sign,
                             const Lane3& force, const double (*own)[8][8], const double (*C)[8][8],
                             const double (*R)[8][8]) {
  if (pair < 0) return;
  RowData* A = v.extra_rows[extra].A;
  double* to = v.pair_rows + 8 * pair;
  for (int i = 0; i < 3; ++i) {
    A[i][7] -= sign * force[i][lane];
    row_store(A[3 + i], row_load(A[3 + i]) + row_load(own[i][lane]));
    row_store(to + 8 * i, -sign * unit(i));
    row_store(to + 8 * (3 + i), row_load(C[i][lane]));
    row_store(to + 8 * (6 + i), sign * unit(i));
    row_store(to + 8 * (9 + i), row_load(R[i][lane]));
  }
}

/// Adds the assembled values to the loops and their bodies.
POLHODE_INLINE void scatter_loop_joints(const TreeView& v, const LoopJoints& block,
                                        const LoopScratch& s) {
  for (int lane = 0; lane < block.count; ++lane) {
    put_side(v, block.extra_a[lane], block.pair_a[lane], lane, -1.0, s.force, s.own_a, s.C_a,
             s.R_a);
    put_side(v, block.extra_b[lane], block.pair_b[lane], lane, 1.0, s.force, s.own_b, s.C_b, s.R_b);
    double* S = v.S + block.S[lane];
    const int plain = block.couple ? 3 : 3 + block.directions;
    for (int k = 0; k < plain; ++k) row_store(S + 8 * k, v.proximal * unit(k));
    if (block.couple)
      for (int k = 0; k < 3; ++k) row_store(S + 8 * (3 + k), row_load(s.S[k][lane]));
    row_store(v.nu + block.nu[lane], row_load(s.nu[lane]));
  }
}

/// New multipliers of a block from the solutions of the loops.
template <class S, bool kCouple>
void move_loop_multipliers(const TreeView& v, const LoopJoints& block) {
  constexpr JointLayout l = S::layout;
  const double* data = v.loop_data + block.data;
  const double stiffness = v.scale * v.alpha_f, unscale = v.damping / v.scale;
  alignas(64) double y_rows[8][8] = {}, x_a_rows[8][8] = {}, x_b_rows[8][8] = {};
  for (int lane = 0; lane < block.count; ++lane) {
    row_store(y_rows[lane], row_load(v.y + block.nu[lane]));
    if (!kCouple) continue;
    row_store(x_a_rows[lane], row_load(v.body[block.slot_a[lane]].X));
    row_store(x_b_rows[lane], row_load(v.body[block.slot_b[lane]].X));
  }
  for (int at = 0; at < kLanes; at += kWidth) {
    Pack fresh[8];
    to_columns(y_rows[at], fresh);
    if constexpr (kCouple) {
      Pack x_a[8], x_b[8];
      to_columns(x_a_rows[at], x_a);
      to_columns(x_b_rows[at], x_b);
      const P3 dtheta_a = {x_a[3], x_a[4], x_a[5]}, dtheta_b = {x_b[3], x_b[4], x_b[5]};
      P3 t = {fresh[3], fresh[4], fresh[5]}, director_al[S::directors], director[S::directors];
      for (int i = 0; i < S::directors; ++i) {
        director_al[i] = get3(data, l.director_alpha() + 3 * i, at);
        director[i] = get3(data, l.director_n1() + 3 * i, at);
      }
      for (int i = 0; i < S::ND; ++i) {  // M − σ
        const P3 &d_al = director_al[S::left(i)], &e_al = director_al[S::right(i)];
        const P3 &d = director[S::left(i)], &e = director[S::right(i)];
        t = t - (stiffness * gather(v.lambda + 3 + i, block.row + at)) *
                    (cross(e_al, cross(d, dtheta_a)) - cross(d_al, cross(e, dtheta_b)));
      }
      direction_coefficients<S>(director_al, t, fresh + 3);
    }
    for (int lane = 0; lane < kWidth && at + lane < block.count; ++lane)
      for (int i = 0; i < 3 + S::ND; ++i)
        v.lambda[block.row[at + lane] + i] += unscale * fresh[i][lane];
  }
}

/// Largest |g|, its row, Σ|λ g| and Σ|λ|(ℓ + |x|) of a block.
template <class S>
void check_loop_joints(const TreeView& v, const LoopJoints& block, LaneCheck& c) {
  const double* data = v.loop_data + block.data;
  const double length = 1.0 / v.inverse_length;
  for (int at = 0; at < kLanes; at += kWidth) {
    const Placement a = gather_at_n1(v, block.from_a + at), b = gather_at_n1(v, block.from_b + at);
    const JointGeometry<S> q = joint_geometry<S>(data, at, a, b);
    const P3 x = b.r + q.z_b;
    const Pack reach = length + abs(x[0]) + abs(x[1]) + abs(x[2]);
    Pack most{}, work{}, size{};
    for (int i = 0; i < 3 + S::ND; ++i) {
      const Pack lambda = abs(gather(v.lambda + i, block.row + at));
      most = max_keeping_nan(most, abs(q.g[i]));
      work += lambda * abs(q.g[i]);
      if (i < 3)
        size += lambda * reach;
      else
        size += lambda;
    }
    for (int i = 0; i < kWidth && at + i < block.count; ++i) {
      if (!(most[i] <= c.largest) && c.largest == c.largest) {
        c.largest = most[i];
        c.worst_slot = -1;
        c.worst_row = block.row[at + i];
      }
      c.work_defect += work[i];
      c.work_scale += size[i];
    }
  }
}

/// Calls f.template operator()<Shape, couple>() for a block.
template <class F>
POLHODE_INLINE void with_loop_shape(const LoopJoints& block, F&& f) {
  switch (2 * block.directions + (block.couple ? 1 : 0)) {
    case 0:
      return f.template operator()<Shape<3, 0>, false>();
    case 2:
      return f.template operator()<Shape<3, 1>, false>();
    case 3:
      return f.template operator()<Shape<3, 1>, true>();
    case 4:
      return f.template operator()<Shape<3, 2>, false>();
    case 5:
      return f.template operator()<Shape<3, 2>, true>();
    case 6:
      return f.template operator()<Shape<3, 3>, false>();
    default:
      return f.template operator()<Shape<3, 3>, true>();
  }
}

inline void assemble_all_loop_joints(const TreeView& v) {
  static thread_local LoopScratch scratch;
  for (int i = 0; i < v.loop_blocks; ++i) {
    const LoopJoints& block = v.loop_joints[i];
    with_loop_shape(block, [&]<class S, bool kCouple>() {
      assemble_loop_joints<S, kCouple>(v, block, scratch);
    });
    scatter_loop_joints(v, block, scratch);
  }
}

inline void move_all_loop_multipliers(const TreeView& v) {
  for (int i = 0; i < v.loop_blocks; ++i)
    with_loop_shape(v.loop_joints[i], [&]<class S, bool kCouple>() {
      move_loop_multipliers<S, kCouple>(v, v.loop_joints[i]);
    });
}

inline void check_all_loop_joints(const TreeView& v, LaneCheck& c) {
  for (int i = 0; i < v.loop_blocks; ++i)
    with_loop_shape(v.loop_joints[i],
                    [&]<class S, bool kCouple>() { check_loop_joints<S>(v, v.loop_joints[i], c); });
}

}  // namespace polhode::POLHODE_ISA
