// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/loads/coordinate_motion.hpp>
#include <polhode/loads/load_description.hpp>

namespace polhode {

/// A servo in a joint: a controller whose force along a free coordinate q, positive on b, makes it
/// follow a function of time c(t),
///
///   F = k e + d ė + k_i ∫ e dt,   e = c − q,   |F| ≤ F_max,   @eq{servo-law}
///
/// with means over the step. With a prescribed speed s it is ė = s − q̇ and e its integral. While
/// the force is at its limit, the integral is held (anti-windup). Its work F Δq is exact at ρ∞ = 1.
///
/// At rest an integral grows until the error is zero. In statics it is therefore the multiplier μ
/// of the row e = 0, up to the limit of the force; in modes it is a state of its own, μ̇ = k_i e, as
/// the row −e + (λ/k_i) μ = 0 of a motion exp(λt). @eq{servo-at-rest}
class Servo : public InteractionItem {
 public:
  /// @param load  Its angle or displacement, its function and drive; values stiffness, damping,
  ///              integral, and the limit.
  Servo(const LoadDescription& load, const char* limit);

  [[nodiscard]] int rows() const { return of_limit_ ? 1 : 0; }
  [[nodiscard]] int history_size() const { return kHistory; }
  [[nodiscard]] bool conservative() const { return false; }
  /// Steps backwards in time are possible only without damping, memory and limit.
  [[nodiscard]] bool dissipates() const {
    return of_speed_ || d_ != 0.0 || k_i_ != 0.0 || limit_ > 0.0;
  }
  [[nodiscard]] Coupling coupling() const {
    return std::holds_alternative<FreeAngle>(coordinate_) ? Coupling::couple : Coupling::all;
  }
  [[nodiscard]] std::vector<TimeFunctionPtr> time_functions() const { return {function_}; }
  [[nodiscard]] bool piecewise() const { return limit_ > 0.0; }
  void pieces(const PairStep& step, ForcePieces& pieces) const;
  void evaluate(const PairStep& step, PairTerms& terms) const;
  void acceleration_terms(const PairStep& step, Vec6& gamma) const;
  [[nodiscard]] Work work(const PairStep& step) const;
  /// Report at an instant: force [N] or moment [N m] on b, coordinate, its rate, error, power [W]
  /// and work since the start [J].
  [[nodiscard]] std::vector<double> report(const PairStep& step) const;
  void initialize(const PairStep& step, double* history) const;
  void commit(const PairStep& step, double* history) const;
  void commit_off(const PairStep& step, double* history) const;
  /// Activates the servo; its integral starts from zero.
  void switch_on(const PairStep& step, double* history) const;

 private:
  /// Layout of the history: coordinate and, for a speed, error at t_n; integral of the error, work
  /// since the start, and the force of the last load step.
  enum History : int { kCoordinate, kError, kIntegral, kWork, kForce, kHistory };
  struct Command {
    double force = 0.0;
    double error = 0.0, error_n1 = 0.0;  ///< At t_{n+αf}, at t_{n+1}.
    Vec6 by_a = Vec6::Zero(), by_b = Vec6::Zero();
    bool limited = false;
  };
  [[nodiscard]] CoordinateMotion coordinate(const PairStep& step) const;
  [[nodiscard]] Command command(const PairStep& step, const CoordinateMotion& q) const;
  void put_row(const PairStep& step, const CoordinateMotion& q, const Command& u,
               PairTerms& t) const;

  JointCoordinate coordinate_;
  TimeFunctionPtr function_;
  bool of_speed_;
  bool of_limit_;  ///< Its integral has reached its limit: a row. Statics and modes.
  double k_, d_, k_i_, limit_;
};

struct RotaryServo : Servo {
  static constexpr const char* kKind = "rotary_servo";
  explicit RotaryServo(const LoadDescription& load) : Servo(load, "max_moment") {}
};
struct LinearServo : Servo {
  static constexpr const char* kKind = "linear_servo";
  explicit LinearServo(const LoadDescription& load) : Servo(load, "max_force") {}
};

/// Adds a servo to the system.
void add_rotary_servo(System& system, const LoadDescription& load);
void add_linear_servo(System& system, const LoadDescription& load);

}  // namespace polhode
