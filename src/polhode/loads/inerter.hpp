// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/loads/coordinate_row.hpp>

namespace polhode {

struct LoadKind;

/// An inerter along a free coordinate q of a joint: its force on b along q is −J d²q/dt².
///
/// A mass on a slide on the ground has the displacement q, or q times a length if q is an angle, by
/// a row without work between the two coordinates. Its energy J q̇²/2 is therefore conserved exactly
/// at ρ∞ = 1, and it takes part in impacts. @eq{inerter}
class Inerter : public CoordinateRow {
 public:
  /// @param load  With the two coordinates, and the value inertance [kg m² or kg].
  /// @param part  0: that of the joint, 1: the mass's.
  Inerter(const LoadDescription& load, std::size_t part)
      : CoordinateRow(load, part), inertance_(load.value("inertance", 0.0)) {}
  /// Report at an instant: force or moment on b, coordinate with counted turns, its rate, energy
  /// [J].
  [[nodiscard]] std::vector<double> report(const PairStep& step) const;

 private:
  double inertance_;
};

/// Inerter about a free axis, inertance in kg m².
struct RotaryInerter : Inerter {
  static constexpr const char* kKind = "rotary_inerter";
  using Inerter::Inerter;
};

/// Inerter along a free direction, inertance in kg.
struct LinearInerter : Inerter {
  static constexpr const char* kKind = "linear_inerter";
  using Inerter::Inerter;
};

/// The entry of an inerter in the registry of loads.
/// @param of    Its coordinate, in words.
/// @param unit  Of the inertance, SI.
[[nodiscard]] LoadKind inerter_kind(const char* name, const char* of, const char* unit, bool turns);

}  // namespace polhode
