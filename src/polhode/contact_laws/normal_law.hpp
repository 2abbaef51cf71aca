// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <polhode/math/dual.hpp>

namespace polhode::contact {

/// Potentials of a gap.
enum class NormalPotential { barrier, linear, hertz };

/// Potential b(g) of a contact point as a function of its gap g, with its force and its quotient.
///
/// The barrier acts on the band between its floor, where it is infinite, and its activation
/// distance (reach): with s = (g − floor)/d̂, d̂ = reach − floor,
///
///   b = (k d̂²/3)(1/s − 3 + 3s − s²),   f = −b' = (k d̂/3)(1/s² − 3 + 2s)
///
/// for s < 1 and zero beyond, twice continuously differentiable and convex. The others act on the
/// depth δ = reach − g: linear b = ½ k δ², Hertz b = (2/5) k δ^{5/2}.
///
/// The quotient λ = −(b(g_1) − b(g_0))/(g_1 − g_0) is written without the difference, so it has no
/// 0/0; it is never negative. With it the step conserves the energy exactly. @eq{contact-quotient}
struct NormalLaw {
  NormalPotential potential = NormalPotential::barrier;
  double stiffness = 1.0;   ///< k [N/m]; Hertz: [N/m^{3/2}].
  double tolerance = 1e-3;  ///< Of the gap [m].
  /// Ends of the band, if they are not ±tolerance of a barrier, or 0 of another potential [m].
  std::optional<double> upper, lower;
  /// Gap at which a barrier starts to act, if that is within its band: its force is reduced by the
  /// one there [m]. @eq{contact-later}
  std::optional<double> later;

  /// Activation distance: larger gaps carry no force [m].
  [[nodiscard]] double reach() const { return later ? *later : end(); }
  /// Gap that no step may reach [m]; −∞ if the law allows overlaps.
  [[nodiscard]] double floor() const;
  [[nodiscard]] double band() const { return end() - floor(); }

  [[nodiscard]] double energy(double gap) const;  ///< b [J]
  /// Gap with this energy; reach() if it is zero.
  [[nodiscard]] double gap_of(double energy) const;
  /// Activation distance with which the law stores an energy at a gap [m]. @eq{contact-same-energy}
  [[nodiscard]] double reach_for(double gap, double energy) const;
  template <class T>
  [[nodiscard]] T force(const T& gap) const;  ///< f = −b' [N]
  template <class T>
  [[nodiscard]] T energy_of(const T& gap) const;  ///< b with derivatives.
  template <class T>
  [[nodiscard]] T quotient(double gap_0, const T& gap_1) const;  ///< λ [N]

  /// Value with the derivative by the gap at the end of the step [N/m].
  struct WithSlope {
    double value, slope;
  };
  [[nodiscard]] WithSlope force_and_slope(double gap) const;
  [[nodiscard]] WithSlope quotient_and_slope(double gap_0, double gap_1) const;

 private:
  /// Upper end of the band [m].
  [[nodiscard]] double end() const {
    return upper ? *upper : potential == NormalPotential::barrier ? tolerance : 0.0;
  }
  /// s where it starts to act.
  [[nodiscard]] double first() const { return later ? (*later - floor()) / band() : 1.0; }
  [[nodiscard]] static double chained(double, const WithSlope& f) { return f.value; }
  [[nodiscard]] static Dual chained(const Dual& x, const WithSlope& f) {
    return x.chained(f.value, f.slope);
  }
};

template <class T>
T NormalLaw::force(const T& gap) const {
  return chained(gap, force_and_slope(value(gap)));
}

template <class T>
T NormalLaw::energy_of(const T& gap) const {
  return chained(gap, {energy(value(gap)), -force_and_slope(value(gap)).value});
}

template <class T>
T NormalLaw::quotient(double gap_0, const T& gap_1) const {
  return chained(gap_1, quotient_and_slope(gap_0, value(gap_1)));
}

}  // namespace polhode::contact
