// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <polhode/io/importers/robot.hpp>

namespace polhode::io {

/// Makes a tree of links and joints that stand in any order: joints that close loops are marked,
/// those that count from the tree's leaves are reversed, and links that no joint connects with the
/// first one, the world, become free.
/// @param placed  Frame of each link in the world.
void span_tree(Robot& robot, const std::vector<Pose>& placed);

}  // namespace polhode::io
