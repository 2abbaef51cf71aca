// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include <polhode/core/types.hpp>

namespace polhode {

/// Reported coordinates of the connecting line of joints between points that are apart.
enum class RodKind : unsigned char {
  none,
  hinge,  ///< Angle about z of a, from x.
  cross,  ///< Angles about x of a and about the rotated y; none along z.
  link    ///< Distance of the points.
};

/// Coordinates of the line u from the point of a to that of b, relative to a. Angles lie between −π
/// and π: turns are not counted.
struct RodCoordinates {
  int count = 0;
  double value[2] = {}, rate[2] = {};  ///< [rad] or [m], and per second.

  [[nodiscard]] static std::vector<std::string> names(RodKind kind) {
    if (kind == RodKind::hinge) return {"rz"};
    if (kind == RodKind::cross) return {"rx", "ry"};
    if (kind == RodKind::link) return {"distance"};
    return {};
  }

  /// @param u  In the joint axes of a [m].
  /// @param u_dot  Its derivative relative to a [m/s].
  RodCoordinates(RodKind kind, const Vec3& u, const Vec3& u_dot) {
    const double in_plane = u.y() * u.y() + u.z() * u.z(), across = std::sqrt(in_plane);
    switch (kind) {
      case RodKind::none:
        break;
      case RodKind::hinge:
        add(std::atan2(u.y(), u.x()),
            (u.x() * u_dot.y() - u.y() * u_dot.x()) / (u.x() * u.x() + u.y() * u.y()));
        break;
      case RodKind::cross: {
        const double widens = (u.y() * u_dot.y() + u.z() * u_dot.z()) / across;
        add(std::atan2(-u.y(), u.z()), (u.y() * u_dot.z() - u.z() * u_dot.y()) / in_plane);
        add(std::atan2(u.x(), across), (across * u_dot.x() - u.x() * widens) / u.squaredNorm());
        break;
      }
      case RodKind::link:
        add(u.norm(), u.norm() > 0.0 ? u.dot(u_dot) / u.norm() : 0.0);
        break;
    }
  }

 private:
  void add(double x, double v) {
    value[count] = x;
    rate[count++] = v;
  }
};

}  // namespace polhode
