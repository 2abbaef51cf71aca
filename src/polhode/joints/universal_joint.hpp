// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/joints/recipe.hpp>

namespace polhode {

/// Universal (cardan) joint: the joint points coincide and x of a stays orthogonal to y of b;
/// rotation about these two is free.
[[nodiscard]] inline JointRecipe universal_joint(const JointFrames& f, const JointParameters&) {
  return joint_of(f, CoincidentPoints{}, OrthogonalAxes{kX, kY});
}

}  // namespace polhode
