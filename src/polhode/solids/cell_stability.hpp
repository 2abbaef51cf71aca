// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include <polhode/solids/materials/material.hpp>

namespace polhode::solids {

/// Smallest stretch down to which a brick of eight nodes under uniaxial compression along one of
/// its edges resists all twelve hourglass motions. Below it the element has spurious modes, a known
/// defect of enhanced strains. @eq{hourglass-stability}
/// @param size  Of the brick [m]. @returns 0 if it stays stable down to 0.3.
[[nodiscard]] double stable_stretch(const std::string& element,
                                    const std::shared_ptr<const Material>& material,
                                    const Vec3& size, int axis);

}  // namespace polhode::solids
