// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/joints/resistance.hpp>
#include <polhode/model/model.hpp>

namespace polhode {

/// Friction and stops of a joint with default values: stiffnesses, dampings and bands that are not
/// given follow from masses and lever arms of the joint's bodies, from gravity and the step.
[[nodiscard]] JointResistance joint_resistance(const Model& model, const JointSpec& joint);

}  // namespace polhode
