// SPDX-License-Identifier: Apache-2.0
// Bodies and joints at an instant, kWidth at a time: inertia, relative motions, rates of rows.
// Derivation: docs/theory/elimination_along_the_tree.md, "At an instant".
//
// Names as in joint_kernels.hpp: a is the parent, b the child.
#pragma once

#include <polhode/kernels/instant_data.hpp>
#include <polhode/kernels/loop_joints.hpp>

namespace polhode::POLHODE_ISA {

inline void place_at_instant(const InstantView* view, const BodyBlock* state) {
  for (int b = 0; b < view->blocks; ++b)
    for (int at = 0; at < kLanes; at += kWidth) {
      const BodyBlock& s = state[b];
      const MassBlock& m = view->mass[b];
      InstantBlock& to = view->motion[b];
      const PM L =
          rotation(load(s.q[0] + at), P3{load(s.q[1] + at), load(s.q[2] + at), load(s.q[3] + at)});
      store3(to.r, at, load3(s.r, at));
      store9(to.Lambda, at, L);
      store3(to.v, at, load3(s.v, at));
      store3(to.omega, at, L * load3(s.W, at));
      const Pack xx = load(m.J[0] + at), yy = load(m.J[1] + at), zz = load(m.J[2] + at);
      const Pack xy = load(m.J[3] + at), xz = load(m.J[4] + at), yz = load(m.J[5] + at);
      P3 LJ[3];
      for (int i = 0; i < 3; ++i) {
        const Pack x = L[3 * i], y = L[3 * i + 1], z = L[3 * i + 2];
        LJ[i] = {x * xx + y * xy + z * xz, x * xy + y * yy + z * yz, x * xz + y * yz + z * zz};
      }
      const auto J = [&](int i, int j) {
        return LJ[i][0] * L[3 * j] + LJ[i][1] * L[3 * j + 1] + LJ[i][2] * L[3 * j + 2];
      };
      const Pack entries[6] = {J(0, 0), J(1, 1), J(2, 2), J(0, 1), J(0, 2), J(1, 2)};
      for (int i = 0; i < 6; ++i) store(to.J[i] + at, entries[i]);
    }
}

/// A joint's side: placement and velocities.
struct Side {
  Placement at;
  P3 v, omega;
};

POLHODE_INLINE Side gather_side(const InstantView& view, const int* from) {
  const double* motion = reinterpret_cast<const double*>(view.motion);
  Side s;
  for (int i = 0; i < 3; ++i) s.at.r[i] = gather(motion + 8 * i, from);
  for (int i = 0; i < 9; ++i) s.at.L[i] = gather(motion + 8 * (3 + i), from);
  for (int i = 0; i < 3; ++i) s.v[i] = gather(motion + 8 * (12 + i), from);
  for (int i = 0; i < 3; ++i) s.omega[i] = gather(motion + 8 * (15 + i), from);
  return s;
}
POLHODE_INLINE Side own_side(const InstantView& view, int block, int at) {
  const InstantBlock& m = view.motion[block];
  return {{load3(m.r, at), load9(m.Lambda, at)}, load3(m.v, at), load3(m.omega, at)};
}

POLHODE_INLINE P3 unit_vector(int i) {
  P3 e = {Pack{}, Pack{}, Pack{}};
  e[i] = broadcast(1.0);
  return e;
}
/// Direction of a translation row.
template <class S>
POLHODE_INLINE P3 row_direction(const JointGeometry<S>& q, int i) {
  return S::T == 3 ? unit_vector(i) : q.slide[S::sliding ? i : 0];
}
POLHODE_INLINE Pack sizes(const P3& x, const P3& y) {
  return abs(x[0] * y[0]) + abs(x[1] * y[1]) + abs(x[2] * y[2]);
}

/// Rates G v of the rows. @param scale  Out: largest sum of magnitudes of the terms of one.
template <class S>
POLHODE_INLINE void row_rates(const JointGeometry<S>& q, const Side& a, const Side& b, Pack* rate,
                              Pack& scale) {
  for (int i = 0; i < S::T; ++i) {
    const P3 d = row_direction<S>(q, i), on_b = cross(q.z_b, d), on_a = cross(q.arm, d);
    rate[i] = dot(d, b.v - a.v) + dot(on_b, b.omega) - dot(on_a, a.omega);
    scale = max(scale, sizes(d, b.v) + sizes(d, a.v) + sizes(on_b, b.omega) + sizes(on_a, a.omega));
  }
  for (int i = 0; i < S::ND; ++i) {
    const P3 y = cross(q.director[S::left(i)], q.director[S::right(i)]);
    rate[S::T + i] = dot(y, a.omega - b.omega);
    scale = max(scale, sizes(y, a.omega) + sizes(y, b.omega));
  }
}

/// γ of the rows, G ẍ = −γ.
template <class S>
POLHODE_INLINE void row_velocity_terms(const JointGeometry<S>& q, const Side& a, const Side& b,
                                       Pack* gamma) {
  if constexpr (S::T > 0) {
    const P3 z_a = q.arm - (S::T == 3 ? P3{Pack{}, Pack{}, Pack{}} : q.u);
    const P3 turn_a = cross(a.omega, z_a), turn_b = cross(b.omega, q.z_b);
    const P3 between = cross(b.omega, turn_b) - cross(a.omega, turn_a);
    if constexpr (S::T == 3) {
      for (int i = 0; i < 3; ++i) gamma[i] = between[i];
    } else {
      const P3 rate = b.v + turn_b - a.v - turn_a;
      for (int i = 0; i < S::T; ++i) {
        const P3& d = q.slide[i];
        const P3 d_dot = cross(a.omega, d);
        gamma[i] = dot(d, between) + 2.0 * dot(d_dot, rate) + dot(cross(a.omega, d_dot), q.u);
      }
    }
  }
  for (int i = 0; i < S::ND; ++i) {
    const P3 &d = q.director[S::left(i)], &e = q.director[S::right(i)];
    const P3 d_dot = cross(a.omega, d), e_dot = cross(b.omega, e);
    gamma[S::T + i] =
        dot(cross(a.omega, d_dot), e) + 2.0 * dot(d_dot, e_dot) + dot(d, cross(b.omega, e_dot));
  }
}

/// Relative motions of the joints of a block, and T.
template <class S>
void assemble_joints_at_instant(const InstantView& view, int block) {
  const Pack zero{};
  InstantBody* body = view.body + block * kLanes;
  for (int at = 0; at < kLanes; at += kWidth) {
    const Side a = gather_side(view, view.gather + block * kLanes + at);
    const Side b = own_side(view, block, at);
    const JointGeometry<S> q =
        joint_geometry<S>(view.joint_data + view.joint[block], at, a.at, b.at);
    P3 linear[6], angular[6];
    const P3 none = {zero, zero, zero};
    for (int k = 0; k < S::taus; ++k) {
      linear[k] = tau<S>(q.slide, k);
      angular[k] = none;
    }
    for (int k = 0; k < S::omegas; ++k) {
      angular[S::taus + k] = axis<S>(q.director, k);
      linear[S::taus + k] = cross(q.z_b, angular[S::taus + k]);
    }
    for (int i = 0; i < S::T; ++i) {
      const P3 d = row_direction<S>(q, i);
      linear[S::free + i] = S::T == 1 ? (1.0 / dot(d, d)) * d : d;
      angular[S::free + i] = none;
    }
    for (int i = 0; i < S::ND; ++i) {
      Pack one[3] = {zero, zero, zero};
      one[i] = broadcast(1.0);
      const P3 w = direction_correction<S>(q.director, one);
      angular[S::free + S::T + i] = -1.0 * w;
      linear[S::free + S::T + i] = cross(w, q.z_b);
    }
    alignas(64) double rows[kWidth][8];
    for (int k = 0; k < 6; ++k) {
      const Pack columns[8] = {linear[k][0],  linear[k][1],  linear[k][2], angular[k][0],
                               angular[k][1], angular[k][2], zero,         zero};
      to_rows(columns, rows[0]);
      for (int i = 0; i < kWidth; ++i) row_store(body[at + i].B[k], row_load(rows[i]));
    }
    const P3 c = q.arm - q.z_b;
    const Pack minus_hat[3][3] = {{zero, c[2], -c[1]}, {-c[2], zero, c[0]}, {c[1], -c[0], zero}};
    for (int j = 0; j < 3; ++j) {
      const Pack columns[8] = {zero, zero, zero, minus_hat[j][0], minus_hat[j][1], minus_hat[j][2],
                               zero, zero};
      to_rows(columns, rows[0]);
      for (int i = 0; i < kWidth; ++i) row_store(body[at + i].T[j], row_load(rows[i]));
    }
  }
}

/// Gᵀ of the joints of a block where their loops begin.
template <class S>
void assemble_loop_joints_at_instant(const InstantView& view, const LoopJoints& block) {
  alignas(64) double rows_a[3][8][8], rows_b[3][8][8];
  for (int at = 0; at < kLanes; at += kWidth) {
    const Side a = gather_side(view, block.from_a + at), b = gather_side(view, block.from_b + at);
    const JointGeometry<S> q = joint_geometry<S>(view.loop_constants + block.data, at, a.at, b.at);
    P3 y_a[3] = {}, y_b[3] = {};
    for (int i = 0; i < S::ND; ++i) {
      y_a[i] = cross(q.director[S::left(i)], q.director[S::right(i)]);
      y_b[i] = -1.0 * y_a[i];
    }
    put_moment_rows(q.arm, -1.0, y_a, S::ND, at, rows_a);
    put_moment_rows(q.z_b, 1.0, y_b, S::ND, at, rows_b);
  }
  const auto put = [&](int pair, int lane, double sign, const double(*rows)[8][8]) {
    if (pair < 0) return;
    double* to = view.pair_rows + 8 * pair;
    for (int i = 0; i < 3; ++i) {
      row_store(to + 8 * i, sign * unit(i));
      row_store(to + 8 * (3 + i), row_load(rows[i][lane]));
    }
  };
  for (int lane = 0; lane < block.count; ++lane) {
    put(block.pair_a[lane], lane, -1.0, rows_a);
    put(block.pair_b[lane], lane, 1.0, rows_b);
  }
}

/// Calls f.template operator()<Shape>() for the shape of LoopJoints.
template <class F>
POLHODE_INLINE void with_shape_of(const LoopJoints& block, F&& f) {
  with_shape(12 + block.directions, f);
}

/// Calls f(block, at, shape's geometry, sides, store) for all tree joints and LoopJoints, where
/// store(rows) sets their values.
template <class F>
POLHODE_INLINE void for_each_joint_at_instant(const InstantView& view, F&& f) {
  for (int block = 0; block < view.blocks; ++block) {
    if (view.block_shape[block] == 0) continue;
    with_shape(view.block_shape[block], [&]<class S>() {
      for (int at = 0; at < kLanes; at += kWidth) {
        const Side a = gather_side(view, view.gather + block * kLanes + at);
        const Side b = own_side(view, block, at);
        Pack value[6] = {};
        f(joint_geometry<S>(view.joint_data + view.joint[block], at, a.at, b.at), a, b, value,
          kWidth);
        for (int i = 0; i < S::T + S::ND; ++i) store(view.lanes[block].value[i] + at, value[i]);
      }
    });
  }
  for (int k = 0; k < view.loop_blocks; ++k) {
    const LoopJoints& block = view.loop_joints[k];
    with_shape_of(block, [&]<class S>() {
      if constexpr (S::T == 3)
        for (int at = 0; at < block.count; at += kWidth) {
          const Side a = gather_side(view, block.from_a + at);
          const Side b = gather_side(view, block.from_b + at);
          Pack value[8] = {};
          f(joint_geometry<S>(view.loop_constants + block.data, at, a.at, b.at), a, b, value,
            block.count - at);
          alignas(64) double rows[kWidth][8];
          to_rows(value, rows[0]);
          for (int i = 0; i < kWidth && at + i < block.count; ++i)
            row_store(view.loop_data[block.nu[at + i]].value, row_load(rows[i]));
        }
    });
  }
}

inline void assemble_at_instant(const InstantView* view) {
  const InstantView& v = *view;
  for (int block = 0; block < v.blocks; ++block) {
    if (v.block_shape[block] == 0) continue;  // B of roots is constant
    with_shape(v.block_shape[block], [&]<class S>() { assemble_joints_at_instant<S>(v, block); });
  }
  for (int k = 0; k < v.loop_blocks; ++k)
    with_shape_of(v.loop_joints[k], [&]<class S>() {
      if constexpr (S::T == 3) assemble_loop_joints_at_instant<S>(v, v.loop_joints[k]);
    });
}

inline InstantRates rates_at_instant(const InstantView* view) {
  Pack most{}, scale{};
  for_each_joint_at_instant(*view, [&]<class S>(const JointGeometry<S>& q, const Side& a,
                                                const Side& b, Pack* value, int count) {
    Pack of_these{};
    row_rates<S>(q, a, b, value, of_these);
    for (int i = 0; i < S::T + S::ND; ++i) {
      Pack size = abs(value[i]);
      for (int lane = count; lane < kWidth; ++lane) size[lane] = 0.0;
      most = max_keeping_nan(most, size);
    }
    for (int lane = count; lane < kWidth; ++lane) of_these[lane] = 0.0;
    scale = max(scale, of_these);
  });
  return {largest(most), largest(scale)};
}

inline void velocity_terms_at_instant(const InstantView* view) {
  for_each_joint_at_instant(
      *view, [&]<class S>(const JointGeometry<S>& q, const Side& a, const Side& b, Pack* value,
                          int) { row_velocity_terms<S>(q, a, b, value); });
}

/// @eq{eq:rbm-linear-momentum-balance} @eq{eq:rbm-angular-momentum-balance}
inline void loads_at_instant(const InstantView* view) {
  for (int block = 0; block < view->blocks; ++block)
    for (int at = 0; at < kLanes; at += kWidth) {
      const InstantBlock& m = view->motion[block];
      const P3 w = load3(m.omega, at);
      const Pack xx = load(m.J[0] + at), yy = load(m.J[1] + at), zz = load(m.J[2] + at);
      const Pack xy = load(m.J[3] + at), xz = load(m.J[4] + at), yz = load(m.J[5] + at);
      const P3 h = {xx * w[0] + xy * w[1] + xz * w[2], xy * w[0] + yy * w[1] + yz * w[2],
                    xz * w[0] + yz * w[1] + zz * w[2]};
      const P3 gyroscopic = cross(h, w);
      const Pack mass = view->inverse_mass * load(view->mass[block].mass + at);
      const Pack columns[8] = {mass * view->gravity[0],
                               mass * view->gravity[1],
                               mass * view->gravity[2],
                               view->inverse_mass * gyroscopic[0],
                               view->inverse_mass * gyroscopic[1],
                               view->inverse_mass * gyroscopic[2],
                               Pack{},
                               Pack{}};
      alignas(64) double rows[kWidth][8];
      to_rows(columns, rows[0]);
      for (int i = 0; i < kWidth; ++i)
        row_store(view->body[block * kLanes + at + i].load, row_load(rows[i]));
    }
}

inline void add_velocities_at_instant(const InstantView* view, BodyBlock* state) {
  for (int block = 0; block < view->blocks; ++block)
    for (int at = 0; at < kLanes; at += kWidth) {
      InstantBlock& m = view->motion[block];
      BodyBlock& s = state[block];
      alignas(64) double rows[kWidth][8];
      for (int i = 0; i < kWidth; ++i)
        row_store(rows[i], row_load(view->body[block * kLanes + at + i].X));
      Pack x[8];
      to_columns(rows[0], x);
      const P3 v = {x[0], x[1], x[2]}, omega = {x[3], x[4], x[5]};
      store3(m.v, at, load3(m.v, at) + v);
      store3(m.omega, at, load3(m.omega, at) + omega);
      store3(s.v, at, load3(s.v, at) + v);
      store3(s.W, at, load3(s.W, at) + transposed_times(load9(m.Lambda, at), omega));
    }
}

}  // namespace polhode::POLHODE_ISA
