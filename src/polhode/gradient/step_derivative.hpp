// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include <polhode/equations/newton_system.hpp>
#include <polhode/linear/kkt.hpp>

namespace polhode {

/// Numbers of a body in the derivative of a state: (dr, dφ, dv, dW), dφ a rotation of the world,
/// dW in body components. At ρ∞ = 1 nothing else of bodies and joints is handed from step to step.
inline constexpr int kStateNumbers = 12;

/// The trial that takes the step backwards: from t_{n+1} to t_n, with the same multipliers.
///
/// The wrench of a symmetric law depends on means and increments of t_n and t_{n+1}. Seen backwards
/// it is the same wrench, and its tangent by "t_{n+1}" is the derivative by the configuration at
/// t_n. @eq{reversed-step}
/// @param to  State at the end of the step.
[[nodiscard]] Trial reversed(const System& system, const Trial& step, const State& to);

/// The derivative of one step of order 2 with ρ∞ = 1 at the solution of its equations,
///
///   K_x dx + K_y dy_n + R_p dp = 0,     dy_{n+1} = P dx + Q dy_n,
///
/// forward for tangents, and transposed for adjoints. Multipliers of redundant rows are not unique,
/// but the motion is: the solutions are swept until the equations without the proximal ε hold.
/// @eq{step-derivative} @eq{step-adjoint}
class StepDerivative {
 public:
  explicit StepDerivative(const System& system);

  /// Number of the derivative of a state, and of a step's unknowns.
  [[nodiscard]] int state_size() const { return kStateNumbers * system_->body_count(); }
  [[nodiscard]] int unknowns() const { return 6 * system_->body_count() + system_->rows(); }

  /// The trial of a step at its solution, from the states at its ends.
  [[nodiscard]] Trial trial(const State& from, const State& to, double dt) const;
  /// Assembles and factors the derivative of the step.
  /// @throws SolveError if its matrix is singular.
  void linearize(const State& from, const State& to, const Trial& step);

  /// Body with the largest part of its forces that the step seen backwards does not have, and that
  /// part [-]: laws that are not symmetric in time.
  [[nodiscard]] int least_symmetric() const { return asymmetric_; }
  [[nodiscard]] double asymmetry() const { return asymmetry_; }
  /// Body whose velocity at the end is not that of the step, and the difference, as a part of its
  /// speed [-]: velocities have jumped there.
  [[nodiscard]] int jumped_body() const { return jumped_; }
  [[nodiscard]] double jump() const { return jump_; }
  /// Largest remainder of a solution so far, as a part of its right-hand side [-].
  [[nodiscard]] double defect() const { return defect_; }

  /// From dy_n to dy_{n+1}. @param residual  R_p dp: forces [N], moments [N m], then rows.
  void push(const Vec& residual, Vec& dy);
  /// From the weights μ of dy_{n+1} to those of dy_n. @returns η, with dJ = (R_p dp)ᵀ η.
  Vec pull(Vec& mu);

 private:
  struct BodyTerms {
    double by_v = 0.0;  ///< Of the force rows by dv_n, scaled.
    Mat3 by_W, G;       ///< Of the moment rows by dW_n, scaled; D W_{n+1} by dφ_{n+1}.
  };
  struct MassPair {
    int a = kGround, b = kGround, pair = -1;
    double mass = 0.0;
  };
  void find_velocity_terms(const State& from, const State& to, const Trial& step);
  void measure_symmetry(const Trial& step);
  [[nodiscard]] Vec solve(const Vec& rhs, bool transposed);
  /// K_y dy, or with `transposed` K_yᵀ η.
  [[nodiscard]] Vec by_state(const Vec& x, bool transposed) const;

  const System* system_;
  NewtonSystem forward_, backward_;
  std::unique_ptr<linear::LinearSolver> solver_;
  linear::KktValues by_y_;  ///< K_y by configurations, as blocks; of rows only those that roll.
  std::vector<BodyTerms> bodies_;
  std::vector<MassPair> masses_;
  std::vector<bool> rolls_;  ///< By pair: the rows after the first depend on the increments.
  double scale_ = 1.0, dt_ = 0.0;
  int asymmetric_ = -1, jumped_ = -1;
  double asymmetry_ = 0.0, jump_ = 0.0, defect_ = 0.0;
};

}  // namespace polhode
