// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include <polhode/equations/newton_system.hpp>

namespace polhode {

/// Moves bodies and multipliers by the solution x of a NewtonSystem, damped; `worst` is the body
/// with the largest increment. @eq{eq:ga-Newton-iterations}
void apply_increments(const System& system, const State& state, Trial& trial, const Vec& x,
                      double damping, Iteration& done, int& worst);

/// Newton iterations with one sparse matrix of all bodies and all multipliers, with any of the
/// linear solvers: the reference for the elimination along the tree, and its fallback.
class SparseEngine final : public NewtonEngine {
 public:
  /// @param solver  "block_lu", "klu" or "sparse_lu". @throws InputError for any other.
  SparseEngine(const System& system, const std::string& solver,
               MomentumRate form = MomentumRate::momentum);
  [[nodiscard]] std::string name() const override { return solver_->name(); }
  void begin_step(const State& state, Trial& trial) override;
  Iteration iterate(const State& state, Trial& trial, bool refactor, double damping) override;
  [[nodiscard]] ConstraintCheck check(const State& state, Trial& trial) override;
  [[nodiscard]] int worst_body() const override { return worst_body_; }
  void end_step(const State& state, Trial& trial) override;

  /// The system as last assembled: residuals by body and by row, for reports.
  [[nodiscard]] const NewtonSystem& assembled() const { return newton_; }
  [[nodiscard]] const linear::LinearSolver& solver() const { return *solver_; }

 private:
  NewtonSystem newton_;
  std::unique_ptr<linear::LinearSolver> solver_;
  Vec x_;
  bool factored_ = false;
  int worst_body_ = -1;
};

}  // namespace polhode
