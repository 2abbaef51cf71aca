// SPDX-License-Identifier: Apache-2.0
// Sums over the tree joints of a converged trial: constraint violations, ground reactions.
#pragma once

#include <polhode/kernels/joint_kernels.hpp>

namespace polhode::POLHODE_ISA {

/// Largest |g|, Σ|λ g| and Σ|λ|(ℓ + |x|) of a block's joints.
template <class S>
void check_block(const TreeView& v, const int* body_of_slot, int block, LaneCheck& c) {
  const double* data = v.joint_data + v.joint[block];
  const double length = 1.0 / v.inverse_length;
  for (int at = 0; at < kLanes; at += kWidth) {
    const JointGeometry<S> q = tree_joint<S>(v, block, at);
    const P3 r = load3(v.trial[block].r, at);
    const Pack reach = length + abs(r[0]) + abs(r[1]) + abs(r[2]);
    Pack most{}, work{}, size{};
    for (int i = 0; i < S::T + S::ND; ++i) {
      const Pack lambda = abs(load(data + 8 * (S::layout.lambda() + i) + at));
      most = max_keeping_nan(most, abs(q.g[i]));
      work += lambda * abs(q.g[i]);
      if (i < S::T)
        size += lambda * reach;
      else
        size += lambda;
    }
    for (int i = 0; i < kWidth; ++i) {
      if (body_of_slot[block * kLanes + at + i] < 0) continue;
      if (!(most[i] <= c.largest) && c.largest == c.largest) {
        c.largest = most[i];
        c.worst_slot = block * kLanes + at + i;
      }
      c.work_defect += work[i];
      c.work_scale += size[i];
    }
  }
}

/// Force and moment about the world's origin of joints to the ground at t_{n+αf}.
template <class S>
void ground_block(const TreeView& v, const int* body_of_slot, int block, double* force,
                  double* moment) {
  constexpr JointLayout l = S::layout;
  const double* data = v.joint_data + v.joint[block];
  const double weight = v.alpha_f;
  for (int at = 0; at < kLanes; at += kWidth) {
    const JointGeometry<S> q = tree_joint<S>(v, block, at);
    const auto average = [&](int field, const P3& at_n1) {
      return (1.0 - weight) * get3(data, field, at) + weight * at_n1;
    };
    Pack lambda[6];
    for (int i = 0; i < S::T + S::ND; ++i) lambda[i] = load(data + 8 * (l.lambda() + i) + at);
    P3 f = {Pack{}, Pack{}, Pack{}};
    if constexpr (S::T == 3) f = {lambda[0], lambda[1], lambda[2]};
    if constexpr (S::sliding)
      for (int i = 0; i < S::T; ++i) f = f + lambda[i] * average(l.slide_n() + 3 * i, q.slide[i]);
    P3 m = cross(average(l.arm_b_n(), q.z_b), f);
    for (int i = 0; i < S::ND; ++i) {
      const int d = S::left(i), e = S::right(i);
      m = m - lambda[S::T + i] * cross(average(l.director_n() + 3 * d, q.director[d]),
                                       average(l.director_n() + 3 * e, q.director[e]));
    }
    const P3 r = load3(v.state[block].r, at) + weight * load3(v.trial[block].u, at);
    m = m + cross(r, f);
    for (int i = 0; i < kWidth; ++i) {
      const int slot = block * kLanes + at + i;
      if (body_of_slot[slot] < 0 || v.parent[slot] >= 0) continue;
      for (int c = 0; c < 3; ++c) {
        force[c] += f[c][i];
        moment[c] += m[c][i];
      }
    }
  }
}

}  // namespace polhode::POLHODE_ISA
