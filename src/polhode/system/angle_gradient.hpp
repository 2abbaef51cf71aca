// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/system/free_coordinate.hpp>

namespace polhode {

/// As angle_step() but for the rate and its derivatives, which only some forces need.
[[nodiscard]] AngleStep angle_gradient(const FreeAngle& angle, const BodyStep& a, const BodyStep& b,
                                       double at_n, bool conserving);

}  // namespace polhode
