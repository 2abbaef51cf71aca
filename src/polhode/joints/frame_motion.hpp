// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <vector>

#include <polhode/core/time_function.hpp>
#include <polhode/core/types.hpp>

namespace polhode {

/// Prescribed motion of a joint's frame on its first body, by functions of time: a displacement of
/// its origin along the axes of the frame at rest, and a rotation about them.
struct FrameMotion {
  /// Parameters of the rotation. An Euler sequence has three letters: small ones are rotations
  /// about body-fixed axes, capital ones about the axes at rest.
  enum class Rotation : unsigned char { none, vector, euler, quaternion };

  TimeVector displacement{};  ///< [m]; null is zero.
  Rotation rotation = Rotation::none;
  /// Rotation vector or Euler angles [rad], or a quaternion (w, x, y, z) of any length but zero.
  std::array<TimeFunctionPtr, 4> parameters{};
  std::string sequence{};  ///< Of Euler angles.

  /// Origin and axes relative to the frame at rest.
  struct Placement {
    Vec3 d = Vec3::Zero();
    Mat3 D = Mat3::Identity();
  };
  /// A placement with its rates, all along the axes of the frame at rest.
  struct Course : Placement {
    Vec3 d_dot = Vec3::Zero(), d_ddot = Vec3::Zero();  ///< [m/s], [m/s²]
    Vec3 omega = Vec3::Zero(), alpha = Vec3::Zero();   ///< [rad/s], [rad/s²]
  };

  /// Placement at a time. @param part  Of the motion, in statics.
  [[nodiscard]] Placement at(double t, double part) const;
  [[nodiscard]] Course course(double t, TimeSide side) const;
  [[nodiscard]] std::vector<TimeFunctionPtr> time_functions() const;
};

}  // namespace polhode
