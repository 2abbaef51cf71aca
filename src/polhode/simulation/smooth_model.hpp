// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/model/model.hpp>
#include <polhode/system/system.hpp>

namespace polhode {

/// Checks that the motion has as many derivatives as an extrapolated step of this order needs, but
/// for times that steps end at, and that its state is combined rightly.
/// @throws InputError naming the first part of the model that has not.
void require_smooth(const Model& model, const System& system, int order);

}  // namespace polhode
