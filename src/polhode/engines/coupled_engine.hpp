// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>

#include <polhode/equations/body_contact_assembler.hpp>
#include <polhode/equations/iterate_snapshot.hpp>
#include <polhode/equations/newton_system.hpp>
#include <polhode/equations/node_condensation.hpp>

namespace polhode {

/// Policies for the factorisation of the nodes of solids.
enum class NodeFactor {
  automatic,        ///< Few unknowns: every iteration. Many: as long as it converges well.
  every_iteration,  ///< Full Newton.
  reuse,            ///< Reuses the factorisation, rotated with the solids' bodies.
};

/// Newton iterations of bodies, joints, deformable solids and contacts between bodies: one system
/// of equations, from which the nodes are eliminated first. The rest is solved by one of the sparse
/// solvers, whose matrix is analysed again when other bodies may be in contact. Near contacts
/// increments are limited so that no shapes pass through each other, and shortened until the
/// residual decreases.
class CoupledEngine final : public NewtonEngine {
 public:
  /// @param solver  Of bodies and joints: "block_lu", "klu" or "sparse_lu".
  CoupledEngine(const System& system, const std::string& solver, MomentumRate form,
                NodeFactor policy = NodeFactor::automatic);
  [[nodiscard]] std::string name() const override {
    return (touching_ ? "contact + mumps + " : "mumps + ") + solver_->name();
  }
  void begin_step(const State& state, Trial& trial) override;
  void resume(const State& state, Trial& trial) override;
  Iteration iterate(const State& state, Trial& trial, bool refactor, double damping) override;
  [[nodiscard]] ConstraintCheck check(const State& state, Trial& trial) override;
  [[nodiscard]] int worst_body() const override { return worst_body_; }
  [[nodiscard]] std::string worst_other() const override;
  [[nodiscard]] bool keeps_factor() const override { return reuse_; }
  [[nodiscard]] bool may_grow() const override { return touching_.has_value(); }
  void end_step(const State& state, Trial& trial) override;
  void add_ground_wrench(double* force, double* moment) const override;
  [[nodiscard]] double stored(const State& state) const override;
  Work commit(State& state, const Trial& trial) override;
  [[nodiscard]] BodyContacts* contacts() const override {
    return touching_ ? touching_->contacts() : nullptr;
  }

  [[nodiscard]] int analyses() const { return analyses_; }  ///< Of the bodies' matrix.
  [[nodiscard]] int factorisations() const { return factorisations_; }
  [[nodiscard]] double factor_entries() const {
    return condensation_.factorisation().factor_entries();
  }
  [[nodiscard]] const NewtonSystem& bodies() const { return newton_; }
  [[nodiscard]] const NodeSystem& nodes() const { return nodes_; }

 private:
  void set_up();
  [[nodiscard]] bool must_factor(const Trial& trial, bool refactor) const;
  /// Evaluates forces of elements at the iterate, with shorter increments if elements are inverted.
  [[nodiscard]] bool take_elements(const State& state, Trial& trial, bool factor, Iteration& done);
  /// Solves for increments of bodies, rows and nodes.
  [[nodiscard]] bool solve(const State& state, const Trial& trial);
  /// R·M⁻¹R of bodies, rows and nodes, whose residuals have been assembled.
  [[nodiscard]] double merit(const State& state, const Trial& trial);
  void apply(const State& state, Trial& trial, Iteration& done);
  void move(const State& state, Trial& trial, double damping, Iteration& done);
  void move_nodes(const State& state, Trial& trial, double damping, Iteration& done);
  void shift_nodes(const State& state, Trial& trial) const;
  void retreat(const State& state, Trial& trial, double part);

  const System* system_;
  NodeCondensation condensation_;
  NodeSystem nodes_;
  NewtonSystem newton_;
  std::optional<BodyContactAssembler> touching_;  ///< If bodies may be in contact.
  bool searches_ = false;                         ///< Line search on the merit.
  std::unique_ptr<linear::LinearSolver> solver_;
  std::vector<Vec6> shares_;
  std::vector<double> du_;
  Vec x_, rhs_;
  IterateSnapshot before_;  ///< The previous iterate, as long as increments are large.
  double part_ = 1.0;       ///< Applied part of x_.
  bool reuse_ = false;
  double factored_dt_ = 0.0;
  int step_iterations_ = 0;
  double last_increment_ = 0.0, contraction_ = 0.0;
  int factorisations_ = 0, analyses_ = 0;
  int worst_body_ = -1, worst_node_ = -1;
};

}  // namespace polhode
