// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <vector>

#include <polhode/solids/loads/solid_load.hpp>

namespace polhode::solids {

/// Every type of load on solids; the order is that of the documentation.
[[nodiscard]] const std::vector<SolidLoadKind>& solid_load_kinds();

/// The type of load on solids of this name.
/// @param where  Path in the user's model, first part of messages.
/// @throws InputError that lists the names if it is unknown.
[[nodiscard]] const SolidLoadKind& solid_load_kind(std::string_view where, std::string_view name);

}  // namespace polhode::solids
