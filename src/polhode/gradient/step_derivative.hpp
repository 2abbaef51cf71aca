// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <polhode/equations/newton_system.hpp>
#include <polhode/gradient/wrench_derivative.hpp>
#include <polhode/linear/kkt.hpp>

namespace polhode {

/// Numbers of a body in the derivative of a state: (dr, dφ, dv, dW), dφ a rotation of the world,
/// dW in body components. At ρ∞ = 1 nothing else of bodies and joints is handed from step to step.
inline constexpr int kStateNumbers = 12;
/// Stored accelerations of a body at ρ∞ < 1: (da, dA, dḣ). They follow the numbers above of all
/// bodies, and are followed by their rates of change.
inline constexpr int kStoredNumbers = 9;

/// Number of the derivative of a state.
[[nodiscard]] int state_size(const System& system, double rho_inf);
/// Stored accelerations of a state as numbers, and their rates. @param out  Of all bodies.
void put_stored(const System& system, const State& state, Eigen::Ref<Vec> out);

/// The trial that takes the step backwards: from t_{n+1} to t_n, with the same multipliers.
///
/// The wrench of a symmetric law depends on means and increments of t_n and t_{n+1}. Seen backwards
/// it is the same wrench, and its tangent by "t_{n+1}" is the derivative by the configuration at
/// t_n. @eq{reversed-step}
/// @param to  State at the end of the step.
[[nodiscard]] Trial reversed(const System& system, const Trial& step, const State& to);

/// The derivative of one step of order 2 in the momentum form at the solution of its equations,
///
///   K_x dx + K_y dy_n + R_p dp = 0,     dy_{n+1} = P dx + Q dy_n + U_p dp,
///
/// forward for tangents, and transposed for adjoints. At ρ∞ < 1 accelerations are part of the
/// state, and ḣ_{n+1} depends on the inertia, in U_p, as well. Multipliers of redundant rows are
/// not unique, but the motion is: the solutions are swept until the equations without the proximal
/// ε hold.
/// @eq{step-derivative} @eq{step-adjoint} @eq{damped-step-derivative}
class StepDerivative {
 public:
  explicit StepDerivative(const System& system, double rho_inf = 1.0);

  /// Number of the derivative of a state, and of a step's unknowns.
  [[nodiscard]] int state_size() const { return polhode::state_size(*system_, ga_.rho_inf); }
  [[nodiscard]] int unknowns() const { return 6 * system_->body_count() + system_->rows(); }
  /// Numbers of a step that depend on parameters: forces [N], moments [N m], rows, and at ρ∞ < 1
  /// ḣ_{n+1} of each body at a fixed motion [N m].
  [[nodiscard]] int inputs() const {
    return unknowns() + (stores() ? 3 * system_->body_count() : 0);
  }

  /// The state from which a step of length dt begins, with stored accelerations for that length;
  /// valid until the next call.
  [[nodiscard]] const State& beginning(const State& from, double dt);
  /// The trial of a step at its solution, from the states at its ends. @param from  See above.
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
  /// Largest force or moment that the step leaves open, as a part of the terms it consists of [-].
  /// Those of contacts and stops are not among its equations.
  [[nodiscard]] double unbalanced(const Trial& step) const;
  /// Largest remainder of a solution so far, as a part of its right-hand side [-].
  [[nodiscard]] double defect() const { return defect_; }

  /// From dy_n to dy_{n+1}. @param by_parameter  R_p dp and U_p dp, see inputs().
  void push(const Vec& by_parameter, Vec& dy);
  /// From the weights μ of dy_{n+1} to those of dy_n. @returns η of the inputs, with
  /// dJ = (R_p dp, U_p dp)ᵀ η.
  Vec pull(Vec& mu);

 private:
  struct BodyTerms {
    double by_v = 0.0, by_a = 0.0;  ///< Of the force rows by dv_n and da_n, scaled.
    Mat3 by_W, by_A;                ///< Of the moment rows by dW_n and dA_n, scaled.
    /// D W_{n+1} by dφ_{n+1}, and the dφ_{n+1} that changes W_{n+1} by γ/(βΔt) times a vector.
    Mat3 G, G_inverse;
    Mat3 H_n, H_n1;  ///< Angular momentum by W_n and W_{n+1}.
    Vec3 h_n, h_n1;  ///< [N m s], world.
  };
  /// Force rows by the motion at t_n, of a mass of 1 kg, scaled.
  struct MassTerms {
    double by_r, by_v, by_a;
  };
  /// Weights of velocities and stored accelerations at t_n, see add_by_rates().
  struct RateWeights {
    double v, a, h_dot, coupled_a;
  };
  /// Weights of Newmark's rule.
  struct NewmarkWeights {
    double v_by_r, v_by_v, v_by_a, a_by_r, a_by_v, a_by_a, h_dot_by_h, h_dot_by_h_dot;
  };
  struct MassPair {
    int a = kGround, b = kGround, pair = -1;
    double mass = 0.0;
  };
  [[nodiscard]] bool stores() const { return ga_.rho_inf < 1.0; }
  /// First of a body's stored accelerations in the derivative of a state.
  [[nodiscard]] int stored(int body) const {
    return kStateNumbers * system_->body_count() + kStoredNumbers * body;
  }
  /// Number of all stored accelerations.
  [[nodiscard]] int all_stored() const { return kStoredNumbers * system_->body_count(); }
  void find_inertia_terms(const State& from, const State& to, const Trial& step);
  void add_coupled_masses();
  void see_backwards(const Trial& step, const State& to);
  void differentiate_wrenches(const State& from, const Trial& step);
  void measure_symmetry(const Trial& step);
  [[nodiscard]] std::pair<double, double> force_scales(const Trial& step, int body) const;
  [[nodiscard]] Vec solve(const Vec& rhs, bool transposed);
  /// K_y dy, or with `transposed` K_yᵀ η.
  [[nodiscard]] Vec by_state(const Vec& x, bool transposed) const;
  void add_by_rates(const Vec& y, Vec& out) const;
  void add_by_rates_transposed(const Vec& eta, Vec& y) const;
  [[nodiscard]] MassTerms mass_terms() const;
  [[nodiscard]] RateWeights rate_weights() const;
  [[nodiscard]] NewmarkWeights newmark_weights() const;

  const System* system_;
  GeneralizedAlpha ga_;
  NewtonSystem forward_, backward_;
  std::unique_ptr<linear::LinearSolver> solver_;
  linear::KktValues by_y_;  ///< K_y by configurations, as blocks; of rows only those that roll.
  std::vector<BodyTerms> bodies_;
  std::vector<MassPair> masses_;
  std::vector<bool> rolls_;  ///< By pair: the rows after the first depend on the increments.
  std::optional<WrenchDerivative> wrenches_;  ///< For ρ∞ < 1.
  State beginning_;                           ///< Likewise.
  double scale_ = 1.0, dt_ = 0.0;
  double later_ = 0.0;  ///< Effect of the rates of stored accelerations on these [s].
  int asymmetric_ = -1, jumped_ = -1;
  double asymmetry_ = 0.0, jump_ = 0.0, defect_ = 0.0;
};

}  // namespace polhode
