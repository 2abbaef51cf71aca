// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include <polhode/model/model.hpp>

namespace polhode {

/// Where a part stands in a whole: mirrored in its own coordinates first, then turned, then moved.
struct PartPlacement {
  Vec3 position = Vec3::Zero();         ///< Of the part's origin, in the whole [m].
  Quat orientation = Quat::Identity();  ///< From the part's axes to the whole's.
  std::optional<int> mirror;            ///< 0, 1, 2: x, y or z changes its sign.
};

/// Moves all of a model to its place. A mirrored body has axes that are mirrored along the same
/// axis of its own, so that its coordinates change that sign, and its inertia is the mirror image.
/// @throws InputError that names what cannot be mirrored or turned, with a path such as
///         "bodies.foot.shape".
void place_part(Model& part, const PartPlacement& placement);

/// Adds a part to a whole, with the prefix before all its names. Title, gravity, contacts, analysis
/// and output of the part are left behind.
void append_part(Model& whole, Model part, const std::string& prefix);

}  // namespace polhode
