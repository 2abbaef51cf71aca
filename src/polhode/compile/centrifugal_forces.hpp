// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/model/model.hpp>
#include <polhode/system/system.hpp>

namespace polhode {

/// Adds the centrifugal forces of all masses in the frame of model.analysis.turning, in which the
/// model is at rest. All else has been added. @eq{spin-matrices} @eq{spin-body}
void add_centrifugal_forces(System& system, const Model& model);

}  // namespace polhode
