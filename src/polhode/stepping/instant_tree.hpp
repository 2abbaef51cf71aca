// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <polhode/engines/tree_loops.hpp>
#include <polhode/equations/newton_system.hpp>
#include <polhode/kernels/dispatch.hpp>
#include <polhode/kernels/instant_data.hpp>
#include <polhode/stepping/instant.hpp>

namespace polhode {

/// Velocities, accelerations and multipliers at an instant by elimination along the tree: the
/// results of InstantSolver to round-off, in about the time of an iteration of TreeEngine.
///
/// The matrix is factored once for both. Without loops joints hold exactly. With loops every row
/// has the same ε as in InstantSolver, and the same iterations on it, so that the multipliers of
/// redundant rows are the smallest ones, too.
/// Derivation: docs/theory/elimination_along_the_tree.md, "At an instant".
class InstantTree {
 public:
  /// Whether a system can be solved: not with deformable solids, masses that couple the
  /// accelerations of two bodies, or friction that depends on redundant reactions.
  [[nodiscard]] static bool takes(const System& system);
  /// @param system  That it takes.
  explicit InstantTree(const System& system, const LaneKernels& kernels);

  /// Projects the velocities onto G v = 0 as InstantSolver::project_velocities(), then computes
  /// accelerations and multipliers as InstantSolver::accelerations().
  /// @param state  In: a state; out: with projected velocities.
  /// @param more  Further wrenches by body; may be empty. World, about the centres of mass [N, N
  /// m].
  /// @param velocities  Out: residuals before and after, scale, and number of solutions.
  /// @returns false if the matrix cannot be factored or a value is not finite.
  [[nodiscard]] bool solve(State& state, std::span<const Vec6> more, VelocityReport& velocities,
                           InstantSolution& solution);

 private:
  struct Outcome {
    bool solved = false, consistent = true;
    double residual = 0.0;
    int solves = 0;
  };
  struct alignas(64) LaneData {
    double x[8];
  };

  void lay_out();
  void lay_out_loop_joints();
  /// Solves for the present values and loads.
  Outcome solve_rows(double load_scale);
  /// Makes the multipliers the centres, or clears these.
  void move_centres(bool clear);
  void take_steps(const State& state);
  /// Puts Gᵀ of an interaction outside the lanes, and the softness of its rows.
  void put_rows(const OffTreeInteraction& x, const PairTerms& terms);
  /// Rates of the rows outside the lanes, and their G.
  void add_rates(const State& state, InstantRates& rates);
  /// Forces and γ outside the lanes.
  void add_forces(const State& state, std::vector<double>& lambda);
  /// Rates that a drive prescribes for its rows after the instant.
  [[nodiscard]] Vec6 prescribed_rates(const State& state, const InteractionRef& ref) const;

  const System* system_;
  const InstantKernels* kernels_;
  TreeLoopPlan plan_;
  InteractionSweep sweep_;  ///< Of interactions outside both the tree and LoopJoints.
  StepContext context_;
  std::vector<BodyStep> steps_;   ///< By body, the ground last; only where needed.
  std::vector<int> touched_;      ///< Bodies of those.
  std::vector<int> extra_index_;  ///< By interaction: index into plan_.extras.
  bool rows_outside_ = false;     ///< Some row is neither of the tree nor of LoopJoints.
  std::vector<double> no_lambda_;
  InstantView view_;

  // Storage behind the view.
  std::vector<MassBlock> mass_;
  std::vector<int> shape_, order_, parent_, gather_, joint_;
  std::vector<LaneData> joint_data_, loop_constants_, pair_, kept_, S_;
  std::vector<InstantBlock> motion_;
  std::vector<JointLanes> lanes_;
  std::vector<InstantBody> body_;
  std::vector<InstantLoop> loop_;
  std::vector<LoopJoints> loop_joints_;
  /// Multipliers of joints in lanes: their place in `lanes_` or `loop_`, in doubles apart by
  /// `apart`, and their rows.
  struct Multipliers {
    const double* from;
    int apart, first_row, rows;
  };
  std::vector<Multipliers> multipliers_;
};

}  // namespace polhode
