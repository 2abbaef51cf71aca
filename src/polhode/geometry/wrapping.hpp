// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include <polhode/core/types.hpp>

namespace polhode::geometry {

/// An ellipsoid, sphere or round cylinder about the origin that a line is wrapped around.
struct Roller {
  Vec3 semi_axes = Vec3::Ones();  ///< Along x, y, z; z infinite: a cylinder, x and y equal [m].
  /// Direction to the side of the line, of any length; none: the shorter way.
  std::optional<Vec3> side{};

  [[nodiscard]] bool is_cylinder() const;
  [[nodiscard]] bool is_sphere() const;
  [[nodiscard]] double size() const;  ///< Its smallest semi-axis [m].
  /// Distance from the origin over that of the surface in the same direction, of a cylinder from
  /// the axis [-]; below 1 inside.
  [[nodiscard]] double depth(const Vec3& x) const;
};

/// Straight pieces by which an arc on a roller is drawn.
inline constexpr int kArcPieces = 16;

/// A point too near to the surface, or inside, has no line to the other one.
inline constexpr double kOutside = 1.0 + 1e-9;

/// The shortest line from p to q around a roller, on the given side: straight, along a geodesic of
/// the surface, straight. It is one straight line where the roller is not in its way.
/// @eq{wrap-tangency} @eq{wrap-length}
struct Wrapping {
  bool touches = false;
  double length = 0.0;                    ///< [m]
  Vec3 by_p = Vec3::Zero(), by_q = by_p;  ///< Derivative of the length [-].
  Mat6 second = Mat6::Zero();             ///< By (p, q), if wanted [1/m].
  Vec3 from = Vec3::Zero(), to = from;    ///< Where it meets the surface and leaves it [m].
  Vec3 direction = Vec3::Zero();          ///< At `from`, unit.
  double arc = 0.0;                       ///< Length on the surface [m].
  /// Angle from p to q as seen from the middle, in the scale in which the roller is round;
  /// negative: the longer way [rad].
  double angle = 0.0;
  /// From the middle to the side on which it passes, across the direction to p, unit, in that
  /// scale.
  Vec3 across = Vec3::Zero();

  /// Points along it, equally spaced on the surface, p and q included. @param arcs  Pieces on the
  /// surface. A straight line is divided into as many pieces.
  [[nodiscard]] std::vector<Vec3> points(const Roller& roller, const Vec3& p, const Vec3& q,
                                         int arcs) const;
};

/// @param second  Whether second derivatives are wanted.
/// @returns nothing if a point is not outside, or if no geodesic is found.
[[nodiscard]] std::optional<Wrapping> wrap(const Roller& roller, const Vec3& p, const Vec3& q,
                                           bool second);

/// End of a geodesic, with its Jacobi fields: distance of neighbours with a parallel start, and of
/// those with a turned start.
struct GeodesicEnd {
  Vec3 x = Vec3::Zero(), t = Vec3::Zero();  ///< Point and unit tangent.
  double across = 1.0, across_rate = 0.0;   ///< Of parallel starts [-], [1/m].
  double turned = 0.0, turned_rate = 1.0;   ///< Of turned ones [m], [-].
};

/// Follows the geodesic of a roller's surface from a point by a length. @eq{wrap-geodesic}
[[nodiscard]] GeodesicEnd follow_geodesic(const Roller& roller, const Vec3& from, const Vec3& along,
                                          double length);

}  // namespace polhode::geometry
