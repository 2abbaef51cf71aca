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

/// When the nodes of solids are factored anew.
enum class NodeFactor {
  automatic,        ///< Few unknowns: every iteration. Many: as long as it converges well.
  every_iteration,  ///< Newton proper.
  reuse,            ///< Keeps the factorisation, turned with the solids' bodies.
};

/// Newton iterations of bodies, joints, deformable solids and contacts between bodies: one system
/// of equations, from which the nodes are eliminated first. The rest goes to one of the sparse
/// solvers, whose matrix is analysed anew when other bodies may touch. Where bodies touch,
/// increments are held back so that nothing passes through, and shortened until the residual falls.
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
  /// Forces of elements at the iterate, which is retreated from where it turns one inside out.
  [[nodiscard]] bool take_elements(const State& state, Trial& trial, bool factor, Iteration& done);
  /// Increments of bodies, rows and nodes.
  [[nodiscard]] bool solve(const State& state, const Trial& trial);
  /// R·M⁻¹R of bodies, rows and nodes, whose residuals have been assembled.
  [[nodiscard]] double merit(const State& state, const Trial& trial);
  /// Takes back as much of the increment as raises the merit.
  void search(const State& state, Trial& trial, double before, Iteration& done);
  void move(const State& state, Trial& trial, double damping, Iteration& done);
  void move_nodes(const State& state, Trial& trial, double damping, Iteration& done);
  void shift_nodes(const State& state, Trial& trial) const;
  void retreat(const State& state, Trial& trial, double part);

  const System* system_;
  NodeCondensation condensation_;
  NodeSystem nodes_;
  NewtonSystem newton_;
  std::optional<BodyContactAssembler> touching_;  ///< If bodies may touch.
  bool searches_ = false;                         ///< Line search on the merit, see MeritSearch.
  std::unique_ptr<LinearSolver> solver_;
  std::vector<Vec6> shares_;
  std::vector<double> du_;
  Vec x_, rhs_;
  IterateSnapshot before_;  ///< The iterate before, as long as increments are large.
  double part_ = 1.0;       ///< Of x_ that was applied to it.
  bool reuse_ = false;
  double factored_dt_ = 0.0;
  int step_iterations_ = 0;
  double last_increment_ = 0.0, contraction_ = 0.0;
  int factorisations_ = 0, analyses_ = 0;
  int worst_body_ = -1, worst_node_ = -1;
};

}  // namespace polhode
