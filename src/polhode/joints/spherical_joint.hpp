// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/joints/recipe.hpp>

namespace polhode {

/// Spherical joint (ball): the joint points coincide; all rotations are free.
[[nodiscard]] inline JointRecipe spherical_joint(const JointFrames& f, const JointParameters&) {
  return joint_of(f, CoincidentPoints{});
}

}  // namespace polhode
