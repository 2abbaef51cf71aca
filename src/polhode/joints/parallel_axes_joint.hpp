// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/joints/recipe.hpp>

namespace polhode {

/// Parallel-axes joint: the z axes stay parallel; all translations and rotation about z are free.
[[nodiscard]] inline JointRecipe parallel_axes_joint(const JointFrames& f, const JointParameters&) {
  return joint_of(f, OrthogonalAxes{kZ, kX}, OrthogonalAxes{kZ, kY});
}

}  // namespace polhode
