// SPDX-License-Identifier: Apache-2.0
// The kernels of all kinds of elements for packs of one width. Included by kernels_*.cpp only.
#pragma once

#include <polhode/solids/elements/block_kernel.hpp>

namespace polhode::solids {

template <class P, int kKind>
[[gnu::noinline]] void block_residual(const ElementData& data, ElementStep& step,
                                      const Block<P, kKind>& block, BlockForces<P, kKind>& forces) {
  using B = Block<P, kKind>;
  if constexpr (B::kSizes.mean_dilatation) {
    const MeanPressure<P> mean(data, step, block);
    forces.template compute<false>(data, step, block, &mean, nullptr);
    if (step.scratch) store(block.scratch(step), mean.p);
  } else {
    forces.template compute<false>(data, step, block, nullptr, nullptr);
  }
  if constexpr (B::M > 0)
    if (step.scratch) Condensation<P, kKind>{block.scratch(step)}.reuse(step.turn, &forces.f[0][0]);
}

template <class P, int kKind>
[[gnu::noinline]] void block_tangent(const ElementData& data, ElementStep& step,
                                     const Block<P, kKind>& block, BlockForces<P, kKind>& forces) {
  using B = Block<P, kKind>;
  constexpr int N = B::N, R = B::R;
  PointRecord<P> records[B::kSizes.points];
  if constexpr (B::M > 0) {
    forces.template compute<true>(data, step, block, nullptr, records);
    P K[3 * R][3 * R];  // by columns
    for (int b = 0; b < R; ++b)
      tangent_columns<P, kKind>(data, block, records, b, reinterpret_cast<P(*)[R][3]>(K + 3 * b));
    Condensation<P, kKind>{block.scratch(step)}.make(K, &forces.f[0][0]);
    for (int b = 0; b < N; ++b)
      scatter_columns<P, N, R>(step.slots, block.number * B::W, block.present, b,
                               reinterpret_cast<const P(*)[R][3]>(K + 3 * b), step.tangent);
  } else {
    P factor{};
    if constexpr (B::kSizes.mean_dilatation) {
      const MeanPressure<P> mean(data, step, block);
      forces.template compute<true>(data, step, block, &mean, records);
      factor = mean.slope / load<P>(data.volumes + static_cast<long>(block.number) * B::W);
      if (step.scratch) {
        double* kept = block.scratch(step);
        store(kept, mean.p);
        store(kept + B::W, mean.p);
        for (int a = 0; a < N; ++a)
          for (int i = 0; i < 3; ++i)
            store(kept + (B::kSizes.at_slope() + 3 * a + i) * B::W, P(factor * forces.b[a][i]));
      }
    } else {
      forces.template compute<true>(data, step, block, nullptr, records);
    }
    for (int b = 0; b < N; ++b) {
      P K[3][R][3];
      tangent_columns<P, kKind>(data, block, records, b, K);
      if constexpr (B::kSizes.mean_dilatation)
        for (int c = 0; c < 3; ++c) {
          const P by_move = factor * forces.b[b][c];
          for (int a = 0; a < N; ++a)
            for (int i = 0; i < 3; ++i) K[c][a][i] += forces.a[a][i] * by_move;
        }
      scatter_columns<P, N, R>(step.slots, block.number * B::W, block.present, b, K, step.tangent);
    }
  }
}

template <class P, int kKind>
void evaluate_elements(const ElementData& data, ElementStep& step) {
  using B = Block<P, kKind>;
  for (int b = 0; b < data.blocks; ++b) {
    const B block(data, step, b, data.viscous);
    BlockForces<P, kKind> forces;
    if (step.tangent)
      block_tangent<P, kKind>(data, step, block, forces);
    else
      block_residual<P, kKind>(data, step, block, forces);
    scatter_forces<P, B::N>(block.nodes, block.present, forces.f, step.force);
    for (int l = 0; l < block.present; ++l)
      if (!(forces.least_volume[l] >= step.least_volume)) {
        step.least_volume = forces.least_volume[l];
        step.worst_element = b * B::W + l;
      }
  }
}

template <class P, int kKind>
double advance_elements(const ElementData& data, const ElementStep& step, const double* du) {
  constexpr ElementSizes kSizes = kElementSizes[kKind];
  constexpr int N = kSizes.nodes, W = kWidth<P>;
  double largest = 0.0;
  if constexpr (kSizes.scratch() > 0)
    for (int b = 0; b < data.blocks; ++b) {
      P u[N][3];
      gather<P, N>(data.nodes + static_cast<long>(b) * W * N, du, nullptr, u);
      double* scratch = step.scratch + static_cast<long>(b) * W * kSizes.scratch();
      if constexpr (kSizes.enhanced > 0) {
        const P move = Condensation<P, kKind>{scratch}.advance(step.turn, &u[0][0]);
        for (int l = 0; l < W; ++l)
          if (!(move[l] <= largest)) largest = move[l];
      } else {
        P p = load<P>(scratch + W);
        for (int a = 0; a < N; ++a)
          for (int i = 0; i < 3; ++i)
            p += load<P>(scratch + (kSizes.at_slope() + 3 * a + i) * W) * u[a][i];
        store(scratch + W, p);
      }
    }
  return largest;
}

/// Mean dilatation minus one at t_{n+1}.
template <class P, int kKind>
inline P mean_dilatation(const Block<P, kKind>& block) {
  using B = Block<P, kKind>;
  P sum{}, volume{};
  for (int q = 0; q < B::kSizes.points; ++q) {
    P G[3 * B::R], H[9], E[6], F[9];
    block.gradients(q, G);
    displacement_gradient<P, B::R>(block.u_1, G, H);
    green_strain(H, E);
    add_identity(H, F);
    sum += block.weight(q) * Strain<P>(E).s / (determinant(F) + 1.0);
    volume += block.weight(q);
  }
  return sum / volume;
}

template <class P, int kKind>
void element_work(const ElementData& data, const ElementStep& step, double* stored, double* power) {
  using B = Block<P, kKind>;
  constexpr bool kMean = B::kSizes.mean_dilatation;
  for (int n = 0; n < data.blocks; ++n) {
    const B block(data, step, n, data.viscous);
    P energy{}, taken{}, volume{};
    for (int q = 0; q < B::kSizes.points; ++q) {
      P G[3 * B::R], H[9], E[6];
      block.gradients(q, G);
      const P w = block.weight(q);
      volume += w;
      displacement_gradient<P, B::R>(block.u_1, G, H);
      green_strain(H, E);
      energy += w * energy_density<P>(data, block.fibres, !kMean, E);
      if (data.memory_size > 0) {
        const PointMemory<P> memory = block.memory(data, q);
        if (step.rate != 0.0) {
          P H_0[9], E_0[6], loss{};
          displacement_gradient<P, B::R>(block.u_0, G, H_0);
          green_strain(H_0, E_0);
          energy += w * memory_energy_after<P>(data, step, block.fibres, memory, E_0, E, loss);
          taken += w / step.dt * loss;
        } else {
          energy += w * memory_energy<P>(data, step, block.fibres, memory, E);
        }
      }
      if (data.viscous) {
        P H_0[9], F[9], F_dot[9], rate[6];
        displacement_gradient<P, B::R>(block.u_0, G, H_0);
        for (int i = 0; i < 9; ++i) H[i] = (1.0 - step.alpha_f) * H_0[i] + step.alpha_f * H[i];
        add_identity(H, F);
        displacement_gradient<P, B::R>(block.v, G, F_dot);
        strain_rate(F, F_dot, rate);
        taken += w * viscous_power(data, rate);
      }
    }
    if constexpr (kMean) {
      const P tau = mean_dilatation(block);
      P U;
      data.volume_kernel.energy(data.bulk, numbers(&tau), numbers(&U));
      energy += volume * U;
    }
    for (int l = 0; l < block.present; ++l) {
      *stored += energy[l];
      *power += taken[l];
    }
  }
}

template <class P, int kKind>
void sample_elements(const ElementData& data, const ElementStep& step, double* samples,
                     double* nodal) {
  using B = Block<P, kKind>;
  constexpr bool kMean = B::kSizes.mean_dilatation;
  for (int n = 0; n < data.blocks; ++n) {
    const B block(data, step, n, false);
    P sum[kSampleSize]{}, at_nodes[kNodalSize * B::kSizes.nodes]{};
    P p{}, slope{}, U{};
    if constexpr (kMean) {
      const P tau = mean_dilatation(block);
      data.volume_kernel.pressure(data.bulk, numbers(&tau), numbers(&tau), numbers(&p),
                                  numbers(&slope));
      data.volume_kernel.energy(data.bulk, numbers(&tau), numbers(&U));
    }
    for (int q = 0; q < B::kSizes.points; ++q) {
      P G[3 * B::R], H[9], E[6], F[9], S[6], A[9];
      block.gradients(q, G);
      const P w = block.weight(q);
      displacement_gradient<P, B::R>(block.u_1, G, H);
      green_strain(H, E);
      add_identity(H, F);
      const P J = determinant(F);
      stress_between<P>(data, block.fibres, !kMean, E, E, S, nullptr);
      if constexpr (kMean) {
        const VolumeGradient<P> gradient(StrainPair<P>(E, E), J, J);
        for (int i = 0; i < 6; ++i) S[i] += p * gradient.g[i];
      }
      if (data.memory_size > 0)
        add_memory<P>(data, step, block.fibres, block.memory(data, q), E, E, S,
                      static_cast<P*>(nullptr));
      times_symmetric(F, S, A);
      constexpr int kRow[6] = {0, 1, 2, 0, 1, 2}, kColumn[6] = {0, 1, 2, 1, 2, 0};
      P point[kNodalSize];
      for (int k = 0; k < 6; ++k) {
        const P* a = A + 3 * kRow[k];
        const P* f = F + 3 * kColumn[k];
        point[k] = (a[0] * f[0] + a[1] * f[1] + a[2] * f[2]) / J;
        sum[k] += w * point[k];
        sum[6 + k] += w * ((k < 3 ? 1.0 : 0.0) + 2.0 * E[k]);
      }
      point[6] = energy_density<P>(data, block.fibres, !kMean, E) + U;
      if (data.memory_size > 0)
        point[6] += memory_energy<P>(data, step, block.fibres, block.memory(data, q), E);
      sum[12] += w * point[6];
      sum[13] += w;
      if (!nodal) continue;
      for (int a = 0; a < B::kSizes.nodes; ++a) {
        const double share = data.to_nodes[a * B::kSizes.points + q];
        for (int k = 0; k < kNodalSize; ++k) at_nodes[kNodalSize * a + k] += share * point[k];
      }
    }
    for (int l = 0; l < block.present; ++l) {
      double* to = samples + static_cast<long>(n * B::W + l) * kSampleSize;
      for (int k = 0; k < kSampleSize - 1; ++k) to[k] = sum[k][l] / sum[13][l];
      to[13] = sum[13][l];
      constexpr int kAll = kNodalSize * B::kSizes.nodes;
      for (int k = 0; nodal && k < kAll; ++k)
        nodal[static_cast<long>(n * B::W + l) * kAll + k] = at_nodes[k][l];
    }
  }
}

template <class P, int kKind>
void remember_elements(const ElementData& data, const ElementStep& step, double* history) {
  using B = Block<P, kKind>;
  for (int n = 0; n < data.blocks; ++n) {
    const B block(data, step, n, false);
    for (int q = 0; q < B::kSizes.points; ++q) {
      P G[3 * B::R], H[9], E_0[6], E_1[6];
      block.gradients(q, G);
      displacement_gradient<P, B::R>(block.u_0, G, H);
      green_strain(H, E_0);
      displacement_gradient<P, B::R>(block.u_1, G, H);
      green_strain(H, E_1);
      remember_point<P>(data, step, block.fibres, block.memory(data, q), E_0, E_1, history);
    }
  }
}

template <class P, int kKind>
inline constexpr ElementKernel kKernelOf = {evaluate_elements<P, kKind>, advance_elements<P, kKind>,
                                            element_work<P, kKind>, sample_elements<P, kKind>,
                                            remember_elements<P, kKind>};

template <class P>
struct KernelTable {
  ElementKernel kind[kElementKinds] = {
      kKernelOf<P, 0>, kKernelOf<P, 1>, kKernelOf<P, 2>, kKernelOf<P, 3>, kKernelOf<P, 4>,
      kKernelOf<P, 5>, kKernelOf<P, 6>, kKernelOf<P, 7>, kKernelOf<P, 8>, kKernelOf<P, 9>};
};

}  // namespace polhode::solids
