// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include <polhode/joints/recipe.hpp>
#include <polhode/system/parameter.hpp>

namespace polhode {

/// A type of joint in the model file.
struct JointKind {
  std::string name;     ///< "type" in the model file.
  std::string meaning;  ///< One line.
  std::string free;     ///< Free motions of b as seen from a: Tx Ty Tz Rx Ry Rz; "as given".
  JointRecipe (*recipe)(const JointFrames&, const JointParameters&);
  std::vector<Parameter> parameters = {};
  bool takes_free_list = false;  ///< Uses JointParameters::free.
  /// Its points are apart: the model file gives both, and "distance" is their initial distance.
  bool points_apart = false;
};

/// Every joint type; the order is that of the documentation.
[[nodiscard]] const std::vector<JointKind>& joint_kinds();

/// The joint type of this name. @throws InputError that lists the names if it is unknown.
[[nodiscard]] const JointKind& joint_kind(std::string_view name);

}  // namespace polhode
