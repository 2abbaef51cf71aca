// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include <polhode/solve/kept_iterate.hpp>
#include <polhode/solve/newton_system.hpp>
#include <polhode/solve/node_condensation.hpp>

namespace polhode {

/// When the nodes of solids are factored anew.
enum class NodeFactor {
  automatic,        ///< Few unknowns: every iteration. Many: as long as it converges well.
  every_iteration,  ///< Newton proper.
  reuse,            ///< Keeps the factorisation, turned with the solids' bodies.
};

/// Newton iterations of bodies, joints and deformable solids: one system of equations, from which
/// the nodes are eliminated first. Bodies and joints go to one of the sparse solvers.
class CoupledEngine final : public NewtonEngine {
 public:
  /// @param solver  Of bodies and joints: "block_lu", "klu" or "sparse_lu".
  CoupledEngine(const System& system, const std::string& solver, MomentumRate form,
                NodeFactor policy = NodeFactor::automatic);
  [[nodiscard]] std::string name() const override { return "mumps + " + solver_->name(); }
  void begin_step(const State& state, Trial& trial) override;
  Iteration iterate(const State& state, Trial& trial, bool refactor, double damping) override;
  [[nodiscard]] ConstraintCheck check(const State& state, Trial& trial) override;
  [[nodiscard]] int worst_body() const override { return worst_body_; }
  [[nodiscard]] std::string worst_other() const override;
  [[nodiscard]] bool keeps_factor() const override { return reuse_; }
  void end_step(const State& state, Trial& trial) override;

  [[nodiscard]] int factorisations() const { return factorisations_; }
  [[nodiscard]] double factor_entries() const {
    return condensation_.factorisation().factor_entries();
  }
  [[nodiscard]] const NewtonSystem& bodies() const { return newton_; }
  [[nodiscard]] const NodeSystem& nodes() const { return nodes_; }

 private:
  [[nodiscard]] bool must_factor(const Trial& trial, bool refactor) const;
  void move(const State& state, Trial& trial, double damping, Iteration& done);
  void move_nodes(const State& state, Trial& trial, double damping, Iteration& done);
  void shift_nodes(const State& state, Trial& trial) const;
  void retreat(const State& state, Trial& trial);

  NodeCondensation condensation_;
  NodeSystem nodes_;
  NewtonSystem newton_;
  std::unique_ptr<LinearSolver> solver_;
  std::vector<Vec6> shares_;
  std::vector<double> du_;
  Vec x_;
  KeptIterate before_;  ///< The iterate before, as long as increments are large.
  double part_ = 1.0;   ///< Of x_ that was applied to it.
  bool reuse_ = false;
  double factored_dt_ = 0.0;
  int step_iterations_ = 0;
  double last_increment_ = 0.0, contraction_ = 0.0;
  int factorisations_ = 0;
  int worst_body_ = -1, worst_node_ = -1;
};

}  // namespace polhode
