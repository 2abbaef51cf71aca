// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/joints/recipe.hpp>

namespace polhode {

/// Planar joint: b slides in the x, y plane of a and rotates about its normal z.
[[nodiscard]] inline JointRecipe planar_joint(const JointFrames& f, const JointParameters&) {
  return joint_of(f, PointInPlane{kZ}, OrthogonalAxes{kZ, kX}, OrthogonalAxes{kZ, kY});
}

}  // namespace polhode
