// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/loads/force_law.hpp>
#include <polhode/loads/load_vector.hpp>

namespace polhode {

/// A spring and a damper in parallel between a point of a and a point of b.
///
/// In conserving form the length at t_{n+αf} is the average of the lengths at the ends of the
/// step, not the length of the averaged offset u_α, and the force on b is
///
///   F = −N u_α / l_α,   N = k (l_α − l_0) + c l̇_α,   l̇_α = u_α·u̇_α / l_α.   @eq{spring-gradient}
///
/// With k (l_α − l_0) replaced by the mean of a law over the step where it is not linear
/// @eq{law-mean}, and c l̇_α by a resistance, whose jumps have rows @eq{law-jump}.
///
/// Then l_{n+1} − l_n = u_α·Δu/l_α at ρ∞ = 1, so the spring conserves its energy exactly and the
/// damper dissipates c l̇_α² Δt ≥ 0. While the points coincide only a spring of free length zero
/// has a defined force; others do not act.
class SpringDamper : public InteractionItem {
 public:
  static constexpr const char* kKind = "spring_damper";
  /// @param load  Values stiffness [N/m], quadratic [N/m²], damping [N s/m], free_length [m]; laws
  ///              spring_force of the elongation, damper_force of its rate; the word acts.
  explicit SpringDamper(const LoadDescription& load);

  [[nodiscard]] bool conservative() const { return damper_.is_zero() && !pull_ && !of_motion_; }
  [[nodiscard]] bool dissipates() const {
    return !damper_.is_zero() || (of_motion_ && of_motion_->reads_velocity);
  }
  [[nodiscard]] int rows() const { return damper_.rows(); }
  [[nodiscard]] bool works() const { return true; }
  [[nodiscard]] bool compliant() const { return set_valued(); }
  [[nodiscard]] bool set_valued() const { return damper_.rows() > 0; }
  [[nodiscard]] int history_size() const { return damper_.memory_size(); }
  /// Nothing: at an instant the forces of its rows are given.
  void acceleration_terms(const PairStep&, Vec6&) const {}
  [[nodiscard]] std::vector<TimeFunctionPtr> time_functions() const { return {pull_}; }
  [[nodiscard]] bool piecewise() const { return spring_.piecewise() || damper_.piecewise(); }
  void pieces(const PairStep& step, ForcePieces& pieces) const;
  void evaluate(const PairStep& step, PairTerms& terms) const;
  [[nodiscard]] Work work(const PairStep& step) const;
  /// Report at an instant: force on b [N], length [m], its rate [m/s], energy stored [J].
  [[nodiscard]] std::vector<double> report(const PairStep& step) const;
  /// Distance of the points at t_{n+1} [m].
  [[nodiscard]] double length(const PairStep& step) const;
  void initialize(const PairStep& step, double* history) const;
  void commit(const PairStep& step, double* history) const;
  void switch_on(const PairStep& step, double* history) const { initialize(step, history); }

 private:
  struct Stretch;
  [[nodiscard]] Stretch stretch(const PairStep& step) const;
  /// Given attractive force between the points [N], with its derivatives by length and rate.
  [[nodiscard]] CoordinateValue pull(const PairStep& step, const Stretch& s, bool tangents) const;
  [[nodiscard]] double rate_now(const PairStep& step) const;  ///< At t_{n+1}.
  [[nodiscard]] StepRates rates(const PairStep& step, const Stretch& s) const;
  [[nodiscard]] LawValue tension(const PairStep& step, const Stretch& s) const;

  Vec3 Z_a_, Z_b_;
  double l_0_;
  ForceLaw spring_;
  ResistanceLaw damper_;
  TimeFunctionPtr pull_;  ///< Attractive force between the points [N], or null.
  std::optional<CoordinateFunction> of_motion_;  ///< Likewise, of length and rate.
};

/// A given force along the line between two points, positive if attractive, plus a damper.
struct AxialForce : SpringDamper {
  static constexpr const char* kKind = "axial_force";
  using SpringDamper::SpringDamper;
};

/// Gravity between two centres of mass, V = −K/l with K = G m_a m_b unless it is given.
/// @eq{attraction-gradient}
struct Attraction : SpringDamper {
  static constexpr const char* kKind = "attraction";
  explicit Attraction(const LoadDescription& load);
};

/// A force along the line between two points, from a potential V(l) of their distance.
/// @eq{law-mean}
struct PotentialForce : SpringDamper {
  static constexpr const char* kKind = "potential";
  explicit PotentialForce(const LoadDescription& load);
};

void add_potential_force(System& system, const LoadDescription& load);
void add_axial_force(System& system, const LoadDescription& load);
void add_attraction(System& system, const LoadDescription& load);
/// Adds a SpringDamper to the system. Without free_length it is the distance at the start.
void add_spring_damper(System& system, const LoadDescription& load);

}  // namespace polhode
