// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include <polhode/solve/kkt.hpp>

namespace polhode {

/// Eigen's supernodal SparseLU with partial pivoting over all rows: slow and trustworthy, a
/// reference for the others.
class SparseLu final : public LinearSolver {
 public:
  SparseLu();
  ~SparseLu() override;
  [[nodiscard]] std::string name() const override { return "sparse_lu"; }
  void analyse(const KktTopology& topology) override;
  [[nodiscard]] bool factor(const KktValues& values) override;
  void solve(Vec& x) const override;
  void solve_transposed(Vec& x) const override;
  /// From the entries of the last factors: zero before the first factorisation.
  [[nodiscard]] double factor_flops() const override;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace polhode
