// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <vector>

#include <polhode/engines/saddle_solver.hpp>
#include <polhode/equations/newton_system.hpp>
#include <polhode/statics/clarke_combination.hpp>
#include <polhode/statics/static_report.hpp>
#include <polhode/statics/static_rows.hpp>
#include <polhode/system/barrier_constraint.hpp>

namespace polhode {

/// Options of the search for an equilibrium.
struct StaticOptions {
  /// Equal load increments; 0: chosen by the convergence of Newton's method.
  int load_steps = 0;
  /// End of a history of loads, which follows functions of time as they stand [s]; 0: all loads
  /// grow to their full size.
  double history = 0.0;
  int max_iterations = 25;   ///< Before a load step is reduced.
  double tolerance = 1e-10;  ///< On the sum of further increments, |Δr|/ℓ or |Δθ| [-].
  double residual = 1e-9;    ///< Tolerated unbalanced force, as a part of the largest force [-].
  bool mixed_point = true;   ///< Geometric stiffness by extrapolated stresses.
  /// Ends the search when it becomes true, without an equilibrium; null: never.
  const std::atomic<bool>* stop = nullptr;
};

/// Motion with the smallest stiffness at an equilibrium.
struct SoftestMotion {
  double stiffness = 0.0;  ///< xᵀKx/xᵀx; negative where the equilibrium is unstable [N/m].
  std::string text;        ///< "'leg' moves, most at node 4"; empty: not found.
};

/// Newton's method for the equilibrium of bodies, joints, springs, beams and solids: one matrix of
/// all unknowns, without inertia and velocities. Rotations are composed iteration by iteration, so
/// that a load step may rotate bodies by any angle. Interactions see the step from the last
/// equilibrium, t_n, to the iterate, t_{n+1}. Derivation: docs/theory/statics_and_modes.md.
class StaticNewton {
 public:
  StaticNewton(const System& system, const StaticOptions& options);

  /// Solves for the equilibrium of the state's bodies and nodes at a load factor, starting from
  /// `start` if given (a predicted state), else from the state itself. On failure the state is
  /// unchanged. In a history the load factor is a time, and below zero it is one more than the
  /// factor of the loads at its start.
  StaticStep solve(State& state, double load_factor, const State* start = nullptr);

  /// Solves by relaxation: the state moves downhill in small steps, also with slack or yielding
  /// parts, until Newton's method finds a nearby equilibrium. Derivation: @eq{statics-relaxation}
  /// @param slack  Parts may fall before they carry load. Otherwise the search ends where a motion
  /// of half the model's size meets no resistance.
  StaticStep relax(State& state, double load_factor, bool slack);
  /// The rows that no positions of the bodies satisfy at a load factor, near a state, whatever the
  /// forces. Derivation: @eq{statics-gap}
  [[nodiscard]] RowGap least_gap(const State& state, double load_factor);
  /// The place of the last least_gap().
  [[nodiscard]] const State& nearest() const { return work_; }
  /// Sets StaticOptions::stop.
  void set_stop(const std::atomic<bool>* stop) { options_.stop = stop; }

  /// Assembles tangent and residual at a state, all loads times the load factor.
  void assemble_at(const State& state, double load_factor);
  /// Replaces K by K + rate·C after assemble_at(), with C the derivative of forces by velocities,
  /// at rest [N s/m], and rate in 1/s.
  void assemble_with_rates(double rate);
  [[nodiscard]] SaddleMatrix& matrix() { return matrix_; }  ///< Scaled by scale().
  [[nodiscard]] const SaddleMatrix& tangent() const { return matrix_; }
  [[nodiscard]] double scale() const { return trial_.compliance_scale; }
  [[nodiscard]] const NewtonSystem& bodies() const { return newton_; }
  /// Reaction forces on bonded and prescribed nodes at the last equilibrium, three each [N].
  [[nodiscard]] const std::vector<double>& node_residual() const { return held_; }
  /// Measures the last assembly: largest unbalanced force, and the largest force [N].
  void measure(StaticStep& step) const;
  /// Unilateral rows; null: the system has none. @eq{statics-rows}
  [[nodiscard]] const StaticRows* rows() const { return rows_.get(); }
  /// Whether a contact with friction has closed in the last search that found an equilibrium.
  [[nodiscard]] bool closes() const { return closes_; }
  /// Topology of the matrix; rows that act are behind those of joints.
  [[nodiscard]] const linear::KktTopology& topology() const {
    return rows_ ? topology_ : newton_.topology();
  }
  /// Whether a row has a compliance, so that its multiplier is a spring force.
  [[nodiscard]] bool is_spring(int row) const {
    return row < system_->rows() && newton_.is_spring(row);
  }
  /// Number of unstable directions at an equilibrium with stiffnesses added to the tangent of the
  /// nodes, in blocks of their graph [N/m]; −1: not known.
  [[nodiscard]] int unstable_with(const State& state, double load_factor,
                                  const std::vector<double>& more);
  /// Softest motion at the last equilibrium found.
  [[nodiscard]] SoftestMotion softest();

 private:
  /// Unbalanced, within the tolerance, or balanced to rounding.
  enum class Balance { off, within, rounded };
  [[nodiscard]] bool stopped() const { return options_.stop && options_.stop->load(); }
  StaticStep solve_with_rows(State& state, double load_factor);
  [[nodiscard]] bool row_increment(double ease);
  [[nodiscard]] std::string endless();
  [[nodiscard]] int matrix_rows() const { return matrix_.size() - matrix_.movable(); }
  void set_matrix();
  void enter(double load_factor, double last);
  void start_at(const State& state);
  void place_bodies();
  void start_scratch(const State& state);
  double assemble_gap(Vec& rhs, Vec& sizes);
  void name_open(const Vec& rhs, const Vec& sizes, RowGap& found) const;
  void count_turns();
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
  [[nodiscard]] double free_part(const double* from, const double* to) const;
  [[nodiscard]] int passed_shape() const;
  [[nodiscard]] double free_part_of_increment();
  double apply(double part, StaticStep& step);
  [[nodiscard]] bool search(double most, StaticStep& step, ElementReport& elements);
  [[nodiscard]] double work_by_lag(const InteractionRef& ref, const PairStep& pair) const;
  void commit(State& state, double load_factor);
  [[nodiscard]] std::string refused(StaticStep& step);
  [[nodiscard]] bool turns_too_far(const InteractionRef& ref) const;
  void count_unstable(StaticStep& step);

  const System* system_;
  StaticOptions options_;
  bool mixed_ = false;
  NewtonSystem newton_;
  NodeSystem nodes_;
  SaddleMatrix matrix_;
  SaddleSolver solver_;
  Trial trial_;
  State work_;
  State last_;  ///< At t_n; its history is not used: that of the iterations is in work_.
  std::vector<Mat3> here_;     ///< No connected component has rotated since its condensation.
  Vec x_, rhs_, noise_;        ///< Increment; negative residual; its rounding. All scaled.
  std::vector<Vec6> moments_;  ///< Residual of bodies with the nodes bonded to them, scaled.
  std::vector<double> du_, forces_, given_, held_;
  /// A contact between surfaces of solids.
  struct Meeting {
    const ChangingSparsity* pattern;
    const BarrierConstraint* points;
    std::size_t first_history;
  };
  std::vector<Meeting> meetings_;
  std::vector<int> shapes_;           ///< Element groups of contacts with rigid shapes.
  std::vector<double> x_before_;      ///< Of all nodes, at the last assembly of this search.
  std::vector<Vec> free_;             ///< Orthonormal, see keep_free(); of the last factorisation.
  ClarkeCombination kinks_;           ///< Residuals of iterates with small increments.
  double force_ = 0.0;                ///< Largest force of the last assembly [N].
  bool resisted_ = false;             ///< Ill-conditioned in this search, without free motions.
  bool shifted_ = false;              ///< The last factorisation is of a shifted tangent.
  std::unique_ptr<StaticRows> rows_;  ///< Null: there are none.
  linear::KktTopology topology_;      ///< With rows_: of the matrix, and its values.
  linear::KktValues values_;
  Vec contact_noise_;          ///< Rounding of the rows' forces, by body; scaled.
  bool closes_ = false;        ///< See closes().
  bool hold_ = false;          ///< Rows that act are in the matrix.
  std::vector<int> turns_;     ///< Interactions whose history counts turns.
  std::vector<char> lengths_;  ///< By row: its value is a length, see assemble_gap().
};

}  // namespace polhode
