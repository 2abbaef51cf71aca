// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/joints/recipe.hpp>

namespace polhode {

/// Point-in-plane joint: the point of b stays in the plane through the point of a with normal z of
/// a.
[[nodiscard]] inline JointRecipe point_in_plane_joint(const JointFrames& f,
                                                      const JointParameters&) {
  return joint_of(f, PointInPlane{kZ});
}

}  // namespace polhode
