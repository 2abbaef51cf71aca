// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <polhode/model/material_spec.hpp>
#include <polhode/solids/materials/material.hpp>

namespace polhode {

/// A material of a model as the registry of materials wants it.
[[nodiscard]] MaterialDescription material_description(const MaterialSpec& material);

/// What a model may name as a solid's element: kinds of the registry, and cells such as hex8, whose
/// kind then suits the material.
[[nodiscard]] std::vector<std::string> solid_element_names();

/// The cell of an element or cell name; "" for "" and for a name that is unknown.
[[nodiscard]] std::string cell_of_element(std::string_view element);

}  // namespace polhode
