// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/loads/coordinate_motion.hpp>
#include <polhode/loads/load_vector.hpp>

namespace polhode {

/// A motor in a joint: one of its free coordinates q has a prescribed value or rate, or a
/// prescribed force acts along it. Forces on b act along +q, those on a along −q.
///
/// A prescribed value c(t) is the row q − c = 0 with the discrete gradient of q, so that at ρ∞ = 1
/// the drive's work in a step is exactly λ (c_{n+1} − c_n). A prescribed rate is integrated over
/// each step by Gauss's rule. A force may be a function of q and its rate. @eq{drive-row}
/// @eq{drive-work} @eq{callable-force}
class Motor : public InteractionItem {
 public:
  /// Meaning of its function of time.
  enum class Drive { position, speed, effort };

  /// @param load  Its angle or displacement, function and drive.
  explicit Motor(const LoadDescription& load);

  [[nodiscard]] int rows() const { return drive_ == Drive::effort ? 0 : 1; }
  [[nodiscard]] int history_size() const { return kHistory; }
  [[nodiscard]] bool conservative() const { return false; }
  [[nodiscard]] bool dissipates() const { return of_motion_ && of_motion_->reads_velocity; }
  [[nodiscard]] Coupling coupling() const {
    return std::holds_alternative<FreeAngle>(coordinate_) ? Coupling::couple : Coupling::all;
  }
  [[nodiscard]] std::vector<TimeFunctionPtr> time_functions() const { return {function_}; }
  [[nodiscard]] int time_order() const { return static_cast<int>(drive_); }
  [[nodiscard]] bool prescribes() const { return rows() > 0; }
  void prescribed(const PairStep& step, TimeSide side, PrescribedRows& rows) const;
  [[nodiscard]] int work_entry() const { return rows() > 0 ? kWork : -1; }
  [[nodiscard]] ImpulseSum impulse_sum() const {
    return rows() > 0 ? ImpulseSum::of_row : ImpulseSum::none;
  }
  [[nodiscard]] int impulse_entry() const { return kImpulse; }
  void evaluate(const PairStep& step, PairTerms& terms) const;
  void acceleration_terms(const PairStep& step, Vec6& gamma) const;
  [[nodiscard]] Work work(const PairStep& step) const;
  /// Report at an instant: force [N] or moment [N m] on b, coordinate with counted turns, its rate,
  /// power [W], work [J] and impulse along the coordinate [N s or N m s] since the start.
  [[nodiscard]] std::vector<double> report(const PairStep& step) const;
  void initialize(const PairStep& step, double* history) const;
  void commit(const PairStep& step, double* history) const;
  void commit_off(const PairStep& step, double* history) const;
  void switch_on(const PairStep& step, double* history) const { commit_off(step, history); }

 private:
  /// Layout of the history: coordinate and prescribed value at t_n, work and impulse since the
  /// start, 1 once these are known, and the force of the last load step.
  enum History : int { kCoordinate, kTarget, kWork, kImpulse, kStarted, kForce, kHistory };

  [[nodiscard]] CoordinateMotion coordinate(const PairStep& step) const;
  [[nodiscard]] double at_n1(const PairStep& step) const;
  /// Target value c(t_{n+1}).
  [[nodiscard]] double target(const PairStep& step) const;
  /// Prescribed force over the step [N or N m], with its derivatives.
  [[nodiscard]] CoordinateValue effort(const PairStep& step, const CoordinateMotion& q,
                                       const RateStep& rate, bool tangents) const;
  [[nodiscard]] double effort(const PairStep& step) const;
  void add_moment(const FreeAngle& angle, const PairStep& step, PairTerms& terms) const;
  /// Work over the step [J].
  [[nodiscard]] double work_of_step(const PairStep& step) const;

  JointCoordinate coordinate_;
  TimeFunctionPtr function_;
  std::optional<CoordinateFunction> of_motion_;
  Drive drive_;
};

/// A rotary motor.
struct RotaryMotor : Motor {
  static constexpr const char* kKind = "rotary_motor";
  using Motor::Motor;
};
/// A linear motor.
struct LinearMotor : Motor {
  static constexpr const char* kKind = "linear_motor";
  using Motor::Motor;
};

/// Adds a motor to the system.
void add_rotary_motor(System& system, const LoadDescription& load);
void add_linear_motor(System& system, const LoadDescription& load);

}  // namespace polhode
