// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <numbers>

#include <polhode/dynamics/body_step.hpp>
#include <polhode/joints/frame_motion.hpp>

namespace polhode {

/// Angle by which a frame is driven over a step along its functions, or a larger one [rad]. It
/// counts whole turns, which leave no trace in the placements at both ends.
[[nodiscard]] double driven_turn(const FrameMotion& motion, const StepContext& context);

/// Whether it is half a turn or more.
[[nodiscard]] inline bool is_driven_half_a_turn(const FrameMotion& motion,
                                                const StepContext& context) {
  return driven_turn(motion, context) >= std::numbers::pi;
}

}  // namespace polhode
