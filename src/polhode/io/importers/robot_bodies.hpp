// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <polhode/io/importers/robot_tree.hpp>

namespace polhode::io {

/// Finds the bodies of a tree whose links have their places.
///
/// Links that are welded stay bodies of their own where they have mass and inertia. The joints of
/// links without mass that carry nothing are held, which changes no other motion. Links without
/// mass between joints whose motions are independent take 1e-10 of the mass and inertia of the next
/// body; other links without mass or inertia are refused, by the file's diagnostics.
void form_bodies(const Robot& robot, const ImportOptions& options, XmlFile& xml,
                 Diagnostics& diagnostics, std::vector<ImportNote>& notes, RobotTree& tree);

}  // namespace polhode::io
