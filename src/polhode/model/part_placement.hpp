// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include <polhode/model/model.hpp>

namespace polhode {

/// Placement of a part in a whole: first mirrored in its own coordinates, then rotated, then
/// translated.
struct PartPlacement {
  Vec3 position = Vec3::Zero();         ///< Of the part's origin, in the whole [m].
  Quat orientation = Quat::Identity();  ///< From the part's axes to the whole's.
  std::optional<int> mirror;            ///< 0, 1, 2: reflection of x, y or z.
};

/// Moves a complete model to its placement. A mirrored body has axes that are mirrored along the
/// same axis of its own, so that its coordinates change that sign, and its inertia is the mirror
/// image.
/// @throws InputError that names an object that cannot be mirrored or rotated, with a path such as
/// "bodies.foot.shape".
void place_part(Model& part, const PartPlacement& placement);

/// Adds a part to a whole, with the prefix before all its names. Title, gravity, contacts, analysis
/// and output of the part are dropped.
void append_part(Model& whole, Model part, const std::string& prefix);

}  // namespace polhode
