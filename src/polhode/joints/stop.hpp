// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/contact_laws/contact_phase.hpp>
#include <polhode/contact_laws/normal_law.hpp>
#include <polhode/system/history_record.hpp>

namespace polhode {

struct JointLimits;

/// History of the stops of a coordinate.
struct StopMemory {
  double acceleration;  ///< Of the coordinate without the stop [m/s²] or [rad/s²].
  double phase, restitution;
  double stiffness, upper, lower;  ///< Of the law that acts.
  double side;     ///< +1: in contact at the lower end, −1: at the upper one, 0: open.
  double pressed;  ///< 1: the step ended under an impulse from elsewhere.
};

/// A free coordinate over a step, as seen by its stops.
struct CoordinateStep {
  double at_n = 0.0, at_n1 = 0.0;      ///< [m] or [rad]
  double rate_n = 0.0, rate_n1 = 0.0;  ///< d/dt at both ends.
  double dt = 0.0;                     ///< 0: an instant, t_{n+1} [s].
};

/// Active stop of a coordinate in a step, one of two, with its phase and its law: an impact or
/// resting contact as between bodies, with one normal and no friction. @eq{joint-stop-exit}
/// @eq{turn-law}
class Stop {
 public:
  /// @param history  A StopMemory of t_n.
  Stop(const JointLimits& limits, const double* history, const CoordinateStep& step);

  [[nodiscard]] double sign() const { return sign_; }  ///< +1: the lower end.
  [[nodiscard]] const contact::NormalLaw& law() const { return law_; }
  [[nodiscard]] double gap_n() const { return gap_n_; }
  [[nodiscard]] double gap_n1() const { return gap_n1_; }
  /// Share of the force that is evaluated at the end of the step.
  [[nodiscard]] double end_share() const;
  /// Whether the stop acted in the step.
  [[nodiscard]] bool touched() const;
  /// Whether the separation rate at t_{n+1} has to change.
  [[nodiscard]] bool jumps() const;
  /// Whether it is a resting contact that transmits impulses of impacts elsewhere.
  /// @eq{impact-carried}
  [[nodiscard]] bool carries() const;
  /// Separation rate after the step, at the turn of an impact or a landing.
  [[nodiscard]] double exit_rate() const;
  /// Law from the end of the step on.
  [[nodiscard]] contact::NormalLaw law_after() const;
  /// Stores the StopMemory of t_{n+1}. @param force  Of the stop over the step, repulsive.
  void remember(double force, double* history) const;

 private:
  [[nodiscard]] bool turns() const;
  /// Whether a resting contact had to transmit the impulse of an impact elsewhere in the step.
  [[nodiscard]] bool pressed() const;
  [[nodiscard]] contact::ContactPhase phase_after() const;

  const JointLimits& limits_;
  CoordinateStep step_;
  double acceleration_ = 0.0;  ///< Of the coordinate without the stop.
  double sign_ = 1.0, gap_n_ = 0.0, gap_n1_ = 0.0;
  bool closed_ = false;  ///< At t_n.
  contact::ContactPhase phase_ = contact::ContactPhase::rest;
  double restitution_ = 0.0;  ///< Of the impact.
  bool was_pressed_ = false;  ///< In the step before by an impulse from elsewhere.
  contact::NormalLaw law_;
};

}  // namespace polhode
