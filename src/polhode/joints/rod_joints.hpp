// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/joints/recipe.hpp>

namespace polhode {

/// Massless rod with a revolute joint about z of a and a spherical joint at the point of b.
/// @param p  Value "distance" [m], its length, positive.
[[nodiscard]] inline JointRecipe revolute_spherical_joint(const JointFrames& f,
                                                          const JointParameters& p) {
  return rod_of(RodKind::hinge, f, PointInPlane{kZ}, Distance{p.values.at("distance")});
}

/// Massless rod with a universal joint, x of a and its own y, and a spherical joint at the point of
/// b. The rod carries no moment, so its constraint is that of a rod with two spherical joints.
/// @param p  Value "distance" [m], its length, positive.
[[nodiscard]] inline JointRecipe universal_spherical_joint(const JointFrames& f,
                                                           const JointParameters& p) {
  return rod_of(RodKind::cross, f, Distance{p.values.at("distance")});
}

/// Link with slack: the distance of the points is free between its limits.
[[nodiscard]] inline JointRecipe slack_link_joint(const JointFrames& f, const JointParameters&) {
  return rod_of(RodKind::link, f);
}

}  // namespace polhode
