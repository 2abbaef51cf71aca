// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <string>

#include <polhode/model/model.hpp>

namespace polhode {

/// Stands for all that a side meets, where a second side would stand.
inline constexpr int kEverySide = std::numeric_limits<int>::max();

/// The contact that an event switches by this name: the two bodies of a pair of contacts or sensor;
/// or a body and kEverySide. A name that a pair, a joint or a load has is theirs, not a body's.
/// None if neither a pair nor a body with shapes that touch has the name.
/// @throws InputError if a pair and a joint or load have the name, or if it is no pair of bodies.
[[nodiscard]] std::optional<std::array<int, 2>> switched_contact(const Model& model,
                                                                 const std::string& name);

}  // namespace polhode
