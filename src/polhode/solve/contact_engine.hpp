// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>

#include <polhode/solve/newton_system.hpp>

namespace polhode {

/// Newton iterations of bodies, joints and contacts between bodies: one sparse matrix whose pairs
/// are those of the interactions and those of bodies that may touch. The matrix is analysed anew
/// when these change. Increments are held back so that nothing passes through.
class ContactEngine final : public NewtonEngine {
 public:
  /// @param system  Must have contacts(). @param solver  "block_lu", "klu" or "sparse_lu".
  ContactEngine(const System& system, const std::string& solver,
                MomentumRate form = MomentumRate::momentum);
  [[nodiscard]] std::string name() const override { return "contact + " + solver_->name(); }
  void begin_step(const State& state, Trial& trial) override;
  Iteration iterate(const State& state, Trial& trial, bool refactor, double damping) override;
  [[nodiscard]] ConstraintCheck check(const State& state, Trial& trial) override;
  [[nodiscard]] int worst_body() const override { return worst_body_; }
  [[nodiscard]] std::string worst_other() const override { return contacts_->tightest(); }
  [[nodiscard]] bool may_grow() const override { return true; }
  void add_ground_wrench(double* force, double* moment) const override;
  void end_step(const State& state, Trial& trial) override;
  [[nodiscard]] double stored(const State& state) const override;
  Work commit(State& state, const Trial& trial) override;
  VelocityJump settle_impacts(State& state, const Trial& trial) override;

  [[nodiscard]] int analyses() const { return analyses_; }

 private:
  void take_steps(const State& state, const Trial& trial);
  void set_up();
  [[nodiscard]] bool up_to_date() const;
  void assemble(const State& state, const Trial& trial, bool tangent);
  [[nodiscard]] double merit() const;
  bool solve(const State& state, const Trial& trial, bool refactor);
  [[nodiscard]] std::vector<VelocityRow> joint_rows(const State& state, const Trial& trial) const;

  const System* system_;
  MovingContacts* contacts_;
  MomentumRate form_;
  std::unique_ptr<LinearSolver> solver_;
  std::optional<NewtonSystem> newton_;
  std::size_t static_pairs_ = 0;
  std::vector<Participants> known_;  ///< Pairs the matrix was analysed for.
  std::vector<int> place_;  ///< By contact pair: its pair of the matrix, or −1 (one side stands).
  std::vector<BodyStep> steps_;
  std::vector<PairTerms> terms_;
  std::vector<Vec6> increments_;
  std::vector<VelocityRow> rows_;
  Vec x_, rhs_;
  Vec3 ground_force_ = Vec3::Zero(), ground_moment_ = Vec3::Zero();
  bool factored_ = false, touches_ = false;
  int worst_body_ = -1, analyses_ = 0;
};

}  // namespace polhode
