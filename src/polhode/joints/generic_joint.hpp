// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/joints/recipe.hpp>

namespace polhode {

/// Generic joint: each of the six freedoms x, y, z, rx, ry, rz is free or locked.
///
/// Translations are along the axes of a; when all three are locked the joint points coincide.
/// One locked rotation keeps two axes orthogonal (rz locked: x of a and y of b, and so on in
/// cyclic order), two keep the third axis parallel, three keep all axes parallel.
///
/// @param p  free: the free ones.
/// @throws InputError if a freedom is unknown, given twice, or all six are free.
[[nodiscard]] JointRecipe generic_joint(const JointFrames& f, const JointParameters& p);

}  // namespace polhode
