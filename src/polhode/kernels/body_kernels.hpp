// SPDX-License-Identifier: Apache-2.0
// Predictor, end of the step and sums over bodies, kWidth bodies at a time.
#pragma once

#include <polhode/kernels/pack.hpp>
#include <polhode/kernels/tree_data.hpp>

namespace polhode::POLHODE_ISA {

/// cay[t] M = M + s (t × m + t × (t × m)/2) column by column, s = 1/(1 + t·t/4).
/// @eq{eq:ga-rotation-iterations}
POLHODE_INLINE PM cayley_times(const P3& t, const PM& M) {
  const Pack s = 1.0 / (1.0 + 0.25 * dot(t, t));
  PM R;
  for (int j = 0; j < 3; ++j) {
    const P3 m = {M[j], M[3 + j], M[6 + j]};
    const P3 w = cross(t, m), ww = cross(t, w);
    for (int i = 0; i < 3; ++i) R[3 * i + j] = m[i] + s * (w[i] + 0.5 * ww[i]);
  }
  return R;
}

/// Λ of a quaternion, orthogonal to rounding for any length: I + 2/(q·q) (w v̂ + v̂²).
POLHODE_INLINE PM rotation(Pack w, const P3& v) {
  const Pack s = 2.0 / (w * w + dot(v, v));
  const Pack x2 = s * v[0], y2 = s * v[1], z2 = s * v[2];
  const Pack xx = v[0] * x2, yy = v[1] * y2, zz = v[2] * z2;
  const Pack xy = v[0] * y2, xz = v[0] * z2, yz = v[1] * z2;
  const Pack wx = w * x2, wy = w * y2, wz = w * z2;
  return {{1.0 - (yy + zz), xy - wz, xz + wy, xy + wz, 1.0 - (xx + zz), yz - wx, xz - wy, yz + wx,
           1.0 - (xx + yy)}};
}

POLHODE_INLINE P3 inertia_times(const MassBlock& m, int at, const P3& W) {
  const Pack xx = load(m.J[0] + at), yy = load(m.J[1] + at), zz = load(m.J[2] + at);
  const Pack xy = load(m.J[3] + at), xz = load(m.J[4] + at), yz = load(m.J[5] + at);
  return {xx * W[0] + xy * W[1] + xz * W[2], xy * W[0] + yy * W[1] + yz * W[2],
          xz * W[0] + yz * W[1] + zz * W[2]};
}

inline void predict(const BodyBlock* state, const MassBlock* mass, TrialBlock* trial, int blocks,
                    double dt, const PredictWeights* weights) {
  for (int b = 0; b < blocks; ++b)
    for (int at = 0; at < kLanes; at += kWidth) {
      const BodyBlock& s = state[b];
      TrialBlock& t = trial[b];
      const P3 qv = {load(s.q[1] + at), load(s.q[2] + at), load(s.q[3] + at)};
      const PM L = rotation(load(s.q[0] + at), qv);
      const P3 W = load3(s.W, at);
      P3 mean_v = load3(s.v, at), mean_W = W;
      if (weights->count > 0) {
        mean_v = mean_W = {Pack{}, Pack{}, Pack{}};
        for (int k = 0; k < kPast; ++k) {
          const double w = weights->weight[k];
          if (w == 0.0) continue;
          mean_v = mean_v + w * load3(s.past_v[k], at);
          mean_W = mean_W + w * load3(s.past_W[k], at);
        }
      }
      const P3 u = dt * mean_v, theta = L * (dt * mean_W);
      store9(t.Lambda_n, at, L);
      store3(t.h_n, at, L * inertia_times(mass[b], at, W));
      store3(t.u, at, u);
      store3(t.theta, at, theta);
      store3(t.r, at, load3(s.r, at) + u);
      store9(t.Lambda, at, cayley_times(theta, L));
    }
}

/// @eq{eq:td-Newmark-COM} @eq{eq:td-Newmark-mrot} @eq{eq:ga-momenta-Newmark}
inline void commit(BodyBlock* state, const MassBlock* mass, const TrialBlock* trial, int blocks,
                   const TreeView* step, int ring) {
  const double dt = step->dt, beta = step->beta, gamma = step->gamma, c = step->c, c_A = step->c_A;
  const bool histories = c != 2.0;  // at ρ∞ = 1 stored accelerations have zero weight
  for (int b = 0; b < blocks; ++b)
    for (int at = 0; at < kLanes; at += kWidth) {
      BodyBlock& s = state[b];
      const TrialBlock& t = trial[b];
      const PM L_n = load9(t.Lambda_n, at);
      const P3 u = load3(t.u, at), theta = load3(t.theta, at);
      const P3 Theta = transposed_times(L_n, theta);
      const P3 v_n = load3(s.v, at), W_n = load3(s.W, at);
      const P3 mean_v = (1.0 / dt) * u, mean_W = (1.0 / dt) * Theta;
      P3 v = c * mean_v + (1.0 - c) * v_n, W = c * mean_W + (1.0 - c) * W_n;
      if (histories) {
        const P3 a_n = load3(s.a, at), A_n = load3(s.A, at);
        v = v + (dt * c_A) * a_n;
        W = W + (dt * c_A) * A_n;
        store3(s.a, at, (1.0 / (beta * dt)) * (mean_v - v_n) + (1.0 - 0.5 / beta) * a_n);
        store3(s.A, at, (1.0 / (beta * dt)) * (mean_W - W_n) + (1.0 - 0.5 / beta) * A_n);
        const P3 h = load9(t.Lambda, at) * inertia_times(mass[b], at, W);
        store3(s.h_dot, at,
               (1.0 / (gamma * dt)) * (h - load3(t.h_n, at)) +
                   (1.0 - 1.0 / gamma) * load3(s.h_dot, at));
      }
      store3(s.v, at, v);
      store3(s.W, at, W);
      store3(s.past_v[ring], at, mean_v);
      store3(s.past_W[ring], at, mean_W);

      for (int i = 0; i < 3; ++i) {  // Kahan: r_rest is the remaining correction, to be subtracted
        const Pack r = load(s.r[i] + at), add = u[i] - load(s.r_rest[i] + at), sum = r + add;
        store(s.r_rest[i] + at, (sum - r) - add);
        store(s.r[i] + at, sum);
      }
      // q_{n+1} = q(θ) q_n with q(θ) = (1, θ/2)/√(1 + θ²/4). @eq{ga-cay-as-exp}
      const Pack w_n = load(s.q[0] + at);
      const P3 q_n = {load(s.q[1] + at), load(s.q[2] + at), load(s.q[3] + at)};
      const P3 half = 0.5 * theta;
      const Pack w = w_n - dot(half, q_n);
      const P3 q = q_n + w_n * half + cross(half, q_n);
      const Pack shrink = 1.0 / sqrt(w * w + dot(q, q));
      store(s.q[0] + at, shrink * w);
      for (int i = 0; i < 3; ++i) store(s.q[1 + i] + at, shrink * q[i]);
    }
}

inline void sums(const BodyBlock* state, const MassBlock* mass, const int* body_of_slot, int blocks,
                 const double* gravity, BodySums* out) {
  const P3 zero = {Pack{}, Pack{}, Pack{}};
  Pack kinetic{}, potential{}, p_scale{}, l_scale{};
  P3 p = zero, l = zero, mr = zero;
  const P3 g = {broadcast(gravity[0]), broadcast(gravity[1]), broadcast(gravity[2])};
  for (int b = 0; b < blocks; ++b)
    for (int at = 0; at < kLanes; at += kWidth) {
      const BodyBlock& s = state[b];
      Pack m = load(mass[b].mass + at);
      for (int i = 0; i < kWidth; ++i)
        if (body_of_slot[b * kLanes + at + i] < 0) m[i] = 0.0;  // rotations are at rest there
      const PM L =
          rotation(load(s.q[0] + at), P3{load(s.q[1] + at), load(s.q[2] + at), load(s.q[3] + at)});
      const P3 W = load3(s.W, at), JW = inertia_times(mass[b], at, W), h = L * JW;
      const P3 v = load3(s.v, at), r = load3(s.r, at) - load3(s.r_rest, at);
      const P3 rp = m * cross(r, v);
      kinetic += 0.5 * (m * dot(v, v) + dot(W, JW));
      potential -= m * dot(g, r);
      p = p + m * v;
      mr = mr + m * r;
      l = l + rp + h;
      p_scale += m * sqrt(dot(v, v));
      l_scale += sqrt(dot(rp, rp)) + sqrt(dot(h, h));
    }
  out->kinetic = sum(kinetic);
  out->gravity_potential = sum(potential);
  out->p_scale = sum(p_scale);
  out->l_scale = sum(l_scale);
  for (int i = 0; i < 3; ++i) {
    out->p[i] = sum(p[i]);
    out->l[i] = sum(l[i]);
    out->mr[i] = sum(mr[i]);
  }
}

}  // namespace polhode::POLHODE_ISA
