// SPDX-License-Identifier: Apache-2.0
// One block of kWidth elements: from positions of nodes to forces and tangents.
// Included by the files kernels_*.cpp only.
#pragma once

#include <polhode/solids/elements/condensation.hpp>
#include <polhode/solids/elements/memory_kernel.hpp>

namespace polhode::solids {

/// Numbers of the nodes of a block, relative to `base` (packs) if there is one.
template <class P, int kNodes>
inline void gather(const int* nodes, const double* field, const double* base, P (*u)[3]) {
  constexpr int W = kWidth<P>;
  for (int a = 0; a < kNodes; ++a)
    for (int i = 0; i < 3; ++i) {
      P x;
      for (int l = 0; l < W; ++l) x[l] = field[3 * nodes[l * kNodes + a] + i];
      u[a][i] = base ? x - load<P>(base + (3 * a + i) * W) : x;
    }
}

/// State of a block at the beginning of an evaluation.
template <class P, int kKind>
struct Block {
  static constexpr ElementSizes kSizes = kElementSizes[kKind];
  static constexpr int N = kSizes.nodes, M = kSizes.enhanced, R = kSizes.rows();
  static constexpr int W = kWidth<P>;

  int number;
  const int* nodes;
  const double* points;
  int present;                     ///< Number of elements without padding.
  const double* fibres = nullptr;  ///< Directions: 3 packs by family.
  P u_0[R][3], u_1[R][3];          ///< Displacements of nodes, then enhanced modes.
  P v[R][3];                       ///< Velocities at t_{n+αf}; only with viscosity.

  Block(const ElementData& data, const ElementStep& step, int b, bool rates) : number(b) {
    nodes = data.nodes + static_cast<long>(b) * W * N;
    points = data.points + static_cast<long>(b) * W * kSizes.points * kSizes.point_packs();
    present = data.elements - b * W < W ? data.elements - b * W : W;
    const double* X = data.X + static_cast<long>(b) * W * 3 * N;
    gather<P, N>(nodes, step.x_n, X, u_0);
    gather<P, N>(nodes, step.x_n1, X, u_1);
    if (data.fibres) fibres = data.fibres + 3L * data.family_count * b * W;
    if (rates) {
      P v_1[N][3];
      gather<P, N>(nodes, step.v_n, nullptr, v);
      gather<P, N>(nodes, step.v_n1, nullptr, v_1);
      for (int a = 0; a < N; ++a)
        for (int i = 0; i < 3; ++i)
          v[a][i] = (1.0 - step.alpha_f) * v[a][i] + step.alpha_f * v_1[a][i];
    }
    if constexpr (M > 0) modes(step, rates);
  }

  [[nodiscard]] double* scratch(const ElementStep& step) const {
    return step.scratch + static_cast<long>(number) * W * kSizes.scratch();
  }
  [[nodiscard]] const double* point(int q) const {
    return points + static_cast<long>(q) * W * kSizes.point_packs();
  }
  [[nodiscard]] P weight(int q) const { return load<P>(point(q)); }
  [[nodiscard]] PointMemory<P> memory(const ElementData& data, int q) const {
    return {data, number * W, present, kSizes.points, q};
  }
  void gradients(int q, P* G) const {
    for (int i = 0; i < 3 * R; ++i) G[i] = load<P>(point(q) + (1 + i) * W);
  }

 private:
  /// Enhanced modes α at both ends, and their rate: that of the step, extrapolated to t_{n+αf} with
  /// the previous one.
  void modes(const ElementStep& step, bool rates) {
    constexpr int n = kSizes.modes();
    P before[n];
    for (int k = 0; k < n; ++k)
      for (int l = 0; l < W; ++l) {
        const int e = number * W + (l < present ? l : present - 1);
        const double* h = step.history + static_cast<long>(e) * kSizes.history();
        u_0[N + k / 3][k % 3][l] = h[k];
        before[k][l] = h[n + k];
      }
    for (int k = 0; k < n; ++k) {
      const P now = step.scratch ? load<P>(scratch(step) + k * W) : u_0[N + k / 3][k % 3];
      u_1[N + k / 3][k % 3] = now;
      if (!rates) continue;
      P rate = before[k];
      if (step.rate != 0.0) {
        const P mean = (now - u_0[N + k / 3][k % 3]) / step.dt;
        rate = mean + (step.alpha_f - 0.5) * (mean - before[k]);
      }
      v[N + k / 3][k % 3] = rate;
    }
  }
};

/// Displacement gradients of a point at the required times, and quantities derived from them.
template <class P>
struct PointMotion {
  P H_0[9], H_1[9], H_alpha[9];
  P E_0[6], E_1[6], E_alpha[6];
  P F_alpha[9];

  template <int R>
  void set(const P (*u_0)[3], const P (*u_1)[3], const P* G, double alpha_f, bool conserving) {
    displacement_gradient<P, R>(u_0, G, H_0);
    displacement_gradient<P, R>(u_1, G, H_1);
    for (int i = 0; i < 9; ++i) H_alpha[i] = (1.0 - alpha_f) * H_0[i] + alpha_f * H_1[i];
    add_identity(H_alpha, F_alpha);
    if (conserving) {
      green_strain(H_0, E_0);
      green_strain(H_1, E_1);
    } else {
      green_strain(H_alpha, E_alpha);
    }
  }
  [[nodiscard]] StressEnds<P> ends(double alpha_f, bool conserving) const {
    const auto volume = [](const P* H) {
      P F[9];
      add_identity(H, F);
      return determinant(F);
    };
    if (!conserving) {
      const P J = volume(H_alpha);
      return {E_alpha, E_alpha, J, J, 2.0};
    }
    const P J_1 = volume(H_1);
    if (alpha_f == 1.0) return {E_1, E_1, J_1, J_1, 2.0};
    return {E_0, E_1, volume(H_0), J_1, 1.0};
  }
};

/// Pressure of the mean dilatation of a block over a step.
template <class P>
struct MeanPressure {
  P p{}, geometric{};  ///< The latter extrapolated, for tangents of the mixed-point Newton.
  P slope{};           ///< ∂p/∂θ_1.

  /// @eq{solid-mean-dilatation}
  template <int kKind>
  MeanPressure(const ElementData& data, const ElementStep& step, const Block<P, kKind>& block) {
    using B = Block<P, kKind>;
    P sum_a{}, sum_b{}, volume{};
    for (int q = 0; q < B::kSizes.points; ++q) {
      P G[3 * B::R];
      block.gradients(q, G);
      PointMotion<P> m;
      m.template set<B::R>(block.u_0, block.u_1, G, step.alpha_f, data.conserving);
      const StressEnds<P> ends = m.ends(step.alpha_f, data.conserving);
      const P w = block.weight(q);
      volume += w;
      // J − 1 = (c − 1)/(J + 1): no cancellation.
      sum_a += w * Strain<P>(ends.E_a).s / (ends.J_a + 1.0);
      sum_b += w * Strain<P>(ends.E_b).s / (ends.J_b + 1.0);
    }
    const P tau_a = sum_a / volume, tau_b = sum_b / volume;
    const auto between = [&](const P& a, const P& b, P* value, P* derivative) {
      data.volume_kernel.pressure(data.bulk, numbers(&a), numbers(&b), numbers(value),
                                  numbers(derivative));
    };
    between(tau_a, tau_b, &p, &slope);
    const bool whole_step = data.conserving && step.alpha_f != 1.0;
    if (!whole_step) slope *= 2.0;
    if (whole_step && step.alpha_f != 0.5) {
      const double shift = step.alpha_f - 0.5;
      P p_0, p_1, slope_0, slope_1;
      between(tau_a, tau_a, &p_0, &slope_0);
      between(tau_b, tau_b, &p_1, &slope_1);
      p += shift * (p_1 - p_0);
      slope += 2.0 * shift * slope_1;
    }
    geometric = p;
    if (step.mixed_point && step.scratch) geometric = load<P>(block.scratch(step) + B::W);
  }
};

/// Forces of a block (on the solid's own nodes, tension positive) and records for the tangent.
template <class P, int kKind>
struct BlockForces {
  using B = Block<P, kKind>;
  static constexpr int R = B::R, Q = B::kSizes.points;
  static constexpr bool kMean = B::kSizes.mean_dilatation;

  P f[R][3]{};
  P least_volume = broadcast<P>(1.0);
  P a[kMean ? R : 1][3]{}, b[kMean ? R : 1][3]{};  ///< Σ w Bᵀ g: derivative of the mean dilatation.

  template <bool kTangent>
  void compute(const ElementData& data, const ElementStep& step, const B& block,
               const MeanPressure<P>* mean, PointRecord<P>* records) {
    const double alpha_f = step.alpha_f;
    for (int q = 0; q < Q; ++q) {
      const P w = block.weight(q);
      P G[3 * R];
      block.gradients(q, G);
      PointMotion<P> m;
      m.template set<R>(block.u_0, block.u_1, G, alpha_f, data.conserving);
      P F_1[9];
      add_identity(m.H_1, F_1);
      const P J = determinant(F_1);
      least_volume = J >= least_volume ? least_volume : J;
      const StressEnds<P> ends = m.ends(alpha_f, data.conserving);
      P S[6], D[36];
      stress_between<P>(data, block.fibres, !kMean, ends.E_a, ends.E_b, S, kTangent ? D : nullptr);
      if (kTangent && ends.factor != 1.0)
        for (P& entry : D) entry *= ends.factor;
      if (data.conserving && alpha_f != 0.5 && alpha_f != 1.0)
        add_shift<P>(data, block.fibres, !kMean, alpha_f - 0.5, m.E_0, m.E_1, S,
                     kTangent ? D : nullptr);
      if (data.memory_size > 0)
        add_memory<P>(data, step, block.fibres, block.memory(data, q), m.E_0, m.E_1, S,
                      kTangent ? D : nullptr);
      P S_geometric[6];
      P F_t[9];
      for (int i = 0; i < 9; ++i) F_t[i] = data.conserving ? F_1[i] : alpha_f * m.F_alpha[i];
      if constexpr (kMean) {
        const StrainPair<P> pair(ends.E_a, ends.E_b);
        const VolumeGradient<P> gradient(pair, ends.J_a, ends.J_b);
        for (int i = 0; i < 6; ++i) {
          S_geometric[i] = S[i] + mean->geometric * gradient.g[i];
          S[i] += mean->p * gradient.g[i];
        }
        if constexpr (kTangent) {
          gradient.add_derivative(P(ends.factor * mean->geometric), pair, D);
          add_rows(w, m.F_alpha, gradient.g, G, a);
          add_rows(w, F_t, gradient.g_b, G, b);
        }
      } else {
        for (int i = 0; i < 6; ++i) S_geometric[i] = S[i];
      }
      P F_dot[9];
      if (data.viscous) {
        P rate[6];
        displacement_gradient<P, R>(block.v, G, F_dot);
        strain_rate(m.F_alpha, F_dot, rate);
        add_viscous_stress(data, rate, S);
        add_viscous_stress(data, rate, S_geometric);
      }
      add_rows(w, m.F_alpha, S, G, f);
      if constexpr (kTangent) {
        PointRecord<P>& r = records[q];
        const double mode_rate = step.rate != 0.0 ? (alpha_f + 0.5) / step.dt : 0.0;
        for (int i = 0; i < 9; ++i) {
          r.F_alpha[i] = w * m.F_alpha[i];
          r.F_t[i] = F_t[i];
          if (data.viscous) {
            r.F_v[i] = alpha_f * (step.rate * m.F_alpha[i] + F_dot[i]);
            r.F_ve[i] = mode_rate * m.F_alpha[i] + alpha_f * F_dot[i];
          }
        }
        for (int i = 0; i < 6; ++i) r.S[i] = alpha_f * w * S_geometric[i];
        for (int i = 0; i < 36; ++i) r.D[i] = D[i];
      }
    }
  }

 private:
  /// Adds w F S G_r to each row.
  static void add_rows(const P& w, const P* F, const P* S, const P* G, P (*rows)[3]) {
    P A[9];
    times_symmetric(F, S, A);
    for (P& entry : A) entry *= w;
    for (int r = 0; r < R; ++r)
      for (int i = 0; i < 3; ++i)
        rows[r][i] +=
            A[3 * i] * G[3 * r] + A[3 * i + 1] * G[3 * r + 1] + A[3 * i + 2] * G[3 * r + 2];
  }
};

/// Three columns of the tangent, for displacements of row b: K[c][a][i] is the derivative of f_a,i
/// by the displacement of row b along c. @eq{solid-tangent}
template <class P, int kKind>
inline void tangent_columns(const ElementData& data, const Block<P, kKind>& block,
                            const PointRecord<P>* records, int b, P (*K)[Block<P, kKind>::R][3]) {
  using B = Block<P, kKind>;
  for (int c = 0; c < 3; ++c)
    for (int a = 0; a < B::R; ++a)
      for (int i = 0; i < 3; ++i) K[c][a][i] = P{};
  for (int q = 0; q < B::kSizes.points; ++q) {
    const PointRecord<P>& r = records[q];
    const double* G = block.point(q) + B::W;
    P G_b[3], SG[3];
    for (int j = 0; j < 3; ++j) G_b[j] = load<P>(G + (3 * b + j) * B::W);
    SG[0] = r.S[0] * G_b[0] + r.S[3] * G_b[1] + r.S[5] * G_b[2];
    SG[1] = r.S[3] * G_b[0] + r.S[1] * G_b[1] + r.S[4] * G_b[2];
    SG[2] = r.S[5] * G_b[0] + r.S[4] * G_b[1] + r.S[2] * G_b[2];
    for (int c = 0; c < 3; ++c) {
      P strain[6], dS[6], A[9];
      strain_of_move(r.F_t + 3 * c, G_b, strain);
      for (int i = 0; i < 6; ++i) {
        dS[i] = r.D[6 * i] * strain[0];
        for (int j = 1; j < 6; ++j) dS[i] += r.D[6 * i + j] * strain[j];
      }
      if (data.viscous) {
        strain_of_move((b < B::N ? r.F_v : r.F_ve) + 3 * c, G_b, strain);
        const P pressure = data.viscous_lame * (strain[0] + strain[1] + strain[2]);
        for (int i = 0; i < 6; ++i)
          dS[i] += i < 3 ? pressure + 2.0 * data.viscous_shear * strain[i]
                         : data.viscous_shear * strain[i];
      }
      times_symmetric(r.F_alpha, dS, A);
      for (int j = 0; j < 3; ++j) A[3 * c + j] += SG[j];
      for (int a = 0; a < B::R; ++a) {
        const P g0 = load<P>(G + (3 * a) * B::W), g1 = load<P>(G + (3 * a + 1) * B::W),
                g2 = load<P>(G + (3 * a + 2) * B::W);
        for (int i = 0; i < 3; ++i)
          K[c][a][i] += A[3 * i] * g0 + A[3 * i + 1] * g1 + A[3 * i + 2] * g2;
      }
    }
  }
}

/// Subtracts forces of a block from those on its nodes.
template <class P, int kNodes>
inline void scatter_forces(const int* nodes, int present, const P (*f)[3], double* force) {
  for (int l = 0; l < present; ++l)
    for (int a = 0; a < kNodes; ++a)
      for (int i = 0; i < 3; ++i) force[3 * nodes[l * kNodes + a] + i] -= f[a][i][l];
}

/// Subtracts three columns from the blocks (a, b) of the elements of a block.
template <class P, int kNodes, int kRows>
inline void scatter_columns(const int* slots, int first, int present, int b, const P (*K)[kRows][3],
                            double* tangent) {
  for (int l = 0; l < present; ++l) {
    const int* slot = slots + static_cast<long>(first + l) * kNodes * kNodes + b;
    for (int a = 0; a < kNodes; ++a) {
      double* to = tangent + 9L * slot[a * kNodes];
      for (int i = 0; i < 3; ++i)
        for (int c = 0; c < 3; ++c) to[3 * i + c] -= K[c][a][i][l];
    }
  }
}

}  // namespace polhode::solids
