// SPDX-License-Identifier: Apache-2.0
#include <klu.h>

#include <stdexcept>

#include <polhode/solve/kkt_matrix.hpp>
#include <polhode/solve/klu_solver.hpp>

namespace polhode {

namespace {

/// Kept pivots are given up when max|A|/max|U| of some column falls below this [-].
constexpr double kLeastPivotGrowth = 1e-3;
/// A diagonal pivot is taken if it is at least this part of its column [-]: KLU's own 1e-3 saves
/// fill and costs digits, which the polish iteration would miss.
constexpr double kPivotTolerance = 0.1;

}  // namespace

struct KluSolver::Impl {
  KktMatrix matrix;
  mutable klu_common common{};  // solving writes its status
  klu_symbolic* symbolic = nullptr;
  klu_numeric* numeric = nullptr;

  Impl() {
    klu_defaults(&common);
    common.tol = kPivotTolerance;
  }
  ~Impl() { clear(); }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  void clear() {
    klu_free_numeric(&numeric, &common);
    klu_free_symbolic(&symbolic, &common);
  }
  int* starts() const { return const_cast<int*>(matrix.column_start().data()); }
  int* rows() const { return const_cast<int*>(matrix.row_index().data()); }

  bool refactor() {
    if (!numeric) return false;
    double* const x = matrix.values().data();
    return klu_refactor(starts(), rows(), x, symbolic, numeric, &common) != 0 &&
           common.status == KLU_OK &&
           klu_rgrowth(starts(), rows(), x, symbolic, numeric, &common) != 0 &&
           common.rgrowth > kLeastPivotGrowth;
  }
};

KluSolver::KluSolver() : impl_(std::make_unique<Impl>()) {}
KluSolver::~KluSolver() = default;

void KluSolver::analyse(const KktTopology& topology) {
  impl_->clear();
  impl_->matrix = KktMatrix(topology);
  if (impl_->matrix.size() == 0) return;
  impl_->symbolic =
      klu_analyze(impl_->matrix.size(), impl_->starts(), impl_->rows(), &impl_->common);
  if (!impl_->symbolic) throw std::logic_error("KLU refuses the pattern of the linear system");
}

bool KluSolver::factor(const KktValues& values) {
  if (impl_->matrix.size() == 0) return true;
  if (!impl_->matrix.set(values)) {
    klu_free_numeric(&impl_->numeric, &impl_->common);
    return false;
  }
  if (impl_->refactor()) return true;
  klu_free_numeric(&impl_->numeric, &impl_->common);
  impl_->numeric = klu_factor(impl_->starts(), impl_->rows(), impl_->matrix.values().data(),
                              impl_->symbolic, &impl_->common);
  return impl_->numeric != nullptr && impl_->common.status == KLU_OK;
}

void KluSolver::solve(Vec& x) const {
  if (x.size() == 0) return;
  klu_solve(impl_->symbolic, impl_->numeric, impl_->matrix.size(), 1, x.data(), &impl_->common);
}

void KluSolver::solve_transposed(Vec& x) const {
  if (x.size() == 0) return;
  klu_tsolve(impl_->symbolic, impl_->numeric, impl_->matrix.size(), 1, x.data(), &impl_->common);
}

double KluSolver::factor_flops() const {
  return impl_->symbolic ? impl_->symbolic->est_flops : 0.0;
}

}  // namespace polhode
