// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/core/types.hpp>

namespace polhode {

/// A frame that turns steadily about an axis at rest, in which a spinning model is at rest. At the
/// time of interest its axes are those of the world.
struct TurningFrame {
  Vec3 axis = Vec3::UnitZ();    ///< Unit vector.
  Vec3 through = Vec3::Zero();  ///< A point of the axis [m].
  double speed = 0.0;           ///< Ω, right-handed about the axis [rad/s].
  bool ground_turns = false;    ///< Whether the ground turns with the frame.

  [[nodiscard]] Vec3 omega() const { return speed * axis; }
  /// Z: projection onto the plane normal to the axis.
  [[nodiscard]] Mat3 across() const { return Mat3::Identity() - axis * axis.transpose(); }
  /// From the axis to a point [m].
  [[nodiscard]] Vec3 arm(const Vec3& x) const { return across() * (x - through); }
};

}  // namespace polhode
