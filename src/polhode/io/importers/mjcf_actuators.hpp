// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <polhode/io/importers/mjcf_actuator_values.hpp>
#include <polhode/io/importers/mjcf_keyframe.hpp>
#include <polhode/io/importers/mjcf_tendons.hpp>

namespace polhode::io {

/// Reads all <actuator> sections: motors and servos of joints and of tendons.
/// @param controls  Of a keyframe; empty lists: zero.
void read_actuators(MjcfFile& file, MjcfRefusals& refusals, const MjcfBodies& bodies,
                    const ImportOptions& options, const MjcfControls& controls,
                    MjcfTendons& tendons, Robot& robot);

/// Adds the armatures and dampings of actuators to their joints and tendons; they act there also if
/// the actuators are switched off. To be called before anything depends on inertias.
void add_actuator_armatures(MjcfFile& file, MjcfRefusals& refusals, MjcfTendons& tendons,
                            Robot& robot);

}  // namespace polhode::io
