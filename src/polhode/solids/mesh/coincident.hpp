// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <polhode/core/types.hpp>

namespace polhode::solids {

/// For each point the first point within a distance of it, itself if there is no earlier one.
/// Points with an earlier partner are not partners of others: there are no chains.
/// @param distance  [m]; at most 0: equal coordinates only.
[[nodiscard]] std::vector<int> first_coincident(const std::vector<Vec3>& points, double distance);

}  // namespace polhode::solids
