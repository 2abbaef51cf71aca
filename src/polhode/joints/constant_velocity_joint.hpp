// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/joints/recipe.hpp>

namespace polhode {

/// Constant-velocity joint (Rzeppa, double cardan without length): the joint points coincide and
/// both shafts, z of a and z of b, rotate equally at any angle between them.
[[nodiscard]] inline JointRecipe constant_velocity_joint(const JointFrames& f,
                                                         const JointParameters&) {
  return joint_of(f, CoincidentPoints{}, EqualTurns{});
}

}  // namespace polhode
