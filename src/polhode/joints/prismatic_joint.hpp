// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/joints/recipe.hpp>

namespace polhode {

/// Prismatic joint (slider): the axes stay parallel, b moves only along z of a.
[[nodiscard]] inline JointRecipe prismatic_joint(const JointFrames& f, const JointParameters&) {
  return joint_of(f, PointInPlane{kX}, PointInPlane{kY},  //
                  OrthogonalAxes{kZ, kX}, OrthogonalAxes{kZ, kY}, OrthogonalAxes{kX, kY});
}

}  // namespace polhode
