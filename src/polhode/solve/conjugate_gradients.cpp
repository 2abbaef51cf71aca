// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include <polhode/base/error.hpp>
#include <polhode/solve/block_lu_kernels.hpp>
#include <polhode/solve/conjugate_gradients.hpp>

// The iteration is compiled twice on x86-64: for every processor, and for those with AVX2 and FMA.
#define POLHODE_INLINE inline __attribute__((always_inline))
#if defined(__x86_64__)
#define POLHODE_FUSED __attribute__((target("avx2,fma")))
#endif

namespace polhode {

namespace {

/// Doubles of a body in a vector: six and two zeros.
constexpr std::size_t kStride = 8;

using V4 = double __attribute__((vector_size(32), aligned(8), may_alias));

/// y += M x
template <class Block>
POLHODE_INLINE void add_product(const Block& M, const double* x, double* y) {
  V4* out = reinterpret_cast<V4*>(y);
  V4 low = out[0], high = out[1];
  for (int j = 0; j < 6; ++j) {
    const V4* column = reinterpret_cast<const V4*>(M.column[j]);
    low += x[j] * column[0];
    high += x[j] * column[1];
  }
  out[0] = low;
  out[1] = high;
}

/// The order of summation does not depend on the instruction set's width.
POLHODE_INLINE double inner_product(const std::vector<double>& x, const std::vector<double>& y) {
  V4 low{}, high{};
  for (std::size_t i = 0; i < x.size(); i += kStride) {
    low += *reinterpret_cast<const V4*>(&x[i]) * *reinterpret_cast<const V4*>(&y[i]);
    high += *reinterpret_cast<const V4*>(&x[i + 4]) * *reinterpret_cast<const V4*>(&y[i + 4]);
  }
  const V4 sum = low + high;
  return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

/// x += factor y
POLHODE_INLINE void add(std::vector<double>& x, double factor, const std::vector<double>& y) {
  for (std::size_t i = 0; i < x.size(); i += 4)
    *reinterpret_cast<V4*>(&x[i]) += factor * *reinterpret_cast<const V4*>(&y[i]);
}

/// The matrix as it is multiplied.
template <class Block, class Edge>
struct View {
  const std::vector<Block>&diagonal, &inverse, &upper, &lower;
  const std::vector<Edge>& edges;
};

template <class Block>
POLHODE_INLINE void multiply_diagonal(const std::vector<Block>& blocks,
                                      const std::vector<double>& x, std::vector<double>& y) {
  std::fill(y.begin(), y.end(), 0.0);
  for (std::size_t b = 0; b < blocks.size(); ++b)
    add_product(blocks[b], &x[kStride * b], &y[kStride * b]);
}

template <class Block, class Edge>
POLHODE_INLINE void multiply(const View<Block, Edge>& A, const std::vector<double>& x,
                             std::vector<double>& y) {
  multiply_diagonal(A.diagonal, x, y);
  for (std::size_t e = 0; e < A.edges.size(); ++e) {
    const std::size_t a = kStride * static_cast<std::size_t>(A.edges[e].a);
    const std::size_t b = kStride * static_cast<std::size_t>(A.edges[e].b);
    add_product(A.upper[e], &x[b], &y[a]);
    add_product(A.lower[e], &x[a], &y[b]);
  }
}

/// Right-hand side in r; what is left of it there afterwards. @returns iterations.
template <class Block, class Edge>
POLHODE_INLINE int iterate(const View<Block, Edge>& A, double tolerance, int most,
                           std::vector<double>& r, std::vector<double>& z, std::vector<double>& p,
                           std::vector<double>& Ap, std::vector<double>& x) {
  std::fill(x.begin(), x.end(), 0.0);
  multiply_diagonal(A.inverse, r, z);
  p = z;
  double rz = inner_product(r, z);
  const double enough = tolerance * tolerance * rz;
  int k = 0;
  for (; k < most && rz > enough; ++k) {
    multiply(A, p, Ap);
    const double curvature = inner_product(p, Ap);
    if (!(curvature > 0.0)) {
      if (k == 0) x = z;
      break;
    }
    const double step = rz / curvature;
    add(x, step, p);
    add(r, -step, Ap);
    multiply_diagonal(A.inverse, r, z);
    const double next = inner_product(r, z);
    const double ratio = next / rz;
    rz = next;
    for (std::size_t i = 0; i < p.size(); i += 4)
      *reinterpret_cast<V4*>(&p[i]) =
          *reinterpret_cast<const V4*>(&z[i]) + ratio * *reinterpret_cast<const V4*>(&p[i]);
  }
  return k;
}

#ifdef POLHODE_FUSED
template <class Block, class Edge>
POLHODE_FUSED int iterate_fused(const View<Block, Edge>& A, double tolerance, int most,
                                std::vector<double>& r, std::vector<double>& z,
                                std::vector<double>& p, std::vector<double>& Ap,
                                std::vector<double>& x) {
  return iterate(A, tolerance, most, r, z, p, Ap, x);
}
#endif

/// Inverse of a symmetric block; of its diagonal's absolute values if it is not definite.
Mat6 definite_inverse(const Mat6& K) {
  const Eigen::LLT<Mat6> factors(K);
  if (factors.info() == Eigen::Success) return factors.solve(Mat6::Identity());
  return K.diagonal().cwiseAbs().cwiseMax(1e-300).cwiseInverse().asDiagonal();
}

}  // namespace

ConjugateGradients::ConjugateGradients(double tolerance, int most_iterations)
    : tolerance_(tolerance), most_iterations_(most_iterations), fused_(has_fused_kernels()) {}

void ConjugateGradients::analyse(const KktTopology& topology) {
  if (topology.rows > 0)
    throw InputError("linear_solver", "'cg' cannot hold the rows of joints",
                     "Use block_lu for models with joints");
  bodies_ = topology.bodies;
  edges_.clear();
  pair_of_edge_.clear();
  for (std::size_t p = 0; p < topology.pairs.size(); ++p) {
    const KktPair& pair = topology.pairs[p];
    if (pair.a == kGround || pair.b == kGround) continue;
    edges_.push_back({pair.a, pair.b});
    pair_of_edge_.push_back(p);
  }
  const auto n = static_cast<std::size_t>(bodies_);
  diagonal_.assign(n, Block{});
  inverse_.assign(n, Block{});
  upper_.assign(edges_.size(), Block{});
  lower_.assign(edges_.size(), Block{});
  for (std::vector<double>* v : {&residual_, &direction_, &image_, &preconditioned_, &solution_})
    v->assign(kStride * n, 0.0);
}

void ConjugateGradients::put(Block& block, const Mat6& M) {
  for (int j = 0; j < 6; ++j)
    for (int i = 0; i < 6; ++i) block.column[j][i] = M(i, j);
}

bool ConjugateGradients::factor(const KktValues& values) {
  for (std::size_t b = 0; b < diagonal_.size(); ++b) {
    const Mat6 K = 0.5 * (values.diagonal[b] + values.diagonal[b].transpose());
    if (!K.allFinite()) return false;
    put(diagonal_[b], K);
    put(inverse_[b], definite_inverse(K));
  }
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    const KktValues::Pair& pair = values.pairs[pair_of_edge_[e]];
    const Mat6 K = 0.5 * (pair.K_ab + pair.K_ba.transpose());
    put(upper_[e], K);
    put(lower_[e], K.transpose());
  }
  return true;
}

void ConjugateGradients::solve(Vec& x) const {
  for (int b = 0; b < bodies_; ++b)
    std::copy_n(x.data() + 6 * b, 6, residual_.begin() + static_cast<std::ptrdiff_t>(kStride) * b);
  const View<Block, Edge> A{diagonal_, inverse_, upper_, lower_, edges_};
#ifdef POLHODE_FUSED
  if (fused_)
    iterations_ += iterate_fused(A, tolerance_, most_iterations_, residual_, preconditioned_,
                                 direction_, image_, solution_);
  else
#endif
    iterations_ += iterate(A, tolerance_, most_iterations_, residual_, preconditioned_, direction_,
                           image_, solution_);
  for (int b = 0; b < bodies_; ++b)
    std::copy_n(solution_.begin() + static_cast<std::ptrdiff_t>(kStride) * b, 6, x.data() + 6 * b);
}

double ConjugateGradients::factor_flops() const { return 300.0 * bodies_; }

}  // namespace polhode
