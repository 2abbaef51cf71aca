// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <polhode/core/types.hpp>

namespace polhode {

/// For each point the first point that lies within a distance of it, itself if there is none
/// before. Points that stand for others are never stood for: chains end at the first point.
/// @param distance  [m]; at most 0: equal coordinates only.
[[nodiscard]] std::vector<int> first_coincident(const std::vector<Vec3>& points, double distance);

}  // namespace polhode
