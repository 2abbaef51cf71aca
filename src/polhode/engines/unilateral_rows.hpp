// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include <polhode/equations/constraint_check.hpp>
#include <polhode/equations/trial.hpp>
#include <polhode/impulses/row_problem.hpp>
#include <polhode/linear/kkt.hpp>
#include <polhode/system/body_contacts.hpp>
#include <polhode/system/impulsive_contacts.hpp>
#include <polhode/system/unilateral_stops.hpp>

namespace polhode {

/// Unilateral rows of a step, for Newton engines with a matrix: contacts of rigid shapes, and the
/// rows of interactions that only push, such as stops of joints.
///
/// A row has a non-negative impulse p with p g_{n+1} = 0 and g_{n+1} ≥ 0, like a joint that only
/// pushes. Contacts whose gap is zero at t_n have Coulomb friction against the slip of the step, so
/// that a point that sticks does not move at all. In each iteration the smooth equations are solved
/// first, then with the response of the bodies to each row the row problem exactly. Friction of
/// rows that close, and restitution, belong to the velocity problem at the end of the step.
/// @eq{contact-rows}
class UnilateralRows {
 public:
  /// Whether a system has such rows.
  [[nodiscard]] static bool of(const System& system);
  explicit UnilateralRows(const System& system);

  void begin_step(const State& state, const Trial& trial);
  /// Adds the effect of the rows to increments.
  /// @param scale  s of the Newton system. @param solver  With its factors.
  /// @param x      Increments without contact; with it.
  /// @returns false if a value is not finite, or there are too many rows.
  [[nodiscard]] bool solve(const State& state, const Trial& trial, double scale,
                           const linear::LinearSolver& solver, Vec& x);
  /// Whether the last row problem was solved: a step must not end with another one.
  [[nodiscard]] bool solved() const { return solved_; }
  /// Message about the row that was not.
  [[nodiscard]] const std::string& unsolved() const { return unsolved_; }
  /// Adds what the rows miss at the iterate.
  void add_to(ConstraintCheck& check, const State& state, const Trial& trial);
  void add_ground_wrench(double* force, double* moment) const;
  Work commit(State& state, const Trial& trial);
  [[nodiscard]] BodyContacts* contacts() const { return contacts_; }

 private:
  /// A row: wrenches of its unit impulse, on a, and on b.
  struct Row {
    int a = kGround, b = kGround;
    Vec6 on_a, on_b;
    Vec6 by_a, by_b;                ///< Derivative of the gap, or of the slip, at t_{n+1}.
    int source = 0;                 ///< A point or, numbered after all points, a stop.
    double way = 0.0;               ///< Gap at t_{n+1}, or slip over the step.
    Vec3 direction = Vec3::Zero();  ///< Of a point's impulse, or the axis of a turning row.
    bool turns = false;             ///< An angular impulse.
  };
  /// A unilateral row of an interaction in this step.
  struct Stop : UnilateralStop {
    double impulse = 0.0;  ///< [N s]
  };
  void take_steps(const State& state, const Trial& trial);
  void take_stops(const State& state, const Trial& trial);
  void find(const StepContext& context, const Vec& x);
  void put_rows();
  void put_point(int number);
  [[nodiscard]] bool is_point(const Row& row) const {
    return row.source < static_cast<int>(points_.size());
  }
  [[nodiscard]] const Stop& stop_of(const Row& row) const {
    return stops_[static_cast<std::size_t>(row.source) - points_.size()];
  }
  /// Impulse of the iteration before; in the first one that of the step before.
  [[nodiscard]] double impulse_of(const Row& row) const;
  /// Largest distance from the origin of what a row acts on [m], and speed there [m/s].
  void add_scales(const Row& row, double& far, double& fastest) const;
  void take_impulses(const Vec& sums);
  [[nodiscard]] std::vector<std::vector<Eigen::Index>> islands(const Mat& A) const;
  void take_blocks(const std::vector<Eigen::Index>& island, RowProblem& problem) const;
  [[nodiscard]] bool rests(const ImpulsePoint& p) const { return p.gap <= touching_; }
  /// Displacement along a row over the step, and change by increments.
  [[nodiscard]] double displacement(const Row& row) const;
  [[nodiscard]] static double change(const Row& row, const Vec& x);
  [[nodiscard]] const BodyStep& step_of(int body) const {
    return body == kGround ? steps_.back() : steps_[static_cast<std::size_t>(body)];
  }
  [[nodiscard]] Vec3 slip_of(const ImpulsePoint& p) const;
  [[nodiscard]] std::string broken() const;
  /// "the contact of body 'a' and the ground", "the stop of joint 'knee'".
  [[nodiscard]] std::string name_of(const Row& row) const;

  const System* system_;
  BodyContacts* contacts_ = nullptr;        ///< Null: none.
  ImpulsiveContacts* impulsive_ = nullptr;  ///< Likewise.
  double touching_;                         ///< Gap below which surfaces touch [m].
  std::vector<BodyStep> steps_;             ///< By body, the ground last.
  std::vector<Vec6> nowhere_;
  std::vector<ImpulsePoint> points_;
  std::vector<ImpulseLoss> losses_;
  std::vector<Stop> stops_;           ///< Of all interactions.
  std::vector<UnilateralRow> found_;  ///< Of one interaction.
  std::vector<Row> rows_;
  std::vector<ImpulseRows> blocks_;
  std::vector<double> lengths_;
  std::vector<Vec> responses_;  ///< By row: increments by a unit impulse.
  double dt_ = 0.0;
  bool solved_ = true;
  std::string unsolved_;
  bool first_ = true;  ///< No iteration of this step has found impulses yet.
};

}  // namespace polhode
