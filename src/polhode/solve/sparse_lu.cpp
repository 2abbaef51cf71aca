// SPDX-License-Identifier: Apache-2.0
#include <Eigen/SparseCore>
#include <Eigen/SparseLU>

#include <polhode/solve/kkt_matrix.hpp>
#include <polhode/solve/sparse_lu.hpp>

namespace polhode {

struct SparseLu::Impl {
  using Matrix = Eigen::SparseMatrix<double>;

  KktMatrix matrix;
  mutable Eigen::SparseLU<Matrix, Eigen::COLAMDOrdering<int>> lu;  // its transpose() is not const
  double flops = 0.0;

  [[nodiscard]] Eigen::Map<const Matrix> view() const {
    const int n = matrix.size();
    return {n,
            n,
            static_cast<Eigen::Index>(matrix.values().size()),
            matrix.column_start().data(),
            matrix.row_index().data(),
            matrix.values().data()};
  }
};

SparseLu::SparseLu() : impl_(std::make_unique<Impl>()) {}
SparseLu::~SparseLu() = default;

void SparseLu::analyse(const KktTopology& topology) {
  impl_->matrix = KktMatrix(topology);
  if (impl_->matrix.size() > 0) impl_->lu.analyzePattern(impl_->view());
}

bool SparseLu::factor(const KktValues& values) {
  if (impl_->matrix.size() == 0) return true;
  if (!impl_->matrix.set(values)) return false;
  impl_->lu.factorize(impl_->view());
  if (impl_->lu.info() != Eigen::Success) return false;
  // Each pair (entry of L's column k, entry of U's row k) costs one multiplication and addition;
  // with n columns the mean lengths are a fair estimate.
  const double n = impl_->matrix.size();
  impl_->flops =
      2.0 * static_cast<double>(impl_->lu.nnzL()) / n * static_cast<double>(impl_->lu.nnzU());
  return true;
}

void SparseLu::solve(Vec& x) const {
  if (x.size() > 0) x = impl_->lu.solve(x).eval();
}

void SparseLu::solve_transposed(Vec& x) const {
  if (x.size() > 0) x = impl_->lu.transpose().solve(x).eval();
}

double SparseLu::factor_flops() const { return impl_->flops; }

}  // namespace polhode
