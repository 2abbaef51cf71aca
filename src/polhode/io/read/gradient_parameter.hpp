// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <polhode/gradient/gradient.hpp>
#include <polhode/io/read/read_import.hpp>

namespace polhode::io {

/// The number at a path of a model file, for gradients: its value with the overrides, its unit as
/// far as the file gives one, and the model at other values of it.
/// @param path  Name of a variable, or keys and list indices joined by dots, as for overrides.
/// @throws InputError if the path is no number that can be changed; ModelErrors.
[[nodiscard]] GradientParameter gradient_parameter(const ModelText& source,
                                                   const std::string& path);

}  // namespace polhode::io
