// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>

#include <polhode/engines/condensed_nodes.hpp>
#include <polhode/engines/unilateral_rows.hpp>
#include <polhode/equations/body_contact_assembler.hpp>
#include <polhode/equations/iterate_snapshot.hpp>
#include <polhode/equations/newton_engine.hpp>
#include <polhode/equations/newton_system.hpp>

namespace polhode {

/// Newton iterations with one sparse matrix of all bodies and all multipliers, with any of the
/// linear solvers: the reference for the elimination along the tree, and its fallback. Where the
/// system has deformable solids, their nodes are eliminated first. Where bodies may be in contact,
/// the matrix has their pairs as well, and is analysed again when these change; increments are
/// limited so that no shapes pass through each other. Contacts that are rows have no pairs: the
/// response of the bodies to each row is solved for. With contact between bodies or
/// between deformable surfaces a line search reduces the residual.
class SparseEngine final : public NewtonEngine {
 public:
  /// @param solver  Of bodies and joints: "block_lu", "klu" or "sparse_lu". @throws InputError for
  ///                any other.
  SparseEngine(const System& system, const std::string& solver,
               MomentumRate form = MomentumRate::momentum,
               NodeFactor policy = NodeFactor::automatic);
  [[nodiscard]] std::string name() const override;
  /// Null with deformable solids and contacts, whose searches have memories.
  [[nodiscard]] std::unique_ptr<NewtonEngine> another() const override;
  void begin_step(const State& state, Trial& trial) override;
  void resume(const State& state, Trial& trial) override;
  void set_proximal(double epsilon) override { newton_.set_proximal(epsilon); }
  Iteration iterate(const State& state, Trial& trial, bool refactor, double damping) override;
  [[nodiscard]] ConstraintCheck check(const State& state, Trial& trial) override;
  [[nodiscard]] int worst_body() const override { return worst_body_; }
  [[nodiscard]] std::string worst_other() const override;
  [[nodiscard]] bool keeps_factor() const override { return nodes_ && nodes_->reuses_factor(); }
  [[nodiscard]] bool may_grow() const override { return contacts_ || rows_; }
  void end_step(const State& state, Trial& trial) override;
  void add_ground_wrench(double* force, double* moment) const override;
  [[nodiscard]] double stored(const State& state) const override;
  Work commit(State& state, const Trial& trial) override;
  [[nodiscard]] BodyContacts* contacts() const override {
    return contacts_ ? contacts_->contacts() : rows_ ? rows_->contacts() : nullptr;
  }

  /// The system as last assembled: residuals by body and by row, without solids and contacts.
  [[nodiscard]] const NewtonSystem& assembled() const { return newton_; }
  [[nodiscard]] const linear::LinearSolver& solver() const { return *solver_; }
  /// Nodes of solids, null without any.
  [[nodiscard]] const CondensedNodes* nodes() const { return nodes_ ? &*nodes_ : nullptr; }

 private:
  void set_up();
  /// Evaluates the nodes, with a shorter last increment if elements are inverted, and factors their
  /// tangent if `factor`.
  [[nodiscard]] bool prepare_nodes(const State& state, Trial& trial, bool factor, Iteration& done);
  void assemble(const State& state, const Trial& trial, bool tangent);
  /// Solves for increments of bodies, rows and nodes.
  [[nodiscard]] bool solve(const State& state, const Trial& trial, bool refactor);
  void move(const State& state, Trial& trial, Iteration& done);
  void search(const State& state, Trial& trial, Iteration& done);
  /// Returns to this part of the increment from the previous iterate.
  void retreat(const State& state, Trial& trial, double part, Iteration& done);

  const System* system_;
  NewtonSystem newton_;
  std::unique_ptr<linear::LinearSolver> solver_;
  std::optional<CondensedNodes> nodes_;
  std::optional<BodyContactAssembler> contacts_;
  std::optional<UnilateralRows> rows_;
  bool searches_ = false;  ///< Line search on the merit.
  Vec rhs_, x_;
  IterateSnapshot before_;  ///< The previous iterate, as long as increments are large.
  double part_ = 1.0;       ///< Applied part of x_.
  bool factored_ = false;
  int pair_changes_ = 0;  ///< Of nodes_, at the last set_up().
  int worst_body_ = -1;
};

}  // namespace polhode
