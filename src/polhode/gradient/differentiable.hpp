// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/model/model.hpp>
#include <polhode/system/system.hpp>

namespace polhode {

/// Rejects a model whose run has no exact gradient here, with what to do instead.
/// @throws InputError that names the setting, joint, load or part.
void require_differentiable(const Model& model, const System& system);

}  // namespace polhode
