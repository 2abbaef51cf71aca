// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/loads/coordinate_motion.hpp>
#include <polhode/loads/force_law.hpp>

namespace polhode {

/// A spring and damper along a free coordinate q of a joint with counted turns.
///
/// The force on b along q is −f(q − q_0) − d(q̇) by the discrete gradient of q: at ρ∞ = 1 the
/// spring conserves its energy exactly, and the damper dissipates d(q̇) q̇ Δt.
/// @eq{torsion-gradient} @eq{law-mean}
class JointSpring : public InteractionItem {
 public:
  /// @param load  Its angle or displacement; values stiffness, quadratic, damping; laws.
  JointSpring(const LoadDescription& load, const char* free_value);

  [[nodiscard]] bool conservative() const { return damper_.is_zero(); }
  [[nodiscard]] bool dissipates() const { return !damper_.is_zero(); }
  [[nodiscard]] int history_size() const { return 1; }  ///< The coordinate at t_n.
  [[nodiscard]] Coupling coupling() const {
    return std::holds_alternative<FreeAngle>(coordinate_) ? Coupling::couple : Coupling::all;
  }
  void evaluate(const PairStep& step, PairTerms& terms) const;
  [[nodiscard]] Work work(const PairStep& step) const;
  /// Report at an instant: force [N] or moment [N m] on b, coordinate with counted turns, its rate,
  /// energy [J].
  [[nodiscard]] std::vector<double> report(const PairStep& step) const;
  void initialize(const PairStep& step, double* history) const;
  void commit(const PairStep& step, double* history) const;
  void commit_off(const PairStep& step, double* history) const { commit(step, history); }
  void switch_on(const PairStep& step, double* history) const { commit(step, history); }

 private:
  [[nodiscard]] CoordinateMotion coordinate(const PairStep& step) const;

  JointCoordinate coordinate_;
  double free_;
  ForceLaw spring_;
  ResistanceLaw damper_;
};

/// Torsional spring: values stiffness [N m/rad], quadratic [N m/rad²], damping [N m s/rad],
/// free_angle [rad]; laws spring_moment, damper_moment.
struct TorsionalSpring : JointSpring {
  static constexpr const char* kKind = "torsional_spring";
  explicit TorsionalSpring(const LoadDescription& load) : JointSpring(load, "free_angle") {}
};
/// Translational spring: values stiffness [N/m], quadratic [N/m²], damping [N s/m],
/// free_displacement [m]; laws spring_force, damper_force.
struct TranslationalSpring : JointSpring {
  static constexpr const char* kKind = "translational_spring";
  explicit TranslationalSpring(const LoadDescription& load)
      : JointSpring(load, "free_displacement") {}
};

/// Adds a spring in a joint to the system.
void add_torsional_spring(System& system, const LoadDescription& load);
void add_translational_spring(System& system, const LoadDescription& load);

}  // namespace polhode
