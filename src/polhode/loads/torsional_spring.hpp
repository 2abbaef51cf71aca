// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/loads/load_description.hpp>

namespace polhode {

/// A torsional spring and damper about the axis of a joint, turns counted.
///
/// The moment on b is −M μ with μ the discrete gradient of the joint's angle φ and
/// M = k (φ_α − φ_0) + c φ̇_α; at ρ∞ = 1 it does exactly −M Δφ. @eq{torsion-gradient}
class TorsionalSpring : public InteractionItem {
 public:
  static constexpr const char* kKind = "torsional_spring";
  /// @param load  Its angle, and values stiffness [N m/rad], damping [N m s/rad], free_angle [rad].
  explicit TorsionalSpring(const LoadDescription& load);

  [[nodiscard]] bool conservative() const { return c_ == 0.0; }
  [[nodiscard]] bool dissipates() const { return c_ != 0.0; }
  [[nodiscard]] int history_size() const { return 1; }  ///< The angle at t_n.
  void evaluate(const PairStep& step, PairTerms& terms) const;
  [[nodiscard]] Work work(const PairStep& step) const;
  /// At an instant: moment on b [N m], angle, turns counted [rad], its rate [rad/s], energy [J].
  [[nodiscard]] std::vector<double> report(const PairStep& step) const;
  void initialize(const PairStep& step, double* history) const;
  void commit(const PairStep& step, double* history) const;

 private:
  FreeAngle angle_;
  double k_, c_, phi_0_;
};

/// Adds a TorsionalSpring to the system.
void add_torsional_spring(System& system, const LoadDescription& load);

}  // namespace polhode
