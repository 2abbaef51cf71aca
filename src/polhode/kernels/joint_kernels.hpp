// SPDX-License-Identifier: Apache-2.0
// Residual and tangent of bodies and of the joints to their parents, kWidth at a time, and the
// update of multipliers and configuration. Derivation: docs/theory/elimination_along_the_tree.md.
//
// Names: a is the parent, b the child. f is the joint's force on b, z_b its lever arm, "arm" that
// on a. F = s f with s = βΔt² α_f / m_ref. "_al" is t_{n+αf}; no suffix is t_{n+1}.
#pragma once

#include <polhode/kernels/body_kernels.hpp>
#include <polhode/kernels/joint_geometry.hpp>

namespace polhode::POLHODE_ISA {

/// Output of assembly for the elimination of a block of eight bodies.
struct alignas(64) BlockScratch {
  double T[3][8][8];         ///< Row i of [X_r | S_r | x_g], i = 0..2, of each body;
                             ///< for a spherical joint of [0 | ẑ_b | · | x_g].
  double arm_rows[3][8][8];  ///< Row i of [0 | −arm^ | · | ·]: spherical joints.
  double F_rows[8][8];       ///< [0 | F | · | ·] of each body.
  double k_rows[8][8];       ///< k_a of one free direction, likewise.
  double theta[3][8][8];     ///< Rows of the body's own moment balance [0 | A | 0 | −ρ].
  double S_rows[6][8][8];    ///< Row i of S_r padded to 8, two or more free directions.
  Lane mass;                 ///< α_m m / m_ref: the translational diagonal.
  double rhs[3][8];          ///< −ρ of the force balance.
  double arm[3][8];          ///< Lever arm on the parent at t_{n+1}.
  double F_dot_arm[8];
  double c_l[3][8];               ///< Lever of X_l.
  double arm_l[3][8], z_l[3][8];  ///< Its lever arms on both bodies: spherical joints.
  double S_l[6][6][8];            ///< Left free directions [direction][component].
  double k_a[6][3][8];    ///< Geometric stiffness of the projected rows, on Δθ of the parent.
  double k_b[3][8];       ///< The same on Δθ of the body (universal shape's second rotation).
  double F_tau[3][3][8];  ///< −F × τ of the sliding directions.
  double F_t[3][8];       ///< F × t.
};

/// Momentum rates and gravity of a block. @eq{eq:ga-residual-vector} @eq{ga-K-momentum}
template <bool kRho1>
POLHODE_INLINE void assemble_inertia(const TreeView& v, int block, int at, P3* rows, P3& rhs_theta,
                                     BlockScratch& s) {
  const BodyBlock& n = v.state[block];
  const TrialBlock& t = v.trial[block];
  const MassBlock& m = v.mass[block];
  const double dt = v.dt;
  const PM L = load9(t.Lambda, at);
  const P3 theta = load3(t.theta, at), u = load3(t.u, at);
  const P3 Theta = transposed_times(load9(t.Lambda_n, at), theta);
  const P3 v_n = load3(n.v, at), W_n = load3(n.W, at);
  P3 W, acceleration;
  if constexpr (kRho1) {
    W = (2.0 / dt) * Theta - W_n;
    acceleration = (2.0 / dt) * ((1.0 / dt) * u - v_n);
  } else {
    const P3 a_n = load3(n.a, at);
    W = (v.c / dt) * Theta + (1.0 - v.c) * W_n + (dt * v.c_A) * load3(n.A, at);
    acceleration =
        v.kappa * ((v.c / dt) * ((1.0 / dt) * u - v_n) + v.c_A * a_n) + (1.0 - v.kappa) * a_n;
  }
  const P3 h = L * inertia_times(m, at, W);
  P3 h_dot = (v.kappa / dt) * (h - load3(t.h_n, at));
  if constexpr (!kRho1) h_dot = h_dot + (1.0 - v.kappa) * load3(n.h_dot, at);

  const Pack mass = load(m.mass + at);
  for (int i = 0; i < 3; ++i)
    store(s.rhs[i] + at, v.scale * (mass * (acceleration[i] - v.gravity[i])));
  store(s.mass + at, (v.alpha_m * v.inverse_mass) * mass);
  rhs_theta = v.scale * h_dot;

  // α_m/m_ref (J T(θ) − βΔt/γ ĥ), J = Λ J_r Λᵀ
  PM LJ, J;
  const Pack xx = load(m.J[0] + at), yy = load(m.J[1] + at), zz = load(m.J[2] + at);
  const Pack xy = load(m.J[3] + at), xz = load(m.J[4] + at), yz = load(m.J[5] + at);
  for (int i = 0; i < 3; ++i) {
    const Pack x = L[3 * i], y = L[3 * i + 1], z = L[3 * i + 2];
    LJ[3 * i] = x * xx + y * xy + z * xz;
    LJ[3 * i + 1] = x * xy + y * yy + z * yz;
    LJ[3 * i + 2] = x * xz + y * yz + z * zz;
  }
  for (int i = 0; i < 3; ++i)
    for (int j = i; j < 3; ++j)
      J[3 * i + j] = J[3 * j + i] =
          LJ[3 * i] * L[3 * j] + LJ[3 * i + 1] * L[3 * j + 1] + LJ[3 * i + 2] * L[3 * j + 2];
  const P3 J_theta = J * theta;
  const double k = v.alpha_m * v.inverse_mass, k_h = k * v.beta * dt / v.gamma;
  for (int i = 0; i < 3; ++i) {
    const P3 row = {J[3 * i], J[3 * i + 1], J[3 * i + 2]};
    rows[i] = k * (row + 0.5 * cross(row, theta) + (0.25 * J_theta[i]) * theta);
  }
  rows[0][1] += k_h * h[2];
  rows[0][2] -= k_h * h[1];
  rows[1][0] -= k_h * h[2];
  rows[1][2] += k_h * h[0];
  rows[2][0] += k_h * h[1];
  rows[2][1] -= k_h * h[0];
}

POLHODE_INLINE void put_theta_rows(const P3* rows, const P3& rhs, int at, BlockScratch& s) {
  for (int i = 0; i < 3; ++i) {
    const Pack columns[8] = {Pack{},     Pack{},     Pack{}, rows[i][0],
                             rows[i][1], rows[i][2], Pack{}, rhs[i]};
    to_rows(columns, s.theta[i][at]);
  }
}

/// Rows [0 | ẑ | · | x].
POLHODE_INLINE void put_hat_rows(const P3& z, const P3& x, int at, double (*rows)[8][8]) {
  for (int i = 0; i < 3; ++i) {
    Pack columns[8] = {Pack{}, Pack{}, Pack{}, Pack{}, Pack{}, Pack{}, Pack{}, x[i]};
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    columns[3 + j] = -z[k];
    columns[3 + k] = z[j];
    to_rows(columns, rows[i][at]);
  }
}
/// Rows [0 | x | · | ·].
POLHODE_INLINE void put_vector_rows(const P3& x, int at, double (*rows)[8]) {
  const Pack columns[8] = {Pack{}, Pack{}, Pack{}, x[0], x[1], x[2], Pack{}, Pack{}};
  to_rows(columns, rows[at]);
}

template <class S, bool kRho1>
void assemble_block(const TreeView& v, int block, BlockScratch& s) {
  constexpr JointLayout l = S::layout;
  double* data = v.joint_data + v.joint[block];
  const double weight = v.alpha_f, stiffness = v.scale * v.alpha_f;
  for (int at = 0; at < kLanes; at += kWidth) {
    P3 rows[3], rhs_theta;
    assemble_inertia<kRho1>(v, block, at, rows, rhs_theta, s);
    if (v.first_iteration)
      joint_at_n<S>(data, at, parents_at_n(v, block, at), bodies_at_n(v, block, at));
    const JointGeometry<S> q = tree_joint<S>(v, block, at);
    const auto average = [&](int field, const P3& at_n1) {
      return (1.0 - weight) * get3(data, field, at) + weight * at_n1;
    };
    const P3 arm_al = average(l.arm_a_n(), q.arm), z_b_al = average(l.arm_b_n(), q.z_b);
    P3 director_al[S::directors > 0 ? S::directors : 1], slide_al[2];
    for (int i = 0; i < S::directors; ++i) {
      director_al[i] = average(l.director_n() + 3 * i, q.director[i]);
      put3(data, l.director_alpha() + 3 * i, at, director_al[i]);
      put3(data, l.director_n1() + 3 * i, at, q.director[i]);
    }
    for (int i = 0; i < S::slides; ++i) {
      slide_al[i] = average(l.slide_n() + 3 * i, q.slide[i]);
      put3(data, l.slide_alpha() + 3 * i, at, slide_al[i]);
      put3(data, l.slide_n1() + 3 * i, at, q.slide[i]);
    }
    Pack lambda[6];
    for (int i = 0; i < S::T + S::ND; ++i) lambda[i] = load(data + 8 * (l.lambda() + i) + at);

    // The joint's force rotates with its lever arms: rows of b here, rows of a when b is
    // eliminated.
    P3 f = {Pack{}, Pack{}, Pack{}};
    if constexpr (S::T == 3) f = {lambda[0], lambda[1], lambda[2]};
    if constexpr (S::sliding)
      for (int i = 0; i < S::T; ++i) f = f + lambda[i] * slide_al[i];
    const P3 F = stiffness * f;
    if constexpr (S::T > 0) {
      const Pack along = dot(F, q.z_b);
      for (int i = 0; i < 3; ++i) {
        rows[i] = rows[i] - q.z_b[i] * F;
        rows[i][i] += along;
      }
    }
    put_theta_rows(rows, rhs_theta, at, s);
    put_vector_rows(F, at, s.F_rows);
    store3(s.arm, at, q.arm);
    store(s.F_dot_arm + at, dot(F, q.arm));

    // x_g = [z_b × w − t; w] satisfies the joint's rows.
    const P3 w = direction_correction<S>(q.director, q.g + S::T);
    P3 t = {Pack{}, Pack{}, Pack{}};
    if constexpr (S::T == 3) t = q.u;
    if constexpr (S::T == 2) t = q.g[0] * q.slide[0] + q.g[1] * q.slide[1];
    if constexpr (S::T == 1) t = (q.g[0] / dot(q.slide[0], q.slide[0])) * q.slide[0];
    const P3 x_r = cross(q.z_b, w) - t;
    put3(data, l.x_g(), at, x_r);
    put3(data, l.x_g() + 3, at, w);
    const P3 c_r = q.arm - q.z_b;
    put3(data, l.c_r(), at, c_r);
    put3(data, l.arm_b_alpha(), at, z_b_al);
    store3(s.c_l, at, arm_al - z_b_al);
    if constexpr (S::ball) {
      store3(s.arm_l, at, arm_al);
      store3(s.z_l, at, z_b_al);
      put3(data, l.z_b(), at, q.z_b);
      put_hat_rows(q.z_b, x_r, at, s.T);
      put_hat_rows(-1.0 * q.arm, {Pack{}, Pack{}, Pack{}}, at, s.arm_rows);
      continue;
    }

    // Free directions, right at t_{n+1} and left at t_{n+αf}.
    P3 S_r[S::free > 0 ? S::free : 1][2];
    for (int k = 0; k < S::taus; ++k) {
      const P3 right = tau<S>(q.slide, k), left = tau<S>(slide_al, k);
      S_r[k][0] = right;
      S_r[k][1] = {Pack{}, Pack{}, Pack{}};
      for (int i = 0; i < 3; ++i) {
        store(s.S_l[k][i] + at, left[i]);
        store(s.S_l[k][3 + i] + at, Pack{});
      }
      P3 k_a = {Pack{}, Pack{}, Pack{}};
      if constexpr (S::sliding)
        for (int i = 0; i < S::T; ++i)
          k_a = k_a + (stiffness * lambda[i]) * cross(left, q.slide[i]);
      store3(s.k_a[k], at, k_a);
      if constexpr (S::sliding) store3(s.F_tau[k], at, cross(right, F));
    }
    if constexpr (S::sliding) store3(s.F_t, at, cross(F, t));
    P3 m = {Pack{}, Pack{}, Pack{}};
    for (int i = 0; i < S::ND; ++i)
      m = m + lambda[S::T + i] * cross(director_al[S::left(i)], director_al[S::right(i)]);
    for (int k = 0; k < S::omegas; ++k) {
      const P3 right = axis<S>(q.director, k), left = axis<S>(director_al, k);
      const P3 arm_left = cross(z_b_al, left);
      S_r[S::taus + k][0] = cross(q.z_b, right);
      S_r[S::taus + k][1] = right;
      for (int i = 0; i < 3; ++i) {
        store(s.S_l[S::taus + k][i] + at, arm_left[i]);
        store(s.S_l[S::taus + k][3 + i] + at, left[i]);
      }
      P3 k_a = {Pack{}, Pack{}, Pack{}};
      if constexpr (S::ND == 2) k_a = stiffness * cross(m, right);
      if constexpr (S::ND == 1) {
        const P3 turn = stiffness * cross(m, right);
        if (k == 0) k_a = turn;
        if (k == 1) store3(s.k_b, at, turn);
      }
      store3(s.k_a[S::taus + k], at, k_a);
      if constexpr (S::free == 1) put_vector_rows(k_a, at, s.k_rows);
    }
    if constexpr (S::free == 1 && S::taus == 1) put_vector_rows(load3(s.k_a[0], at), at, s.k_rows);
    for (int k = 0; k < S::free; ++k) {
      put3(data, l.S_r() + 6 * k, at, S_r[k][0]);
      put3(data, l.S_r() + 6 * k + 3, at, S_r[k][1]);
    }

    // Rows 0..2 of [X_r | S_r | x_g], X_r = [I, −ĉ; 0, I]; the unit part is left out.
    const Pack zero = Pack{};
    const Pack minus_hat[3][3] = {
        {zero, c_r[2], -c_r[1]}, {-c_r[2], zero, c_r[0]}, {c_r[1], -c_r[0], zero}};
    for (int i = 0; i < 3; ++i) {
      const Pack columns[8] = {zero,
                               zero,
                               zero,
                               minus_hat[i][0],
                               minus_hat[i][1],
                               minus_hat[i][2],
                               S::free == 1 ? S_r[0][0][i] : zero,
                               x_r[i]};
      to_rows(columns, s.T[i][at]);
    }
    if constexpr (S::free > 1)
      for (int i = 0; i < 6; ++i) {
        Pack columns[8] = {zero, zero, zero, zero, zero, zero, zero, zero};
        for (int k = 0; k < S::free; ++k) columns[k] = S_r[k][i / 3][i % 3];
        to_rows(columns, s.S_rows[i][at]);
      }
  }
}

/// Rows of a free root: only its own balance.
template <bool kRho1>
void assemble_root_block(const TreeView& v, int block, BlockScratch& s) {
  for (int at = 0; at < kLanes; at += kWidth) {
    P3 rows[3], rhs_theta;
    assemble_inertia<kRho1>(v, block, at, rows, rhs_theta, s);
    put_theta_rows(rows, rhs_theta, at, s);
  }
}

/// Largest increments and rotations over a block.
struct BlockMaxima {
  Pack increment{}, rotation{};
};

POLHODE_INLINE void move_bodies(const TreeView& v, int block, int at, P3 dr, P3 dtheta,
                                BlockMaxima& most) {
  TrialBlock& t = v.trial[block];
  for (int i = 0; i < 3; ++i) {
    most.increment = max_keeping_nan(most.increment, v.inverse_length * abs(dr[i]));
    most.increment = max_keeping_nan(most.increment, abs(dtheta[i]));
  }
  if (v.damping != 1.0) {
    dr = v.damping * dr;
    dtheta = v.damping * dtheta;
  }
  const P3 u = load3(t.u, at) + dr, old = load3(t.theta, at);
  // θ of cay[Δθ] cay[θ]. @eq{eq:ga-Newton-iterations}
  const Pack part = 0.25 * dot(old, dtheta);
  const P3 theta = old + (1.0 / (1.0 - part)) * (dtheta + 0.5 * cross(dtheta, old) + part * old);
  most.rotation = max_keeping_nan(most.rotation, dot(theta, theta));
  store3(t.u, at, u);
  store3(t.theta, at, theta);
  store3(t.r, at, load3(v.state[block].r, at) + u);
  store9(t.Lambda, at, cayley_times(theta, load9(t.Lambda_n, at)));
}

/// Multipliers from the wrench on b, then the new configuration.
///
/// @param X  Increments by body: [Δr, Δθ, ..], rows of 8.
/// @param X_a  The parents' increments.
/// @param wrench  A Δx − ρ by body: the joint's wrench on b times s_c, without the stiffness of its
/// direction and slide rows.
template <class S>
void update_block(const TreeView& v, int block, const double (*X)[8], const double (*X_a)[8],
                  const double (*wrench)[8], BlockMaxima& most) {
  constexpr JointLayout l = S::layout;
  double* data = v.joint_data + v.joint[block];
  const double stiffness = v.scale * v.alpha_f;
  for (int at = 0; at < kLanes; at += kWidth) {
    Pack x[8], x_a[8], w[8];
    to_columns(X[at], x);
    to_columns(wrench[at], w);
    const P3 dr = {x[0], x[1], x[2]}, dtheta = {x[3], x[4], x[5]};
    const P3 f = {w[0], w[1], w[2]};
    P3 dtheta_a = {Pack{}, Pack{}, Pack{}};
    if constexpr (S::ND > 0 || S::sliding) {
      to_columns(X_a[at], x_a);
      dtheta_a = {x_a[3], x_a[4], x_a[5]};
    }
    P3 director_al[S::directors > 0 ? S::directors : 1], slide_al[2];
    Pack lambda[6], fresh[6];
    for (int i = 0; i < S::T + S::ND; ++i) lambda[i] = load(data + 8 * (l.lambda() + i) + at);
    if constexpr (S::T == 3)
      for (int i = 0; i < 3; ++i) fresh[i] = f[i];
    if constexpr (S::sliding) {
      P3 force = f;
      for (int i = 0; i < S::T; ++i) {
        slide_al[i] = get3(data, l.slide_alpha() + 3 * i, at);
        const P3 slide = get3(data, l.slide_n1() + 3 * i, at);
        force = force + (stiffness * lambda[i]) * cross(slide, dtheta_a);
      }
      if constexpr (S::T == 1) {
        fresh[0] = dot(force, slide_al[0]) / dot(slide_al[0], slide_al[0]);
      } else {
        const Pack a = dot(slide_al[0], slide_al[0]), b = dot(slide_al[0], slide_al[1]);
        const Pack c = dot(slide_al[1], slide_al[1]), k = 1.0 / (a * c - b * b);
        const Pack f0 = dot(force, slide_al[0]), f1 = dot(force, slide_al[1]);
        fresh[0] = k * (c * f0 - b * f1);
        fresh[1] = k * (a * f1 - b * f0);
      }
    }
    if constexpr (S::ND > 0) {
      P3 t = cross(get3(data, l.arm_b_alpha(), at), f) - P3{w[3], w[4], w[5]};
      P3 director[S::directors];
      for (int i = 0; i < S::directors; ++i) {
        director_al[i] = get3(data, l.director_alpha() + 3 * i, at);
        director[i] = get3(data, l.director_n1() + 3 * i, at);
      }
      for (int i = 0; i < S::ND; ++i) {
        const P3 &d_al = director_al[S::left(i)], &e_al = director_al[S::right(i)];
        const P3 &d = director[S::left(i)], &e = director[S::right(i)];
        t = t - (stiffness * lambda[S::T + i]) *
                    (cross(e_al, cross(d, dtheta_a)) - cross(d_al, cross(e, dtheta)));
      }
      direction_coefficients<S>(director_al, t, fresh + S::T);
    }
    const double unscale = 1.0 / v.scale;
    for (int i = 0; i < S::T + S::ND; ++i) {
      Pack value = unscale * fresh[i];
      if (v.damping != 1.0) value = lambda[i] + v.damping * (value - lambda[i]);
      store(data + 8 * (l.lambda() + i) + at, value);
    }
    move_bodies(v, block, at, dr, dtheta, most);
  }
}

inline void update_root_block(const TreeView& v, int block, const double (*X)[8],
                              BlockMaxima& most) {
  for (int at = 0; at < kLanes; at += kWidth) {
    Pack x[8];
    to_columns(X[at], x);
    move_bodies(v, block, at, {x[0], x[1], x[2]}, {x[3], x[4], x[5]}, most);
  }
}

}  // namespace polhode::POLHODE_ISA
