// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace polhode::io {

/// Path of a file that a robot's file names: package://NAME/..., file://..., absolute, or relative
/// to its folder. A package, or model://NAME/..., is looked for in the search paths, then in the
/// folders of ROS_PACKAGE_PATH, GZ_SIM_RESOURCE_PATH and GAZEBO_MODEL_PATH, then in the folders
/// above the file, which may be the package itself.
/// @returns nothing if there is no such file.
[[nodiscard]] std::optional<std::string> find_named_file(const std::string& name,
                                                         const std::string& folder,
                                                         const std::vector<std::string>& paths);

}  // namespace polhode::io
