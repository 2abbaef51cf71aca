// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/loads/load_description.hpp>

namespace polhode {

/// A linear spring and a damper, side by side, between a point of a and a point of b.
///
/// In conserving form the length at t_{n+αf} is the average of the lengths at the ends of the
/// step, not the length of the averaged offset u_α, and the force on b is
///
///   F = −N u_α / l_α,   N = k (l_α − l_0) + c l̇_α,   l̇_α = u_α·u̇_α / l_α.   @eq{spring-gradient}
///
/// Then l_{n+1} − l_n = u_α·Δu/l_α at ρ∞ = 1, so the spring gives back exactly what it stored
/// and the damper takes c l̇_α² Δt ≥ 0. While the points coincide only a spring of free length
/// zero has a direction to pull; others do not act.
class SpringDamper : public InteractionItem {
 public:
  static constexpr const char* kKind = "spring_damper";
  /// @param load  Values stiffness [N/m], damping [N s/m], free_length [m].
  explicit SpringDamper(const LoadDescription& load);

  [[nodiscard]] bool conservative() const { return c_ == 0.0; }
  [[nodiscard]] bool dissipates() const { return c_ != 0.0; }
  void evaluate(const PairStep& step, PairTerms& terms) const;
  [[nodiscard]] Work work(const PairStep& step) const;
  /// At an instant: force on b [N], length [m], its rate [m/s], energy stored [J].
  [[nodiscard]] std::vector<double> report(const PairStep& step) const;
  /// Distance of the points at t_{n+1} [m].
  [[nodiscard]] double length(const PairStep& step) const;

 private:
  struct Stretch;
  [[nodiscard]] Stretch stretch(const PairStep& step) const;
  [[nodiscard]] Vec3 force_on_b(const Stretch& s) const;

  Vec3 Z_a_, Z_b_;
  double k_, c_, l_0_;
};

/// Adds a SpringDamper to the system. free_length left out is the distance at the start.
void add_spring_damper(System& system, const LoadDescription& load);

}  // namespace polhode
