// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>
#include <utility>

#include <polhode/linear/block_lu_kernels.hpp>

// Vectors of four doubles; the compiler splits them for narrower registers. The same source is
// compiled twice on x86-64: for every processor, and for those with AVX2 and FMA.
#define POLHODE_INLINE inline __attribute__((always_inline))
#if defined(__x86_64__)
#define POLHODE_FUSED __attribute__((target("avx2,fma")))
#endif

namespace polhode::linear {

namespace {

// A typedef, since clang ignores the alignment of an alias declaration.
typedef double V4 __attribute__((vector_size(32), aligned(8), may_alias));
static_assert(alignof(V4) == alignof(double), "Blocks are aligned as doubles.");

POLHODE_INLINE V4* four(double* x) { return reinterpret_cast<V4*>(x); }
POLHODE_INLINE const V4* four(const double* x) { return reinterpret_cast<const V4*>(x); }

/// R rows of C −= A·B; C and B have rows of 4·W doubles, A of `stride`.
template <int W, int R>
POLHODE_INLINE void subtract_product_rows(double* C, const double* A, const double* B, int inner,
                                          int stride) {
  V4 c[R][W];
  for (int i = 0; i < R; ++i)
    for (int j = 0; j < W; ++j) c[i][j] = four(C)[i * W + j];
  for (int k = 0; k < inner; ++k)
    for (int i = 0; i < R; ++i)
      for (int j = 0; j < W; ++j) c[i][j] -= A[i * stride + k] * four(B)[k * W + j];
  for (int i = 0; i < R; ++i)
    for (int j = 0; j < W; ++j) four(C)[i * W + j] = c[i][j];
}

template <int W>
POLHODE_INLINE void subtract_product(double* C, const double* A, const double* B, int rows,
                                     int inner, int stride) {
  int i = 0;
  for (; i + 3 <= rows; i += 3)
    subtract_product_rows<W, 3>(C + i * 4 * W, A + i * stride, B, inner, stride);
  if (rows - i == 2) subtract_product_rows<W, 2>(C + i * 4 * W, A + i * stride, B, inner, stride);
  if (rows - i == 1) subtract_product_rows<W, 1>(C + i * 4 * W, A + i * stride, B, inner, stride);
}

/// Dense LU of the n×n block D with partial pivoting by rows.
template <int W>
POLHODE_INLINE bool factor_diagonal(double* D, int* pivots, int n) {
  constexpr int stride = 4 * W;
  constexpr double least = std::numeric_limits<double>::min();
  for (int c = 0; c < n; ++c) {
    int best = c;
    double largest = std::fabs(D[c * stride + c]);
    for (int i = c + 1; i < n; ++i) {
      const double size = std::fabs(D[i * stride + c]);
      if (!(size <= largest)) {  // NaN is taken as the largest, and detected below
        largest = size;
        best = i;
      }
    }
    pivots[c] = best;
    if (!(largest > least && largest <= std::numeric_limits<double>::max())) return false;
    if (best != c)
      for (int j = 0; j < stride; ++j) std::swap(D[c * stride + j], D[best * stride + j]);
    const double reciprocal = 1.0 / D[c * stride + c];
    D[c * stride + c] = reciprocal;
    alignas(32) double pivot_row[stride];
    for (int j = 0; j < stride; ++j) pivot_row[j] = j > c ? D[c * stride + j] : 0.0;
    for (int i = c + 1; i < n; ++i) {
      const double factor = D[i * stride + c] * reciprocal;
      D[i * stride + c] = factor;
      for (int j = (c + 1) / 4; j < W; ++j) four(D + i * stride)[j] -= factor * four(pivot_row)[j];
    }
  }
  return true;
}

/// B ← D⁻¹ B for a factored D (rows of `stride`); B has n rows of 4·W doubles.
template <int W>
POLHODE_INLINE void solve_diagonal(const double* D, const int* pivots, int n, int stride,
                                   double* B) {
  for (int c = 0; c < n; ++c)
    if (pivots[c] != c)
      for (int j = 0; j < W; ++j) {
        const V4 kept = four(B)[c * W + j];
        four(B)[c * W + j] = four(B)[pivots[c] * W + j];
        four(B)[pivots[c] * W + j] = kept;
      }
  for (int i = 1; i < n; ++i)
    subtract_product_rows<W, 1>(B + i * 4 * W, D + i * stride, B, i, stride);
  for (int i = n - 1; i >= 0; --i) {
    const double* const row = D + i * stride;
    subtract_product_rows<W, 1>(B + i * 4 * W, row + i + 1, B + (i + 1) * 4 * W, n - 1 - i, stride);
    for (int j = 0; j < W; ++j) four(B)[i * W + j] *= row[i];
  }
}

/// Solves for one right-hand side.
POLHODE_INLINE void solve_diagonal_vector(const double* D, const int* pivots, int n, int stride,
                                          double* x) {
  for (int c = 0; c < n; ++c) std::swap(x[c], x[pivots[c]]);
  for (int i = 1; i < n; ++i) {
    double sum = x[i];
    for (int c = 0; c < i; ++c) sum -= D[i * stride + c] * x[c];
    x[i] = sum;
  }
  for (int i = n - 1; i >= 0; --i) {
    double sum = x[i];
    for (int c = i + 1; c < n; ++c) sum -= D[i * stride + c] * x[c];
    x[i] = sum * D[i * stride + i];
  }
}

/// y −= A x for a block with rows of 4·W doubles.
template <int W>
POLHODE_INLINE void subtract_block_times(double* y, const double* A, const double* x, int rows) {
  for (int i = 0; i < rows; ++i) {
    V4 sum = four(A)[i * W] * four(x)[0];
    for (int j = 1; j < W; ++j) sum += four(A)[i * W + j] * four(x)[j];
    y[i] -= (sum[0] + sum[1]) + (sum[2] + sum[3]);
  }
}

POLHODE_INLINE void subtract_block_times(double* y, const double* A, const double* x, int rows,
                                         int stride) {
  if (stride == 12)
    subtract_block_times<3>(y, A, x, rows);
  else if (stride == 8)
    subtract_block_times<2>(y, A, x, rows);
  else
    subtract_block_times<1>(y, A, x, rows);
}

/// Eliminates one pivot: its own LU, its row of the upper factor, and the updates of later nodes.
template <int W>
POLHODE_INLINE bool eliminate(const BlockPlan& plan, const BlockPlan::Node& k, double* values,
                              int* pivots) {
  double* const D = values + k.diagonal;
  int* const chosen = pivots + k.first;
  if (!factor_diagonal<W>(D, chosen, k.width)) return false;
  for (std::size_t e = k.first_edge; e < k.last_edge; ++e) {
    double* const B = values + plan.edges[e].upper;
    switch (plan.nodes[plan.edges[e].node].stride) {
      case 4:
        solve_diagonal<1>(D, chosen, k.width, k.stride, B);
        break;
      case 8:
        solve_diagonal<2>(D, chosen, k.width, k.stride, B);
        break;
      default:
        solve_diagonal<3>(D, chosen, k.width, k.stride, B);
        break;
    }
  }
  std::size_t t = k.first_target;
  for (std::size_t r = k.first_edge; r < k.last_edge; ++r) {
    const double* const A = values + plan.edges[r].lower;
    const int rows = plan.nodes[plan.edges[r].node].width;
    for (std::size_t c = k.first_edge; c < k.last_edge; ++c, ++t) {
      double* const C = values + plan.targets[t];
      const double* const B = values + plan.edges[c].upper;
      switch (plan.nodes[plan.edges[c].node].stride) {
        case 4:
          subtract_product<1>(C, A, B, rows, k.width, k.stride);
          break;
        case 8:
          subtract_product<2>(C, A, B, rows, k.width, k.stride);
          break;
        default:
          subtract_product<3>(C, A, B, rows, k.width, k.stride);
          break;
      }
    }
  }
  return true;
}

POLHODE_INLINE bool factor_all(const BlockPlan& plan, double* values, int* pivots) {
  for (const BlockPlan::Node& k : plan.nodes) {
    const bool regular = k.stride == 12  ? eliminate<3>(plan, k, values, pivots)
                         : k.stride == 8 ? eliminate<2>(plan, k, values, pivots)
                                         : eliminate<1>(plan, k, values, pivots);
    if (!regular) return false;
  }
  return true;
}

POLHODE_INLINE bool is_zero(const double* x, int n) {
  int i = 0;
  while (i < n && x[i] == 0.0) ++i;
  return i == n;
}

/// Forward and backward substitution; the forward one leaves out nodes without load.
POLHODE_INLINE void solve_all(const BlockPlan& plan, const double* values, const int* pivots,
                              double* x) {
  for (const BlockPlan::Node& k : plan.nodes) {
    double* const y = x + k.first;
    if (is_zero(y, k.width)) continue;
    solve_diagonal_vector(values + k.diagonal, pivots + k.first, k.width, k.stride, y);
    for (std::size_t e = k.first_edge; e < k.last_edge; ++e) {
      const BlockPlan::Node& j = plan.nodes[plan.edges[e].node];
      subtract_block_times(x + j.first, values + plan.edges[e].lower, y, j.width, k.stride);
    }
  }
  for (std::size_t n = plan.nodes.size(); n-- > 0;) {
    const BlockPlan::Node& k = plan.nodes[n];
    for (std::size_t e = k.first_edge; e < k.last_edge; ++e) {
      const BlockPlan::Node& j = plan.nodes[plan.edges[e].node];
      subtract_block_times(x + k.first, values + plan.edges[e].upper, x + j.first, k.width,
                           j.stride);
    }
  }
}

#if defined(__x86_64__)
POLHODE_FUSED bool factor_all_fused(const BlockPlan& plan, double* values, int* pivots) {
  return factor_all(plan, values, pivots);
}
POLHODE_FUSED void solve_all_fused(const BlockPlan& plan, const double* values, const int* pivots,
                                   double* x) {
  solve_all(plan, values, pivots, x);
}
#endif

/// y −= Aᵀ x; A has `rows` rows and `columns` columns.
void subtract_transposed_block_times(double* y, const double* A, const double* x, int rows,
                                     int columns, int stride) {
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < columns; ++j) y[j] -= A[i * stride + j] * x[i];
}

/// x ← D⁻ᵀ x.
void solve_diagonal_transposed(const double* D, const int* pivots, int n, int stride, double* x) {
  for (int i = 0; i < n; ++i) {
    double sum = x[i];
    for (int c = 0; c < i; ++c) sum -= D[c * stride + i] * x[c];
    x[i] = sum * D[i * stride + i];
  }
  for (int i = n - 2; i >= 0; --i)
    for (int c = i + 1; c < n; ++c) x[i] -= D[c * stride + i] * x[c];
  for (int c = n - 1; c >= 0; --c) std::swap(x[c], x[pivots[c]]);
}

}  // namespace

bool has_fused_kernels() {
#if defined(__x86_64__)
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
#else
  return false;
#endif
}

bool factor_blocks(const BlockPlan& plan, double* values, int* pivots, bool fused) {
#if defined(__x86_64__)
  if (fused) return factor_all_fused(plan, values, pivots);
#endif
  (void)fused;
  return factor_all(plan, values, pivots);
}

void solve_blocks(const BlockPlan& plan, const double* values, const int* pivots, double* x,
                  bool fused) {
#if defined(__x86_64__)
  if (fused) {
    solve_all_fused(plan, values, pivots, x);
    return;
  }
#endif
  (void)fused;
  solve_all(plan, values, pivots, x);
}

void solve_blocks_transposed(const BlockPlan& plan, const double* values, const int* pivots,
                             double* x) {
  for (const BlockPlan::Node& k : plan.nodes)
    for (std::size_t e = k.first_edge; e < k.last_edge; ++e) {
      const BlockPlan::Node& j = plan.nodes[plan.edges[e].node];
      subtract_transposed_block_times(x + j.first, values + plan.edges[e].upper, x + k.first,
                                      k.width, j.width, j.stride);
    }
  for (std::size_t n = plan.nodes.size(); n-- > 0;) {
    const BlockPlan::Node& k = plan.nodes[n];
    double* const y = x + k.first;
    for (std::size_t e = k.first_edge; e < k.last_edge; ++e) {
      const BlockPlan::Node& j = plan.nodes[plan.edges[e].node];
      subtract_transposed_block_times(y, values + plan.edges[e].lower, x + j.first, j.width,
                                      k.width, k.stride);
    }
    solve_diagonal_transposed(values + k.diagonal, pivots + k.first, k.width, k.stride, y);
  }
}

}  // namespace polhode::linear
