// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <polhode/core/error.hpp>
#include <polhode/model/model.hpp>
#include <polhode/system/impulsive_contacts.hpp>

namespace polhode {

/// Options of the laws of all pairs, including defaults.
[[nodiscard]] ImpulseOptions impulse_options(const ContactsSpec& contacts);

/// Checks that a model with the non-smooth law has no unsupported objects: joints, solids, beams,
/// cables, automatic steps, numerical damping. Objects unsupported by all contacts are checked
/// elsewhere.
void check_nonsmooth(const Model& model, std::vector<InputError>& faults);
/// Checks that a model with the law rigid has no unsupported objects: solids, cables, numerical
/// damping.
void check_rigid(const Model& model, std::vector<InputError>& faults);

}  // namespace polhode
