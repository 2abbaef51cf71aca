// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include <polhode/equations/body_contact_assembler.hpp>
#include <polhode/equations/newton_system.hpp>

namespace polhode {

/// Newton iterations of bodies, joints and contacts between bodies. One sparse matrix has the pairs
/// of the interactions and those of bodies that may be in contact; it is analysed again when these
/// change. Increments are limited so that no shapes pass through each other.
class ContactEngine final : public NewtonEngine {
 public:
  /// @param system  Must have contacts(). @param solver  "block_lu", "klu" or "sparse_lu".
  ContactEngine(const System& system, const std::string& solver,
                MomentumRate form = MomentumRate::momentum);
  [[nodiscard]] std::string name() const override { return "contact + " + solver_->name(); }
  void begin_step(const State& state, Trial& trial) override;
  void resume(const State&, Trial&) override {}
  Iteration iterate(const State& state, Trial& trial, bool refactor, double damping) override;
  [[nodiscard]] ConstraintCheck check(const State& state, Trial& trial) override;
  [[nodiscard]] int worst_body() const override { return worst_body_; }
  [[nodiscard]] std::string worst_other() const override {
    return touching_.contacts()->tightest();
  }
  [[nodiscard]] bool may_grow() const override { return true; }
  void add_ground_wrench(double* force, double* moment) const override {
    touching_.add_ground_wrench(force, moment);
  }
  void end_step(const State& state, Trial& trial) override { touching_.end_step(state, trial); }
  [[nodiscard]] double stored(const State& state) const override { return touching_.stored(state); }
  Work commit(State& state, const Trial& trial) override { return touching_.commit(state, trial); }
  [[nodiscard]] BodyContacts* contacts() const override { return touching_.contacts(); }

  [[nodiscard]] int analyses() const { return analyses_; }

 private:
  void set_up();
  void assemble(const State& state, const Trial& trial, bool tangent);
  bool solve(const State& state, const Trial& trial, bool refactor);

  const System* system_;
  BodyContactAssembler touching_;
  std::unique_ptr<linear::LinearSolver> solver_;
  NewtonSystem newton_;
  Vec x_, rhs_;
  bool factored_ = false;
  int worst_body_ = -1, analyses_ = 0;
};

}  // namespace polhode
