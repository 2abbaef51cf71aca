// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include <polhode/solids/materials/material.hpp>

namespace polhode::solids {

/// Every type of material, in the order of the documentation.
[[nodiscard]] const std::vector<MaterialKind>& material_kinds();
/// All laws of fibres, which can be combined with any material.
[[nodiscard]] const std::vector<MaterialKind>& fibre_kinds();

/// The material type of this name. @throws InputError that lists the names if it is unknown.
[[nodiscard]] const MaterialKind& material_kind(std::string_view name);
[[nodiscard]] const MaterialKind& fibre_kind(std::string_view name);

/// A material from its description.
/// @param where  Path of the material in the user's model, first part of messages.
/// @throws InputError for an unknown kind or parameter, a missing or forbidden value.
[[nodiscard]] std::unique_ptr<const Material> make_material(std::string_view where,
                                                            const MaterialDescription& description);

}  // namespace polhode::solids
