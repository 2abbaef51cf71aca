// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/joints/recipe.hpp>

namespace polhode {

/// Massless rod with spherical joints at both ends: the distance of the joint points is constant.
/// @param p  Value "distance" [m], positive.
[[nodiscard]] inline JointRecipe distance_joint(const JointFrames& f, const JointParameters& p) {
  return joint_of(f, Distance{p.values.at("distance")});
}

}  // namespace polhode
