// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/joints/frame_motion.hpp>
#include <polhode/joints/parts/configuration.hpp>
#include <polhode/joints/recipe.hpp>

namespace polhode {

/// Virtual body to which the moving frame is fixed: the first body's step with the motion
/// superimposed, rates from after t_{n+1}.
[[nodiscard]] BodyStep carried_step(const FrameMotion& motion, const JointFrames& frames,
                                    const BodyStep& a, const StepContext& context);

/// Sides of a joint with a moving frame on a, from the sides with the frame at rest.
/// @param q_alpha, q_n1  At t_{n+αf} and t_{n+1}; the frame's point and axes are replaced.
/// @eq{moving-frame}
void move_frame(const FrameMotion& motion, const JointFrames& frames, const PairStep& step,
                Configuration& q_alpha, Configuration& q_n1);

/// Velocity and acceleration of the frame at t_{n+1} relative to a, as of a body about the centre
/// of mass of a, world components.
struct FrameRates {
  Vec3 omega = Vec3::Zero();  ///< [rad/s]
  Vec3 v = Vec3::Zero();      ///< [m/s]
  Vec3 alpha = Vec3::Zero();  ///< [rad/s²]
  Vec3 a = Vec3::Zero();      ///< [m/s²]
};
[[nodiscard]] FrameRates frame_rates(const FrameMotion& motion, const JointFrames& frames,
                                     const BodyStep& a, const StepContext& context, TimeSide side);

}  // namespace polhode
