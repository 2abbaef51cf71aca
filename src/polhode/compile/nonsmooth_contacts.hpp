// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <polhode/core/error.hpp>
#include <polhode/model/model.hpp>
#include <polhode/system/impulsive_contacts.hpp>

namespace polhode {

/// Options of the non-smooth law, defaults filled in.
[[nodiscard]] ImpulseOptions impulse_options(const ContactsSpec& contacts);

/// What a model with the non-smooth law has that does not go with it: joints, solids, beams,
/// cables, automatic steps, numerical damping. What no contact goes with is told elsewhere.
void check_nonsmooth(const Model& model, std::vector<InputError>& faults);

}  // namespace polhode
