// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <string>

#include <polhode/model/model.hpp>

namespace polhode {

/// All opposite sides, in place of a second side.
inline constexpr int kEverySide = std::numeric_limits<int>::max();

/// Contact switched by this name in an event: the two bodies of a pair of contacts or sensor; or a
/// body and kEverySide. Names of pairs, joints or loads take precedence over bodies. None if
/// neither a pair nor a body with contact shapes has the name.
/// @throws InputError if a pair and a joint or load have the name, or if it is no pair of bodies.
[[nodiscard]] std::optional<std::array<int, 2>> switched_contact(const Model& model,
                                                                 const std::string& name);

/// Controller switched by this name in an event, an index into Model::controllers; -1 if there is
/// none, or something else of that name that can be switched.
[[nodiscard]] int switched_controller(const Model& model, const std::string& name);

}  // namespace polhode
