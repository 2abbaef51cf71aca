// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>

namespace polhode::io {

/// The URDF that the Python package xacro makes of a file, by calling its command `xacro`, or
/// `python3 -m xacro`.
/// @throws FileError if the package is missing, fails, or writes more than an XML file may have.
[[nodiscard]] std::string expanded_by_xacro(const std::string& file,
                                            const std::map<std::string, std::string>& arguments);

}  // namespace polhode::io
