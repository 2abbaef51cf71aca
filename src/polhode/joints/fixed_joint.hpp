// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/joints/recipe.hpp>

namespace polhode {

/// Fixed joint (weld): no free motion.
[[nodiscard]] inline JointRecipe fixed_joint(const JointFrames& f, const JointParameters&) {
  return joint_of(f, CoincidentPoints{},  //
                  OrthogonalAxes{kZ, kX}, OrthogonalAxes{kZ, kY}, OrthogonalAxes{kX, kY});
}

}  // namespace polhode
