// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <vector>

#include <polhode/core/time_function.hpp>
#include <polhode/joints/parts/configuration.hpp>
#include <polhode/joints/recipe.hpp>

namespace polhode {

/// Prescribed motion of a joint's frame on its first body, by functions of time: a displacement of
/// its origin along the axes of that frame at rest, and a rotation about them.
struct FrameMotion {
  /// Parameters of the rotation. An Euler sequence has three letters: small ones are turns about
  /// the axes that turn along, capital ones about the axes at rest.
  enum class Rotation : unsigned char { none, vector, euler, quaternion };

  TimeVector displacement{};  ///< [m]; null is zero.
  Rotation rotation = Rotation::none;
  /// Rotation vector or Euler angles [rad], or a quaternion (w, x, y, z) of any length but zero.
  std::array<TimeFunctionPtr, 4> parameters{};
  std::string sequence{};  ///< Of Euler angles.

  /// Origin and axes, seen from the frame at rest.
  struct Placement {
    Vec3 d = Vec3::Zero();
    Mat3 D = Mat3::Identity();
  };
  /// A placement with its rates, all along the axes of the frame at rest.
  struct Course : Placement {
    Vec3 d_dot = Vec3::Zero(), d_ddot = Vec3::Zero();  ///< [m/s], [m/s²]
    Vec3 omega = Vec3::Zero(), alpha = Vec3::Zero();   ///< [rad/s], [rad/s²]
  };

  /// @param part  Of the motion, in statics.
  [[nodiscard]] Placement at(double t, double part) const;
  [[nodiscard]] Course course(double t, TimeSide side) const;
  [[nodiscard]] std::vector<TimeFunctionPtr> time_functions() const;
};

/// The body that the moving frame would be fixed in, were it at rest there: the first body's step
/// with the motion on top, rates from after t_{n+1}.
[[nodiscard]] BodyStep carried_step(const FrameMotion& motion, const JointFrames& frames,
                                    const BodyStep& a, const StepContext& context);

/// The sides of a joint whose frame on a moves, from the sides with the frame at rest.
/// @param q_alpha, q_n1  At t_{n+αf} and t_{n+1}; the frame's point and axes are replaced.
/// @eq{moving-frame}
void move_frame(const FrameMotion& motion, const JointFrames& frames, const PairStep& step,
                Configuration& q_alpha, Configuration& q_n1);

/// Velocity and acceleration of the frame at t_{n+1} beyond those that a gives it, as of a body
/// about the centre of mass of a, world components.
struct FrameRates {
  Vec3 omega = Vec3::Zero();  ///< [rad/s]
  Vec3 v = Vec3::Zero();      ///< [m/s]
  Vec3 alpha = Vec3::Zero();  ///< [rad/s²]
  Vec3 a = Vec3::Zero();      ///< [m/s²]
};
[[nodiscard]] FrameRates frame_rates(const FrameMotion& motion, const JointFrames& frames,
                                     const BodyStep& a, const StepContext& context, TimeSide side);

}  // namespace polhode
