// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

namespace polhode::linear {

/// MUMPS (Amestoy, Duff, L'Excellent, Koster 2001), sequential: multifrontal factorisation of the
/// sparse matrices of solids. The library is loaded with the first object, so that models without
/// solids do not wait for it; its BLAS uses one thread, so that results do not depend on the
/// machine.
class Mumps {
 public:
  enum class Symmetry { none, symmetric };

  /// @throws InputError if the library is not installed; SolveError if a limit of the process
  /// leaves it too little memory.
  explicit Mumps(Symmetry symmetry = Symmetry::none);
  ~Mumps();
  Mumps(Mumps&&) noexcept;

  /// Symbolic analysis. Entries are given by rows and columns counted from zero; repeated entries
  /// are summed. For a symmetric matrix one triangle.
  /// @throws SolveError if the matrix is structurally singular.
  void analyse(int n, const std::vector<int>& rows, const std::vector<int>& columns);
  /// Factors the matrix with values in the order of the entries. @returns false if it is singular.
  [[nodiscard]] bool factor(const double* values);
  /// Solves in place, for `count` consecutive right-hand sides.
  void solve(double* x, int count = 1) const;
  /// Solves with the transposed matrix.
  void solve_transposed(double* x, int count = 1) const;

  [[nodiscard]] int negative_pivots() const;    ///< Of a symmetric matrix.
  [[nodiscard]] double factor_flops() const;    ///< Of the last factorisation.
  [[nodiscard]] double factor_entries() const;  ///< Number of entries of the factors.
  /// Enables the detection of null pivots and their unknowns (before factor()).
  void find_null_pivots(bool yes);
  [[nodiscard]] std::vector<int> null_pivots() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace polhode::linear
