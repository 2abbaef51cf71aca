// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <polhode/io/importers/mjcf_keyframe.hpp>
#include <polhode/io/importers/mjcf_tendons.hpp>

namespace polhode::io {

/// Reads all <actuator> sections: motors and servos of joints and of tendons.
/// @param controls  Of a keyframe; empty lists: zero.
void read_actuators(MjcfFile& file, MjcfRefusals& refusals, const MjcfBodies& bodies,
                    const ImportOptions& options, const MjcfControls& controls,
                    MjcfTendons& tendons, Robot& robot);

/// All actuators of a file.
[[nodiscard]] std::vector<const XmlFile::Element*> actuators_of(MjcfFile& file);
/// Whether each of them has an activation, a state of its own.
[[nodiscard]] std::vector<bool> activations_of(MjcfFile& file);

}  // namespace polhode::io
