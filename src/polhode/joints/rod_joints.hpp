// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/joints/recipe.hpp>

namespace polhode {

/// Massless rod on a hinge: it turns about z of a and carries the point of b on a ball.
/// @param p  Value "distance" [m], its length, positive.
[[nodiscard]] inline JointRecipe revolute_spherical_joint(const JointFrames& f,
                                                          const JointParameters& p) {
  return rod_of(RodKind::hinge, f, PointInPlane{kZ}, Distance{p.values.at("distance")});
}

/// Massless rod on a cross: it turns about x of a, then about its own y, and carries the point of b
/// on a ball. No moment reaches the rod, so it holds what a rod with two balls holds.
/// @param p  Value "distance" [m], its length, positive.
[[nodiscard]] inline JointRecipe universal_spherical_joint(const JointFrames& f,
                                                           const JointParameters& p) {
  return rod_of(RodKind::cross, f, Distance{p.values.at("distance")});
}

/// Link with slack: the points come as near and as far as its limits let them, and nothing holds
/// them between.
[[nodiscard]] inline JointRecipe slack_link_joint(const JointFrames& f, const JointParameters&) {
  return rod_of(RodKind::link, f);
}

}  // namespace polhode
