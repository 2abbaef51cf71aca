// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include <polhode/linear/kkt.hpp>

namespace polhode::linear {

/// SuiteSparse KLU: a general sparse LU with a single symbolic analysis. Pivots are reused from one
/// factorisation to the next as long as the factors do not grow.
[[nodiscard]] std::unique_ptr<LinearSolver> make_klu_solver();

/// Eigen's supernodal SparseLU with partial pivoting over all rows: slow and reliable, a reference
/// for the others. Its factor_flops() follow from the entries of the last factors: zero before the
/// first factorisation.
[[nodiscard]] std::unique_ptr<LinearSolver> make_sparse_lu();

}  // namespace polhode::linear
