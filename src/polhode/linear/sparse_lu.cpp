// SPDX-License-Identifier: Apache-2.0
#include <Eigen/SparseCore>
#include <Eigen/SparseLU>

#include <polhode/core/assert.hpp>
#include <polhode/linear/kkt_matrix.hpp>
#include <polhode/linear/sparse_solvers.hpp>

namespace polhode::linear {

namespace {

class SparseLu final : public LinearSolver {
 public:
  [[nodiscard]] std::string name() const override { return "sparse_lu"; }
  void analyse(const KktTopology& topology) override;
  [[nodiscard]] bool factor(const KktValues& values) override;
  void solve(Vec& x) const override;
  void solve_transposed(Vec& x) const override;
  [[nodiscard]] double factor_flops() const override { return flops_; }

 private:
  using Matrix = Eigen::SparseMatrix<double>;

  KktMatrix matrix_;
  mutable Eigen::SparseLU<Matrix, Eigen::COLAMDOrdering<int>> lu_;  // its transpose() is not const
  double flops_ = 0.0;

  [[nodiscard]] Eigen::Map<const Matrix> view() const {
    const int n = matrix_.size();
    return {n,
            n,
            static_cast<Eigen::Index>(matrix_.values().size()),
            matrix_.column_start().data(),
            matrix_.row_index().data(),
            matrix_.values().data()};
  }
};

void SparseLu::analyse(const KktTopology& topology) {
  matrix_ = KktMatrix(topology);
  if (matrix_.size() > 0) lu_.analyzePattern(view());
}

bool SparseLu::factor(const KktValues& values) {
  if (matrix_.size() == 0) return true;
  if (!matrix_.set(values)) return false;
  lu_.factorize(view());
  if (lu_.info() != Eigen::Success) return false;
  // Each pair (entry of L's column k, entry of U's row k) needs one multiplication and addition;
  // with n columns the mean lengths give a sufficient estimate.
  const double n = matrix_.size();
  flops_ = 2.0 * static_cast<double>(lu_.nnzL()) / n * static_cast<double>(lu_.nnzU());
  return true;
}

void SparseLu::solve(Vec& x) const {
  POLHODE_ASSERT(x.size() == matrix_.size());
  if (x.size() > 0) x = lu_.solve(x).eval();
}

void SparseLu::solve_transposed(Vec& x) const {
  POLHODE_ASSERT(x.size() == matrix_.size());
  if (x.size() > 0) x = lu_.transpose().solve(x).eval();
}

}  // namespace

std::unique_ptr<LinearSolver> make_sparse_lu() { return std::make_unique<SparseLu>(); }

}  // namespace polhode::linear
