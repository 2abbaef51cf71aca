// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/loads/load_description.hpp>

namespace polhode {

/// Resistance of a medium at rest to a body: force −(c_1 + c_2 |v| + α m) v at its centre of mass,
/// moment −(c_θ + α J) ω, with mean velocities of the step: it dissipates −(F·Δr + M·θ) ≥ 0. α is
/// mass-proportional damping. @eq{drag-law}
class Drag : public InteractionItem {
 public:
  static constexpr const char* kKind = "drag";
  /// @param load  Values linear [N s/m], quadratic_drag [N s²/m²], turning [N m s/rad],
  ///              per_mass [1/s].
  explicit Drag(const LoadDescription& load);

  [[nodiscard]] bool conservative() const { return false; }
  [[nodiscard]] bool dissipates() const { return true; }
  [[nodiscard]] bool piecewise() const { return quadratic_ != 0.0; }
  /// The half of all directions in which it moves: |v| v has a kink where v is zero, and motion on
  /// a line leaves its half there.
  void pieces(const PairStep& step, ForcePieces& pieces) const;
  void evaluate(const PairStep& step, PairTerms& terms) const;
  [[nodiscard]] Work work(const PairStep& step) const;
  /// Report at an instant: force [N] and moment [N m].
  [[nodiscard]] std::vector<double> report(const PairStep& step) const;

 private:
  double linear_, quadratic_, turning_, per_mass_, mass_;
  Mat3 inertia_;
};

/// Damper of the motion of a point on one body relative to another body: force −c u̇, moment
/// −c_θ (ω_b − ω_a), with the velocities u̇ of both bodies at that point, as of a viscous medium
/// that the other body carries. Forces and moments are in balance, and a common motion is free.
/// @eq{drag-law}
class VectorDamper : public InteractionItem {
 public:
  static constexpr const char* kKind = "vector_damper";
  /// @param load  Values damping [N s/m], turning_damping [N m s/rad].
  explicit VectorDamper(const LoadDescription& load);

  [[nodiscard]] bool conservative() const { return false; }
  [[nodiscard]] bool dissipates() const { return true; }
  void evaluate(const PairStep& step, PairTerms& terms) const;
  [[nodiscard]] Work work(const PairStep& step) const;
  /// Report at an instant: force [N] and moment [N m] on b at its point.
  [[nodiscard]] std::vector<double> report(const PairStep& step) const;

 private:
  /// Relative motion at the common place, at t_{n+αf}.
  struct Slip {
    Vec3 arm_a, arm_b;       ///< From the centres of mass [m].
    Vec3 velocity, turning;  ///< Of b relative to a [m/s, rad/s].
  };
  [[nodiscard]] Slip slip(const PairStep& step) const;

  Vec3 Z_a_, Z_b_;
  double c_, c_turn_;
  bool on_b_;  ///< The point is that on b; if b is the ground, that on a.
};

void add_drag(System& system, const LoadDescription& load);
void add_vector_damper(System& system, const LoadDescription& load);

}  // namespace polhode
