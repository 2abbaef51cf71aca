// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include <polhode/core/held_value.hpp>
#include <polhode/model/model.hpp>

namespace polhode {

/// Numbers of the HeldValues that are functions of a model's loads; null if there are none.
[[nodiscard]] std::shared_ptr<HeldNumbers> held_numbers(const Model& model);

/// Replaces these numbers by copies for this model alone: copies of a model share their functions.
/// @returns them, or null.
std::shared_ptr<HeldNumbers> own_held_numbers(Model& model);

}  // namespace polhode
