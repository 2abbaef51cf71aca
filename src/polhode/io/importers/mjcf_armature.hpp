// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/io/importers/mjcf_file.hpp>
#include <polhode/io/importers/robot.hpp>

namespace polhode::io {

/// Adds the armature a of free joints: a body of the mass a and the inertia a 1, welded to the
/// joint's at its origin and without weight. As a force on the six velocities of the joint, that of
/// the origin in the world and the angular one in the body's axes, it is −a times their rates, for
/// these have no other terms.
void add_free_armatures(MjcfFile& file, Robot& robot);

}  // namespace polhode::io
