// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace polhode::io {

/// Exponents of the base dimensions. The angle is tracked leniently: as an angle is 1 (arc = angle
/// × radius) it may be left out or added.
struct Dimension {
  double length = 0.0, mass = 0.0, time = 0.0, angle = 0.0;

  friend Dimension operator+(const Dimension& a, const Dimension& b) {
    return {a.length + b.length, a.mass + b.mass, a.time + b.time, a.angle + b.angle};
  }
  friend Dimension operator*(double n, const Dimension& a) {
    return {n * a.length, n * a.mass, n * a.time, n * a.angle};
  }
  /// Whether dimensions are equal except for the angle.
  [[nodiscard]] bool matches(const Dimension& other) const;
  /// Whether it is dimensionless, without an angle.
  [[nodiscard]] bool is_none() const;
  /// Name of the dimension: "a length", "a force", or, without a name, "kg m^2/s^2".
  [[nodiscard]] std::string name() const;
  /// Its SI unit, "" for none.
  [[nodiscard]] std::string si_unit() const;
};

/// The dimensions of a model's values.
namespace dimensions {
inline constexpr Dimension kNone{};
inline constexpr Dimension kLength{1, 0, 0, 0};
inline constexpr Dimension kMass{0, 1, 0, 0};
inline constexpr Dimension kTime{0, 0, 1, 0};
inline constexpr Dimension kAngle{0, 0, 0, 1};
inline constexpr Dimension kVelocity{1, 0, -1, 0};
inline constexpr Dimension kAcceleration{1, 0, -2, 0};
inline constexpr Dimension kAngularVelocity{0, 0, -1, 1};
inline constexpr Dimension kForce{1, 1, -2, 0};
inline constexpr Dimension kMoment{2, 1, -2, 0};
inline constexpr Dimension kInertia{2, 1, 0, 0};
inline constexpr Dimension kDensity{-3, 1, 0, 0};
inline constexpr Dimension kPressure{-1, 1, -2, 0};
inline constexpr Dimension kViscosity{-1, 1, -1, 0};
inline constexpr Dimension kStiffness{0, 1, -2, 0};
inline constexpr Dimension kDamping{0, 1, -1, 0};
inline constexpr Dimension kAngularStiffness{2, 1, -2, -1};
inline constexpr Dimension kAngularDamping{2, 1, -1, -1};
}  // namespace dimensions

/// A unit as written, e.g. N/mm: its size in SI, and its dimension.
struct Unit {
  double factor = 1.0;
  Dimension dimension;
  bool has_hertz = false;  ///< It contains Hz: cycles or radians per second is ambiguous.
};

/// Result of reading a unit.
struct UnitReading {
  std::optional<Unit> unit;
  std::string what, hint;  ///< Of the error, if there is no unit.
};

/// Reads a unit: names with SI prefixes, joined by blanks, *, / and ^, e.g. "kg m^2/s".
[[nodiscard]] UnitReading read_unit(std::string_view text);

/// Names of all units without prefixes, for messages and the reference page.
[[nodiscard]] std::vector<std::string> unit_names();

/// Meaning of bare numbers: the size of each base unit in SI, from which others are derived.
struct UnitSystem {
  double length = 1.0, mass = 1.0, time = 1.0, angle = 1.0;

  /// SI value of a bare 1 of this dimension.
  [[nodiscard]] double factor(const Dimension& dimension) const;
  /// The same with angles in radians.
  [[nodiscard]] double factor_without_angle(const Dimension& dimension) const;
};

}  // namespace polhode::io
