// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <polhode/model/material_spec.hpp>
#include <polhode/solids/materials/material.hpp>

namespace polhode {

/// Description of a model's material for the registry of materials.
[[nodiscard]] solids::MaterialDescription material_description(const MaterialSpec& material);

/// Valid names of a solid's element: kinds of the registry, and cells such as hex8, for which the
/// kind is chosen by the material.
[[nodiscard]] std::vector<std::string> solid_element_names();

/// Cell of an element or cell name; "" for "" and for an unknown name.
[[nodiscard]] std::string cell_of_element(std::string_view element);

}  // namespace polhode
