// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <Eigen/Sparse>

#include <polhode/core/types.hpp>

namespace polhode {

/// Derivatives of inputs by parameters, one column for each.
inline Eigen::SparseMatrix<double> sparse_inputs(
    int rows, std::size_t columns, const std::vector<Eigen::Triplet<double>>& entries) {
  Eigen::SparseMatrix<double> matrix(rows, static_cast<Eigen::Index>(columns));
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

/// Their columns, or with a direction of the parameters the only one along it.
inline Mat in_directions(const Eigen::SparseMatrix<double>& by, const Vec* direction) {
  return direction ? Mat(by * *direction) : Mat(by);
}

}  // namespace polhode
