// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <vector>

#include <polhode/joints/parts.hpp>
#include <polhode/joints/rod_coordinates.hpp>

namespace polhode {

/// Frames of a joint on its two bodies: point from the centre of mass [m] and axes (columns x, y,
/// z), both in body components; on the ground world coordinates.
struct JointFrames {
  Vec3 Z_a = Vec3::Zero(), Z_b = Vec3::Zero();
  Mat3 R_a = Mat3::Identity(), R_b = Mat3::Identity();
};

/// Parameters of a joint besides its frames.
struct JointParameters {
  std::vector<std::string> free;         ///< Generic joint: freedoms among x, y, z, rx, ry, rz.
  std::map<std::string, double> values;  ///< By name, SI.
};

/// A joint before it has a name and bodies: frames and the parts between them.
///
/// The parts may use permuted axes: axis i of the parts is axis (i + shift) mod 3 of the user's
/// frames. Reports use the user's.
struct JointRecipe {
  JointFrames frames;
  JointParts parts;
  int shift = 0;
  RodKind rod = RodKind::none;  ///< Its report, if the points are apart.
};

/// Recipe from parts, rows in the order given.
template <class... Parts>
[[nodiscard]] JointRecipe joint_of(const JointFrames& frames, const Parts&... parts) {
  JointRecipe recipe{.frames = frames, .parts = {}};
  (recipe.parts.add(parts), ...);
  return recipe;
}

/// Recipe between points that are apart.
template <class... Parts>
[[nodiscard]] JointRecipe rod_of(RodKind rod, const JointFrames& frames, const Parts&... parts) {
  JointRecipe recipe = joint_of(frames, parts...);
  recipe.rod = rod;
  return recipe;
}

}  // namespace polhode
