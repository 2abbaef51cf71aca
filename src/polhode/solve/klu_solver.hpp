// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include <polhode/solve/kkt.hpp>

namespace polhode {

/// SuiteSparse KLU: a general sparse LU whose symbolic work is done once. Pivots are kept from
/// one factorisation to the next as long as the factors do not grow.
class KluSolver final : public LinearSolver {
 public:
  KluSolver();
  ~KluSolver() override;
  [[nodiscard]] std::string name() const override { return "klu"; }
  void analyse(const KktTopology& topology) override;
  [[nodiscard]] bool factor(const KktValues& values) override;
  void solve(Vec& x) const override;
  void solve_transposed(Vec& x) const override;
  [[nodiscard]] double factor_flops() const override;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace polhode
