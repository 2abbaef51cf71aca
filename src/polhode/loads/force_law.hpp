// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <polhode/loads/load_description.hpp>

namespace polhode {

/// A force over a step with its derivative by the coordinate at t_{n+1}.
struct LawValue {
  double value = 0.0;
  double slope = 0.0;
};

/// A force f(x) with a potential: k x + k₂ |x| x, K/x², plus a table or an expression, or the
/// derivative of a given potential; on both sides of x = 0 or on one only.
///
/// Over a step it is the mean of f from x_{n+1} − 2(1 − αf) Δx to x_{n+1}: at ρ∞ = 1 the force
/// times Δx is the change of the potential, and at αf = 1 it is f(x_{n+1}). @eq{law-mean}
class ForceLaw {
 public:
  enum class Acts { both, tension, compression };

  ForceLaw() = default;
  /// @param load  Values stiffness, quadratic and inverse_square, a law of this name or the law
  /// `energy` for the potential, the word `acts`.
  ForceLaw(const LoadDescription& load, const std::string& law);

  /// Force over a step from x_n to x_n1.
  [[nodiscard]] LawValue over_step(double x_n, double x_n1, double alpha_f) const;
  [[nodiscard]] LawValue at(double x) const;    ///< f(x) and f'(x).
  [[nodiscard]] double energy(double x) const;  ///< ∫ f from 0 to x.
  [[nodiscard]] bool is_zero() const { return k_ == 0.0 && k_2_ == 0.0 && K_ == 0.0 && !f_; }
  /// Whether f, f' or f'' jumps somewhere.
  [[nodiscard]] bool piecewise() const { return has_sides() || kinks_; }
  /// Adds the smooth piece of f at x.
  void piece(double x, ForcePieces& pieces) const;

 private:
  [[nodiscard]] bool acts_on(double x) const {
    return acts_ == Acts::both || (acts_ == Acts::tension) == (x > 0.0);
  }
  /// Whether f differs between x < 0 and x > 0.
  [[nodiscard]] bool has_sides() const { return acts_ != Acts::both || k_2_ != 0.0; }
  [[nodiscard]] double mean(double p, double q) const;
  [[nodiscard]] double mean_on_one_side(double p, double q) const;

  double k_ = 0.0, k_2_ = 0.0, K_ = 0.0;
  TimeFunctionPtr f_;
  TimeFunctionPtr V_;  ///< Potential of f_ if that is given, else null.
  Acts acts_ = Acts::both;
  bool kinks_ = false, jumps_ = false;  ///< Of f_.
  bool jumps_at_zero_ = false;          ///< Where it begins to act.
};

/// Jump of a law of a rate.
struct LawJump {
  double at = 0.0;    ///< Rate [m/s or rad/s].
  double size = 0.0;  ///< Force just above minus force just below [N or N m].
  double rest = 0.0;  ///< Part of the size that acts at this rate, of a jump upwards.
};

/// Distance from a jump upwards over which the law rises [m/s or rad/s]: with a force between the
/// two limits the rate is that of the jump to this width.
inline constexpr double kJumpWidth = 1e-9;

/// Largest number of jumps of a law of a rate.
inline constexpr std::size_t kMostJumps = 64;

/// Jumps of a law of a rate, by rising rate; one more than kMostJumps if there are more.
[[nodiscard]] std::vector<LawJump> jumps_of(const TimeFunction& law);

/// Rate of a coordinate over a step, or at an instant, where dt is zero.
struct StepRates {
  double at_n = 0.0, at_alpha = 0.0;  ///< [m/s or rad/s]
  double alpha_f = 1.0, dt = 0.0;

  /// Rate at t_{n+1} of the mean motion of the step.
  [[nodiscard]] double at_n1() const { return at_n + (at_alpha - at_n) / alpha_f; }
};

/// A resistance c v plus a table or an expression of v, which must oppose v.
///
/// A law that jumps upwards is set-valued: at the rate v_J of the jump it has any value between its
/// limits, like dry friction. Each such jump has a row whose multiplier, a force along +v, is minus
/// the part of the jump that acts: all of it if the rate at t_{n+1} is above v_J, nothing below,
/// and at v_J what keeps the rate there. A jump downwards acts by the rate at t_n. The rest of the
/// law is that of the rate at t_{n+αf}. @eq{law-jump}
class ResistanceLaw {
 public:
  ResistanceLaw() = default;
  /// @param load  Value damping, and a law of this name.
  /// @throws InputError if the law has more than kMostJumps jumps.
  ResistanceLaw(const LoadDescription& load, const std::string& law);

  [[nodiscard]] bool is_zero() const { return c_ == 0.0 && !f_; }
  [[nodiscard]] bool jumps() const { return !jumps_.empty(); }
  /// Whether the law has kinks.
  [[nodiscard]] bool piecewise() const { return kinks_; }
  /// Adds its smooth piece at a rate. @param memory  As below.
  void piece(double v, const double* memory, ForcePieces& pieces) const;
  /// Number of rows, one for each jump upwards.
  [[nodiscard]] int rows() const { return static_cast<int>(rows_.size()); }
  /// Numbers of `memory` below; none without rows.
  [[nodiscard]] int memory_size() const { return rows_.empty() ? 0 : kHeld + rows(); }

  /// Force without that of the rows, with its slope by the rate at t_{n+αf}.
  [[nodiscard]] LawValue smooth(const StepRates& v) const;
  /// Force of the rows: minus their multipliers in a step, as remembered at an instant.
  [[nodiscard]] double of_rows(const StepRates& v, const double* lambda,
                               const double* memory) const;
  /// Force of the whole law.
  [[nodiscard]] double force(const StepRates& v, const double* lambda, const double* memory) const {
    return smooth(v).value + of_rows(v, lambda, memory);
  }
  /// Sets values and compliances of the rows.
  /// @returns the derivatives of their values by the rate at t_{n+αf}.
  [[nodiscard]] Vec6 put_rows(const StepRates& v, const double* lambda, PairTerms& terms) const;

  /// Rates over a step. @param now  The rate of the bodies' velocities at t_n.
  [[nodiscard]] StepRates rates(const PairStep& step, double now, double at_alpha,
                                const double* memory) const;
  /// Memory at the start. @param now  Rate.
  void initialize(double now, double* memory) const;
  /// Memory at t_{n+1}. @param now  The rate of the bodies' velocities there.
  void commit(const StepRates& v, double now, const double* lambda, double* memory) const;

 private:
  /// Layout of the memory: the rate of the mean motion minus that of the velocities, which differ
  /// by an error of second order; then the forces of the rows.
  enum Memory : int { kOffset, kHeld };
  [[nodiscard]] double held(int row, double v, const double* memory) const;

  double c_ = 0.0;
  TimeFunctionPtr f_;
  bool kinks_ = false;          ///< Of f_.
  std::vector<LawJump> jumps_;  ///< All.
  std::vector<LawJump> rows_;   ///< Upwards.
  std::vector<LawJump> drops_;  ///< The others.
};

/// Mean of a function over [p, q] to round-off: Gauss's rule between the kinks reported by the
/// function, on intervals that are halved.
[[nodiscard]] double mean_value(const TimeFunction& f, double p, double q);

}  // namespace polhode
