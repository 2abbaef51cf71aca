// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <polhode/engines/tree_loops.hpp>
#include <polhode/equations/newton_engine.hpp>
#include <polhode/equations/newton_system.hpp>
#include <polhode/kernels/dispatch.hpp>

namespace polhode {

/// Newton iterations by elimination along the tree: the same equations and iterates as the sparse
/// engine with the momentum form, in two sweeps over the bodies.
/// Derivation: docs/theory/elimination_along_the_tree.md.
class TreeEngine final : public NewtonEngine {
 public:
  /// @param isa  See lane_kernels().
  explicit TreeEngine(const System& system, const std::string& isa = "automatic");

  [[nodiscard]] std::string name() const override { return "tree"; }
  [[nodiscard]] std::unique_ptr<NewtonEngine> another() const override {
    return std::make_unique<TreeEngine>(*system_, kernels_->name);
  }
  void begin_step(const State& state, Trial& trial) override;
  void set_proximal(double epsilon) override { view_.proximal = epsilon; }
  void store_multipliers(Trial& trial) override;
  void load_multipliers(const Trial& trial) override;
  [[nodiscard]] bool has_centre(int interaction) const override {
    return system_->tree().in_tree[interaction] == 0;
  }
  Iteration iterate(const State& state, Trial& trial, bool refactor, double damping) override;
  [[nodiscard]] ConstraintCheck check(const State& state, Trial& trial) override;
  void add_ground_wrench(double* force, double* moment) const override {
    kernels_->ground(&view_, system_->tree().body_of_slot.data(), force, moment);
  }
  [[nodiscard]] bool knows_ground(int interaction) const override {
    return system_->tree().in_tree[interaction] != 0;
  }
  void end_step(const State& state, Trial& trial) override;

  [[nodiscard]] const char* instruction_set() const { return kernels_->name; }
  /// Floating-point operations of one iteration, to choose between solvers.
  [[nodiscard]] double flops() const { return plan_.flops; }
  [[nodiscard]] const TreeLoopPlan& plan() const { return plan_; }
  /// Body with the largest increment of the last iteration.
  [[nodiscard]] int worst_body() const override;
  /// Bytes of memory the engine holds.
  [[nodiscard]] std::size_t memory() const;

 private:
  void lay_out();
  /// Offset of a body's SIMD lane in the trial, in doubles; −1: the ground's.
  [[nodiscard]] int trial_offset(int slot) const;
  void lay_out_loop_joints();
  void fill_joint_constants();
  void set_step(const State& state, Trial& trial);
  /// Updates the steps of bodies with off-tree interactions; `first`: of the whole step, else only
  /// at t_{n+1}.
  void take_steps(const State& state, const Trial& trial, bool first);
  void evaluate_extras(const State& state, const Trial& trial);
  void add_extra(const OffTreeInteraction& x, const PairTerms& terms, const Trial& trial);
  void write_loop(const OffTreeInteraction& x, const PairTerms& terms, const Trial& trial);
  void write_couple(const OffTreeInteraction& x, const PairTerms& terms, const double* softness);
  void write_coupling(const OffTreeInteraction& x, const PairTerms& terms);
  void move_multipliers(Trial& trial, double damping);
  template <class Move>
  void for_each_tree_joint(Move&& move);

  const System* system_;
  const LaneKernels* kernels_;
  TreeLoopPlan plan_;
  InteractionSweep sweep_;        ///< Of interactions outside both the tree and LoopJoints.
  InteractionSweep beside_rows_;  ///< Of joints of the tree that act beside their rows.
  std::vector<BodyStep> steps_;   ///< By body, the ground last; only where needed.
  std::vector<int> touched_;      ///< Bodies of those.
  /// Multipliers of direction rows by a loop joint's couple.
  struct Couple {
    Mat3 dual, by_a, by_b;
  };
  std::vector<Couple> couples_;
  bool rates_ = false;            ///< Some off-tree interaction may need velocities at t_{n+1}.
  bool loops_outside_ = false;    ///< Some loop is not among LoopJoints.
  std::vector<int> extra_index_;  ///< By interaction: index into plan_.extras.
  TreeView view_;

  // Storage behind the view.
  std::vector<int> slot_in_order_, parent_, gather_, shape_, y_row_, joint_;
  std::vector<unsigned char> has_children_, first_child_;
  /// Location of a tree joint's multipliers: in joint_data_, in doubles, and in the trial.
  struct TreeJoint {
    int lambda, first_row, rows;
  };
  std::vector<TreeJoint> tree_joints_;
  std::vector<MassBlock> mass_;
  struct alignas(64) LaneData {
    double x[8];
  };
  std::vector<LoopJoints> loop_joints_;
  std::vector<LaneData> joint_data_, loop_data_, Y_, pair_, kept_, S_, nu_, y_, U_;
  std::vector<int> pivots_;
  std::vector<EliminatedBody> body_;
  std::vector<ExtraRows> extra_rows_;
  std::vector<EdgeRows> edge_rows_;
};

/// Mass properties by slot, for kernels that need nothing else.
[[nodiscard]] std::vector<MassBlock> mass_blocks(const System& system);
/// Writes a joint's points, directors and slides into its SIMD lane of joint data.
void put_joint_constants(const MotionBasis& basis, const JointLayout& l, double* lane);

}  // namespace polhode
