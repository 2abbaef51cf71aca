// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/math/hat.hpp>

namespace polhode {

/// Placement of a body's coordinates: x = r + Λ·Z maps body points into space.
struct Pose {
  Vec3 r;       ///< Centre of mass, spatial [m].
  Mat3 Lambda;  ///< Rotation, material to spatial [-].
};

/// Velocities of a body, spatial.
struct Velocities {
  Vec3 r_dot;  ///< Of the centre of mass [m/s].
  Vec3 omega;  ///< Angular [rad/s].
};

/// Accelerations of a body, spatial.
struct Accelerations {
  Vec3 r_ddot;  ///< Of the centre of mass [m/s²].
  Vec3 alpha;   ///< Angular, α = ω̇ [rad/s²].
};

/// Rate of the rotation: Λ̇ = ω̂·Λ = Λ·Ŵ [1/s]. @eq{eq:rbm-lambda-dot}
[[nodiscard]] inline Mat3 rotation_rate(const Mat3& Lambda, const Vec3& omega) {
  return hat(omega) * Lambda;
}

/// Spatial vector of a material one, e.g. ω = Λ·W; then ω̂ = Λ·Ŵ·Λᵀ.
/// @eq{eq:rbm-material-spatial-angular-velocity} @eq{eq:rbr-rotation-t}
[[nodiscard]] inline Vec3 to_spatial(const Mat3& Lambda, const Vec3& material) {
  return Lambda * material;
}

/// Material vector of a spatial one, e.g. W = Λᵀ·ω.
[[nodiscard]] inline Vec3 to_material(const Mat3& Lambda, const Vec3& spatial) {
  return Lambda.transpose() * spatial;
}

/// Position of a body's point: x = r + Λ·Z [m]. @eq{eq:rbm-position}
/// @param Z  From the centre of mass, body axes [m].
[[nodiscard]] inline Vec3 point_position(const Pose& pose, const Vec3& Z) {
  return pose.r + pose.Lambda * Z;
}

/// Velocity of a body's point: ẋ = ṙ + Λ̇·Z = ṙ + ω × z [m/s].
/// @eq{eq:rbm-velocity} @eq{eq:rbm-rigid-point-velocity}
[[nodiscard]] inline Vec3 point_velocity(const Pose& pose, const Velocities& velocities,
                                         const Vec3& Z) {
  const auto& [r_dot, omega] = velocities;
  const Vec3 z = pose.Lambda * Z;
  return r_dot + omega.cross(z);
}

/// Acceleration of a body's point: ẍ = r̈ + α × z + ω × (ω × z) [m/s²].
/// @eq{eq:rbm-rigid-point-acceleration}
[[nodiscard]] inline Vec3 point_acceleration(const Pose& pose, const Velocities& velocities,
                                             const Accelerations& accelerations, const Vec3& Z) {
  const auto& [r_ddot, alpha] = accelerations;
  const Vec3& omega = velocities.omega;
  const Vec3 z = pose.Lambda * Z;
  return r_ddot + alpha.cross(z) + omega.cross(omega.cross(z));
}

}  // namespace polhode
