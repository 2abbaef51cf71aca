// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include <polhode/solve/kkt.hpp>

namespace polhode {

/// Conjugate gradients for crowds of bodies that touch and have no joints.
///
/// Works on the symmetric part of the matrix, preconditioned by the inverse of each body's own 6×6
/// block: no fill, memory of the pairs only, and a few dozen iterations a solve, since what couples
/// touching bodies reaches only a few neighbours within one step. Solutions are inexact, so that
/// Newton converges linearly and not quadratically.
class ConjugateGradients final : public LinearSolver {
 public:
  /// @param tolerance  What is left of the right-hand side in the preconditioner's norm.
  explicit ConjugateGradients(double tolerance = 1e-2, int most_iterations = 300);
  [[nodiscard]] std::string name() const override { return "cg"; }
  /// @throws InputError for a topology with multiplier rows: the matrix is then not definite.
  void analyse(const KktTopology& topology) override;
  [[nodiscard]] bool factor(const KktValues& values) override;
  /// Stops where a direction of negative curvature appears, with what it has by then.
  void solve(Vec& x) const override;
  /// The matrix is symmetric here: as solve().
  void solve_transposed(Vec& x) const override { solve(x); }
  /// Of making the preconditioner.
  [[nodiscard]] double factor_flops() const override;
  /// Of all calls of solve() [-].
  [[nodiscard]] long iterations() const { return iterations_; }

 private:
  /// A 6×6 block by columns, each padded to 8 doubles.
  struct alignas(64) Block {
    double column[6][8];
  };
  struct Edge {
    int a = 0, b = 0;
  };
  static void put(Block& block, const Mat6& M);

  double tolerance_;
  int most_iterations_;
  int bodies_ = 0;
  std::vector<Edge> edges_;
  std::vector<std::size_t> pair_of_edge_;
  std::vector<Block> diagonal_, inverse_, upper_, lower_;  ///< By body; by edge.
  mutable std::vector<double> residual_, direction_, image_, preconditioned_, solution_;
  mutable long iterations_ = 0;
  bool fused_ = false;  ///< The processor has AVX2 and fused multiply-add.
};

}  // namespace polhode
