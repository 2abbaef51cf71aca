// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/joints/recipe.hpp>

namespace polhode {

/// Revolute joint (hinge): the joint points coincide and the z axes stay parallel; rotation about z
/// is free.
[[nodiscard]] inline JointRecipe revolute_joint(const JointFrames& f, const JointParameters&) {
  return joint_of(f, CoincidentPoints{}, OrthogonalAxes{kZ, kX}, OrthogonalAxes{kZ, kY});
}

}  // namespace polhode
