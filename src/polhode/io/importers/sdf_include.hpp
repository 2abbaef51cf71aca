// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace polhode::io {

/// Path of the SDFormat file that a <uri> names: the file itself, or a folder with a model.config
/// that names it, or with a model.sdf.
/// @param folder  Of the file with the <uri>.
/// @param paths   Folders that contain models, as of find_named_file().
/// @returns nothing if there is none.
[[nodiscard]] std::optional<std::string> find_sdf(const std::string& uri, const std::string& folder,
                                                  const std::vector<std::string>& paths);

}  // namespace polhode::io
