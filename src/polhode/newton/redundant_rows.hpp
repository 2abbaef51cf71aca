// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include <polhode/linear/kkt.hpp>
#include <polhode/system/pair_terms.hpp>

namespace polhode {

/// ε where forces depend on redundant reactions: square of the singular value of the dimensionless
/// rows below which they count as dependent. Rounding of the redundant part is divided by it.
inline constexpr double kLeastProximal = 1e-10;

/// Constraint rows G at one configuration, and what is redundant in numbers by row, by the
/// saddle-point matrix of their least-squares problems,
///
///   [ M  −Gᵀ ]      M = 1 for displacements, ℓ² for rotations,
///   [ G   εW ]      W the weights of the norm.
class RedundantRows {
 public:
  /// @param topology  Of the rows; it must outlive this.
  RedundantRows(const linear::KktTopology& topology, double length);

  /// Sets rows and values of a pair of the topology.
  void put(int pair, const PairTerms& terms);
  /// Takes the rows of others, with ε = 0 in pairs whose entry is zero.
  void put(const RedundantRows& others, const std::vector<char>& has_centre);
  /// @returns false if a value is not finite.
  [[nodiscard]] bool factor() { return solver_->factor(values_); }

  /// Part of multipliers in addition to those of smallest norm with the same wrenches, zero for
  /// springs.
  void redundant_part(const Eigen::Ref<const Vec>& of, Eigen::Ref<Vec> out);
  /// Part of the row values g that no motion can change, on rows with ε > 0.
  void unreachable_part(Eigen::Ref<Vec> out);
  /// εW of a row; 1 for springs and rows that are switched off.
  [[nodiscard]] double softness(int pair, int k) const {
    return values_.pairs[static_cast<std::size_t>(pair)].C[k];
  }

 private:
  /// Adds G of the bodies' part of `all` with a factor.
  void add_rows_times(const Vec& all, double factor, Eigen::Ref<Vec> out) const;
  /// Adds Gᵀ of numbers by row.
  void add_columns_times(const Eigen::Ref<const Vec>& rows, Vec& out) const;

  const linear::KktTopology* topology_;
  std::unique_ptr<linear::LinearSolver> solver_;
  linear::KktValues values_;
  Vec g_, rhs_, x_;
};

}  // namespace polhode
