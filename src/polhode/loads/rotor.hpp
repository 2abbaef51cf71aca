// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/loads/load_description.hpp>

namespace polhode {

/// A rotor without an angle on body b, about an axis a fixed in it: a gyrostat's wheel.
///
/// Its angular momentum in addition to that of the body's inertia is H a. A rotor with a given
/// moment M has H = I (Ω + a·ω), with dH/dt = M, as a state; its axial inertia I is not in the
/// body's. One with a given speed Ω has H = I Ω(t), and the builder adds I a aᵀ to the body's
/// inertia. The moment on the body is −d(H a)/dt in both cases,
///
///   m = −ω_α × a_α H_α − a_α Ḣ_α,
///
/// which is −Δ(H a)/Δt exactly at ρ∞ = 1. Turns of the rotor do not limit the step.
/// @eq{rotor-moment} @eq{rotor-work}
class Rotor : public InteractionItem {
 public:
  static constexpr const char* kKind = "rotor";
  /// @param load  The third axis of R_b is that of the rotor; values inertia [kg m²] and, for a
  ///              moment, start_speed [rad/s]; the function is its moment or speed, as drive says.
  explicit Rotor(const LoadDescription& load);

  [[nodiscard]] bool conservative() const { return !has_speed_ && is_free(); }
  [[nodiscard]] int history_size() const { return kHistory; }
  [[nodiscard]] std::vector<TimeFunctionPtr> time_functions() const { return {function_}; }
  [[nodiscard]] int time_order() const { return has_speed_ ? 1 : 2; }
  void evaluate(const PairStep& step, PairTerms& terms) const;
  /// Work of the drive, the moment between body and rotor, at the rotor's speed. Not
  /// stored here is the rotor's kinetic energy: see added_energy().
  [[nodiscard]] Work work(const PairStep& step) const;
  /// Report at an instant: moment on the body [N m], speed relative to it [rad/s], momentum along
  /// the axis and as a vector [N m s], moment on the rotor about the axis, for a given speed the
  /// mean of the last step [N m], its power [W] and work [J], kinetic energy about the axis [J].
  [[nodiscard]] std::vector<double> report(const PairStep& step) const;
  /// Places in the report of the momentum as a vector, and of the energy.
  static constexpr std::size_t kReportedMomentum = 5, kReportedEnergy = 11;
  void initialize(const PairStep& step, double* history) const;
  void commit(const PairStep& step, double* history) const;

  /// Angular momentum in addition to that of the body's inertia in the System, world [N m s].
  [[nodiscard]] Vec3 added_momentum(const BodyStep& b, const double* history) const {
    return history[kMomentum] * (b.Lambda_n1 * axis_);
  }
  /// Kinetic energy likewise [J].
  [[nodiscard]] double added_energy(const BodyStep& b, const double* history) const;

 private:
  /// Layout of the history: H at t_n, work of the drive since the start, its moment on the rotor
  /// over the last step.
  enum History : int { kMomentum, kWork, kDrive, kHistory };
  /// H over a step [N m s], and its rate at t_{n+αf} [N m].
  struct Spin {
    double at_n = 0.0, at_alpha = 0.0, at_n1 = 0.0, rate = 0.0;
  };
  [[nodiscard]] Spin spin(const PairStep& step) const;
  [[nodiscard]] bool is_free() const {
    return !function_ || (function_->is_constant() && (*function_)(0.0) == 0.0);
  }
  /// Mean of the given moment from t_n + from·Δt to t_{n+1} [N m].
  [[nodiscard]] double mean_moment(const StepContext& step, double from) const;
  /// Change over the step of the momentum I (Ω + a·ω) about the axis [N m s].
  [[nodiscard]] double change(const PairStep& step, const Spin& s) const;

  Vec3 axis_;
  double inertia_, start_speed_;
  TimeFunctionPtr function_;
  bool has_speed_;
};

struct LoadKind;

/// The entry of the rotor in the registry of loads.
[[nodiscard]] LoadKind rotor_kind();

}  // namespace polhode
