// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <polhode/engines/saddle_solver.hpp>
#include <polhode/equations/newton_system.hpp>
#include <polhode/statics/clarke_combination.hpp>
#include <polhode/statics/static_report.hpp>
#include <polhode/system/barrier_constraint.hpp>

namespace polhode {

/// How an equilibrium is looked for.
struct StaticOptions {
  int load_steps = 0;        ///< Equal parts of the load; 0: chosen by how well Newton converges.
  int max_iterations = 25;   ///< Before a load step is cut.
  double tolerance = 1e-10;  ///< What later increments would add up to, |Δr|/ℓ or |Δθ| [-].
  double residual = 1e-9;    ///< Part of the largest force that may stay unbalanced [-].
  bool mixed_point = true;   ///< Geometric stiffness by extrapolated stresses.
};

/// The motion that meets the least stiffness at an equilibrium.
struct SoftestMotion {
  double stiffness = 0.0;  ///< xᵀKx/xᵀx; negative where the equilibrium is unstable [N/m].
  std::string text;        ///< "'leg' moves freely, most at node 4"; empty: not found.
};

/// Newton's method for the equilibrium of bodies, joints, springs, beams and solids: one matrix of
/// all unknowns, no inertia, no velocities. Rotations are composed iteration by iteration, so that
/// a load step may turn bodies by any angle. Derivation: docs/theory/statics_and_modes.md.
class StaticNewton {
 public:
  StaticNewton(const System& system, const StaticOptions& options);

  /// Equilibrium of the state's bodies and nodes at a load factor; starts from `start` if given
  /// (a predicted state), else from the state itself. On failure the state is left as it was.
  StaticStep solve(State& state, double load_factor, const State* start = nullptr);

  /// The same by relaxation: the state creeps downhill in small steps, whatever is slack or gives
  /// way, until Newton's method finds the equilibrium near. Derivation: @eq{statics-relaxation}
  StaticStep relax(State& state, double load_factor);

  /// The tangent and residual at a state as it stands, all loads times the load factor.
  void assemble_at(const State& state, double load_factor);
  /// After assemble_at(): the same with K + rate·C in the place of K, C what forces gain with
  /// velocities, at rest [N s/m], and rate in 1/s.
  void assemble_with_rates(double rate);
  [[nodiscard]] SaddleMatrix& matrix() { return matrix_; }  ///< Scaled by scale().
  [[nodiscard]] const SaddleMatrix& tangent() const { return matrix_; }
  [[nodiscard]] double scale() const { return trial_.compliance_scale; }
  [[nodiscard]] const NewtonSystem& bodies() const { return newton_; }
  /// What holds bonded and prescribed nodes at the last equilibrium, three each [N].
  [[nodiscard]] const std::vector<double>& node_residual() const { return held_; }
  /// Part of the unbalanced forces at the last assembly: largest, and the largest force [N].
  void measure(StaticStep& step) const;
  [[nodiscard]] bool has_mixed_points() const { return mixed_; }
  /// At the equilibrium found last.
  [[nodiscard]] SoftestMotion softest();

 private:
  enum class Balance { off, within, rounded };  ///< Within the tolerance, or at rounding.
  void enter(double load_factor);
  void start_scratch(const State& state);
  ElementReport assemble();
  void choose_scale();
  [[nodiscard]] Balance balanced(StaticStep& step) const;
  [[nodiscard]] bool balanced_on_a_kink(StaticStep& step);
  [[nodiscard]] bool factor_and_solve(StaticStep& step);
  [[nodiscard]] bool factor(bool symmetric, StaticStep& step);
  [[nodiscard]] std::vector<double> all_diagonal(double stiffness) const;
  void solve_refined();
  void keep_free(std::vector<Vec> motions);
  void leave_out_free();
  [[nodiscard]] bool make_symmetric();
  [[nodiscard]] bool nearly_singular() const;
  std::vector<Vec> name_free_motions(StaticStep& step);
  void assemble_unmixed();
  void aim(std::vector<double>& du) const;
  void look_for_neighbours();
  [[nodiscard]] double free_part(const State& at, const double* from, const double* to) const;
  [[nodiscard]] double free_part_of_increment();
  double apply(double part, StaticStep& step);
  void commit(State& state, double load_factor);
  [[nodiscard]] std::string refused(StaticStep& step) const;
  void count_unstable(StaticStep& step);
  [[nodiscard]] std::string node_text(int node) const;

  const System* system_;
  StaticOptions options_;
  bool mixed_ = false;
  NewtonSystem newton_;
  NodeSystem nodes_;
  SaddleMatrix matrix_;
  SaddleSolver solver_;
  Trial trial_;
  State work_;
  std::vector<Mat3> here_;     ///< No piece has turned since its condensation.
  Vec x_, rhs_, noise_;        ///< Increment; minus the residual; its rounding. All scaled.
  std::vector<Vec6> moments_;  ///< Residual of bodies with what they carry, scaled.
  std::vector<double> du_, forces_, given_, held_;
  /// Surfaces of solids that may meet each other.
  struct Meeting {
    const ChangingSparsity* pattern;
    const BarrierConstraint* points;
    std::size_t first_history;
  };
  std::vector<Meeting> meetings_;
  std::vector<double> x_before_;  ///< Of all nodes, at the last assembly of this search.
  std::vector<Vec> free_;         ///< Orthonormal, see keep_free(); of the last factorisation.
  ClarkeCombination kinks_;       ///< Residuals of the iterates that hardly move any more.
  double force_ = 0.0;            ///< Largest force of the last assembly [N].
  bool resisted_ = false;         ///< Ill-conditioned in this search, but without free motions.
  bool shifted_ = false;          ///< The last factorisation is not that of the tangent itself.
  std::vector<int> turns_;        ///< Interactions whose history counts turns.
};

}  // namespace polhode
