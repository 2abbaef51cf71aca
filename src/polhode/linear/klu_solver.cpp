// SPDX-License-Identifier: Apache-2.0
#include <klu.h>

#include <polhode/core/assert.hpp>
#include <polhode/core/error.hpp>
#include <polhode/core/format.hpp>
#include <polhode/linear/kkt_matrix.hpp>
#include <polhode/linear/sparse_solvers.hpp>

namespace polhode::linear {

namespace {

/// Part of its column from which on a diagonal pivot is accepted [-]: KLU's default 1e-3 reduces
/// fill but loses digits that the extra Newton iteration needs.
constexpr double kPivotTolerance = 0.1;

class KluSolver final : public LinearSolver {
 public:
  KluSolver() {
    klu_defaults(&common_);
    common_.tol = kPivotTolerance;
  }
  ~KluSolver() override { clear(); }
  KluSolver(const KluSolver&) = delete;
  KluSolver& operator=(const KluSolver&) = delete;

  [[nodiscard]] std::string name() const override { return "klu"; }
  void analyse(const KktTopology& topology) override;
  [[nodiscard]] bool factor(const KktValues& values) override;
  void solve(Vec& x) const override;
  void solve_transposed(Vec& x) const override;
  [[nodiscard]] double factor_flops() const override {
    return symbolic_ ? symbolic_->est_flops : 0.0;
  }

 private:
  void clear() {
    klu_free_numeric(&numeric_, &common_);
    klu_free_symbolic(&symbolic_, &common_);
  }
  int* starts() const { return const_cast<int*>(matrix_.column_start().data()); }
  int* rows() const { return const_cast<int*>(matrix_.row_index().data()); }

  KktMatrix matrix_;
  mutable klu_common common_{};  // solving changes its status
  klu_symbolic* symbolic_ = nullptr;
  klu_numeric* numeric_ = nullptr;
};

void KluSolver::analyse(const KktTopology& topology) {
  clear();
  matrix_ = KktMatrix(topology);
  if (matrix_.size() == 0) return;
  symbolic_ = klu_analyze(matrix_.size(), starts(), rows(), &common_);
  if (!symbolic_)
    throw SolveError(
        format("The matrix of bodies and joints could not be analysed (KLU {})", common_.status),
        "Run a smaller model, or choose another solver");
}

bool KluSolver::factor(const KktValues& values) {
  if (matrix_.size() == 0) return true;
  klu_free_numeric(&numeric_, &common_);
  if (!matrix_.set(values)) return false;
  // Pivots of an earlier matrix would save half of the time, but then a step would depend on those
  // before it by more than its state, and a continued run would have other bits.
  numeric_ = klu_factor(starts(), rows(), matrix_.values().data(), symbolic_, &common_);
  return numeric_ != nullptr && common_.status == KLU_OK;
}

void KluSolver::solve(Vec& x) const {
  if (x.size() == 0) return;
  POLHODE_ASSERT(numeric_ && x.size() == matrix_.size());
  klu_solve(symbolic_, numeric_, matrix_.size(), 1, x.data(), &common_);
}

void KluSolver::solve_transposed(Vec& x) const {
  if (x.size() == 0) return;
  POLHODE_ASSERT(numeric_ && x.size() == matrix_.size());
  klu_tsolve(symbolic_, numeric_, matrix_.size(), 1, x.data(), &common_);
}

}  // namespace

std::unique_ptr<LinearSolver> make_klu_solver() { return std::make_unique<KluSolver>(); }

}  // namespace polhode::linear
