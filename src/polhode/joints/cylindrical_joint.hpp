// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/joints/recipe.hpp>

namespace polhode {

/// Cylindrical joint (sleeve): b translates along z of a and rotates about it.
[[nodiscard]] inline JointRecipe cylindrical_joint(const JointFrames& f, const JointParameters&) {
  return joint_of(f, PointInPlane{kX}, PointInPlane{kY},  //
                  OrthogonalAxes{kZ, kX}, OrthogonalAxes{kZ, kY});
}

}  // namespace polhode
