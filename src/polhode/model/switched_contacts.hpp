// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include <polhode/model/model.hpp>

namespace polhode {

/// The pair of contacts, or sensor, that an event switches by this name: index into
/// ContactsSpec::pairs; none if no pair has the name.
/// @throws InputError if a joint or load has the name too, or if it is no pair of bodies.
[[nodiscard]] std::optional<int> switched_contact(const Model& model, const std::string& name);

}  // namespace polhode
