// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include <polhode/model/model.hpp>
#include <polhode/system/system.hpp>

namespace polhode {

/// Adds a point that slides along a beam: nodes bonded to its bodies, and their SlideOnBeam.
/// @param bodies  By Model::bodies: index into the system's, kGround if fixed.
/// @throws InputError if the beam has corners, if the point is not on it, or if velocities may
/// jump.
void add_slide(System& system, const Model& model, const LoadSpec& load,
               std::span<const int> bodies);

}  // namespace polhode
