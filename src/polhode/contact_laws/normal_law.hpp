// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include <polhode/math/dual.hpp>

namespace polhode::contact {

/// Potentials of a gap.
enum class NormalPotential { barrier, linear, hertz };

/// Words of the potentials in model files.
struct PotentialWord {
  std::string_view word;
  NormalPotential potential;
};
inline constexpr std::array kPotentialWords{PotentialWord{"barrier", NormalPotential::barrier},
                                            PotentialWord{"linear", NormalPotential::linear},
                                            PotentialWord{"hertz", NormalPotential::hertz}};

/// Potential of a word; none for impulses, which have no potential.
[[nodiscard]] constexpr std::optional<NormalPotential> potential_of(std::string_view word) {
  for (const PotentialWord& known : kPotentialWords)
    if (known.word == word) return known.potential;
  return std::nullopt;
}

/// Whether surfaces may overlap, the deeper the higher the load: by a spring, not by a barrier.
[[nodiscard]] constexpr bool is_spring(NormalPotential potential) {
  switch (potential) {
    case NormalPotential::barrier:
      return false;
    case NormalPotential::linear:
    case NormalPotential::hertz:
      return true;
  }
  return true;
}

/// Potential b(g) of a contact point as a function of its gap g, with its force and its quotient.
///
/// The barrier acts on the band between its floor, where it is infinite, and its activation
/// distance (reach): with s = (g − floor)/d̂, d̂ = reach − floor,
///
///   b = (k d̂²/3)(1/s − 3 + 3s − s²),   f = −b' = (k d̂/3)(1/s² − 3 + 2s)
///
/// for s < 1 and zero beyond, twice continuously differentiable and convex. The others act on the
/// depth δ = reach − g: linear b = ½ k δ², Hertz b = (2/5) k δ^{5/2}. With a floor, which is the
/// gap that rounded surfaces can have at least, a barrier adds to them on the last quarter of the
/// way to it. @eq{spring-floor}
///
/// The quotient λ = −(b(g_1) − b(g_0))/(g_1 − g_0) is written without the difference, so it has no
/// 0/0; it is never negative. With it the step conserves the energy exactly. @eq{contact-quotient}
///
/// Differences between laws are in this class alone: each function has a switch over all
/// potentials.
struct NormalLaw {
  NormalPotential potential = NormalPotential::barrier;
  double stiffness = 1.0;   ///< k [N/m]; Hertz: [N/m^{3/2}].
  double tolerance = 1e-3;  ///< Of the gap [m].
  /// Ends of the band, if they are not ±tolerance of a barrier; of a spring 0 and none [m].
  std::optional<double> upper, lower;
  /// Gap at which a barrier starts to act, if that is within its band: its force is reduced by the
  /// one there [m]. @eq{contact-later}
  std::optional<double> later;

  /// Activation distance: larger gaps carry no force [m].
  [[nodiscard]] double reach() const { return later ? *later : end(); }
  /// Gap that no step may reach [m]; −∞ if the law allows any overlap.
  [[nodiscard]] double floor() const;
  /// Whether a spring is stiffer at this gap, as that is near its floor.
  [[nodiscard]] bool is_near_floor(double gap) const;
  /// Floor of a spring that starts to stiffen at this gap [m].
  [[nodiscard]] static double floor_below(double gap);
  [[nodiscard]] double band() const { return end() - floor(); }
  [[nodiscard]] bool is_spring() const { return contact::is_spring(potential); }
  [[nodiscard]] NormalLaw with_stiffness(double k) const {
    NormalLaw law = *this;
    law.stiffness = k;
    return law;
  }

  [[nodiscard]] double energy(double gap) const;  ///< b [J]
  /// Gap with this energy; reach() if it is zero.
  [[nodiscard]] double gap_of(double energy) const;
  /// Activation distance with which the law stores an energy at a gap [m]. @eq{contact-same-energy}
  [[nodiscard]] double reach_for(double gap, double energy) const;

  /// Stiffness of a law in the units of its k, and of the bristle of friction beside it [N/m].
  struct Stiffness {
    double normal, bristle;
  };
  /// Stiffness that carries a load [N] within the tolerance. @eq{contact-stiffness}
  /// @eq{spring-stiffness} @param least  Smallest stiffness, for the tolerance as depth [N/m].
  [[nodiscard]] Stiffness stiffness_under(double load, double least) const;
  /// Stiffness of the bristle beside a given k [N/m].
  [[nodiscard]] double bristle_stiffness() const;
  /// Slope −f' at the gap in equilibrium with a load [N/m].
  [[nodiscard]] double slope_under(double load) const;
  /// Depth in equilibrium with a load; of a barrier below its activation distance [m].
  [[nodiscard]] double depth_under(double load) const;
  /// k that stops a mass within the tolerance. @eq{contact-stiffness} @eq{spring-stiffness}
  /// @param speed  Of approach [m/s].
  [[nodiscard]] double stiffness_in_impact(double mass, double speed) const;
  /// Duration of an elastic impact [s]. @param speed  Of approach [m/s].
  [[nodiscard]] double impact_duration(double mass, double speed) const;

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
  [[nodiscard]] double end() const { return upper ? *upper : is_spring() ? 0.0 : tolerance; }
  /// Barrier of a spring near its floor, which starts no earlier than the spring.
  [[nodiscard]] NormalLaw barrier_at_floor() const;
  /// Energy [J], force [N] and quotient [N] of the potential without that barrier, where it acts.
  [[nodiscard]] double own_energy(double gap) const;
  [[nodiscard]] WithSlope own_force(double gap) const;
  [[nodiscard]] WithSlope own_quotient(double gap_0, double gap_1) const;
  /// Activation distance without that barrier [m].
  [[nodiscard]] double own_reach_for(double gap, double energy) const;
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
