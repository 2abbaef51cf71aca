// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <polhode/core/types.hpp>

namespace polhode::linear {

/// One coupling of the linear system: an interaction between a and b (kGround: that side is
/// absent) with `rows` multiplier rows, the first of which is row `first_row`. Pairs of one row
/// each may have the same one: its columns, rows and C are the sums of theirs.
struct KktPair {
  int a = kGround, b = kGround;
  int rows = 0, first_row = 0;
};

/// Block pattern of the linear system; fixed during a run.
struct KktTopology {
  int bodies = 0, rows = 0;
  std::vector<KktPair> pairs;
  bool fused = true;  ///< Products and sums may be rounded once, where the processor can.
};

/// Values of the linear system of a Newton iteration, or of the start:
///
///   [ K  −B ] [ x ]   [ rhs ]      x: (Δr, Δθ) by body, 6 each;  y: one per multiplier row
///   [ G   C ] [ y ] = [     ]
///
/// K has the bodies' 6×6 diagonal blocks (all contributions summed) and the pairs' off-diagonal
/// ones; C is diagonal (proximal ε or compliance). Only the first pair.rows columns of B and rows
/// of G are used.
struct KktValues {
  struct Pair {
    Mat6 K_ab, K_ba;
    Eigen::Matrix<double, 6, 6> B_a, B_b;
    Eigen::Matrix<double, 6, 6, Eigen::RowMajor> G_a, G_b;
    Vec6 C;
  };
  std::vector<Mat6> diagonal;  ///< By body.
  std::vector<Pair> pairs;     ///< By pair of the topology.
};

/// A direct solver for the linear system, with a single symbolic analysis for many sets of values.
class LinearSolver {
 public:
  virtual ~LinearSolver() = default;
  [[nodiscard]] virtual std::string name() const = 0;
  virtual void analyse(const KktTopology& topology) = 0;
  /// @returns false if a pivot is zero or a value is not finite.
  [[nodiscard]] virtual bool factor(const KktValues& values) = 0;
  /// In place: right-hand side in, solution out; bodies (6 each), then rows.
  virtual void solve(Vec& x) const = 0;
  /// Solves with the transposed matrix (sensitivities).
  virtual void solve_transposed(Vec& x) const = 0;
  /// Floating-point operations of one factorisation, counted at analyse().
  [[nodiscard]] virtual double factor_flops() const = 0;
};

/// Solver "block_lu", "klu" or "sparse_lu". @throws InputError for any other name.
[[nodiscard]] std::unique_ptr<LinearSolver> make_linear_solver(const std::string& name);

}  // namespace polhode::linear
