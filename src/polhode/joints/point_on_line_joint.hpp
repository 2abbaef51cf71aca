// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/joints/recipe.hpp>

namespace polhode {

/// Point-on-line joint: the point of b stays on the line through the point of a along z of a.
[[nodiscard]] inline JointRecipe point_on_line_joint(const JointFrames& f, const JointParameters&) {
  return joint_of(f, PointInPlane{kX}, PointInPlane{kY});
}

}  // namespace polhode
