// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

namespace polhode {

/// MUMPS (Amestoy, Duff, L'Excellent, Koster 2001), sequential: multifrontal factorisation of the
/// sparse matrices of solids. The library is loaded when the first object is made, so that models
/// without solids do not wait for it; its BLAS is kept to one thread, so that bits do not depend
/// on the machine.
class Mumps {
 public:
  enum class Symmetry { none, symmetric };

  /// @throws InputError if the library is not installed.
  explicit Mumps(Symmetry symmetry = Symmetry::none);
  ~Mumps();
  Mumps(Mumps&&) noexcept;

  /// Symbolic work. Entries are given by rows and columns counted from zero; entries of the same
  /// place are summed. Of a symmetric matrix one triangle.
  /// @throws std::runtime_error if the matrix is structurally singular.
  void analyse(int n, const std::vector<int>& rows, const std::vector<int>& columns);
  /// Values in the order of the entries. @returns false if the matrix is singular.
  [[nodiscard]] bool factor(const double* values);
  /// In place, `count` right-hand sides one after the other.
  void solve(double* x, int count = 1) const;
  /// The same with the transposed matrix.
  void solve_transposed(double* x, int count = 1) const;

  [[nodiscard]] int negative_pivots() const;    ///< Of a symmetric matrix.
  [[nodiscard]] double factor_flops() const;    ///< Of the last factorisation.
  [[nodiscard]] double factor_entries() const;  ///< Numbers in the factors.
  /// Looks for null pivots and tells the unknowns they belong to (before factor()).
  void find_null_pivots(bool yes);
  [[nodiscard]] std::vector<int> null_pivots() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace polhode
