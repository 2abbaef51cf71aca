// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <polhode/io/importers/mjcf_file.hpp>

namespace polhode::io {

/// Controls of actuators and, of those that have one, their activations at the start.
struct MjcfControls {
  std::vector<double> controls, activations;  ///< By actuator; empty: zero.
};

/// Gives the joints of a robot the start of a keyframe: the first one of the file, or the one that
/// the options name.
/// @param active  Of each actuator of the file, whether it has an activation.
/// @param mocaps  Joints of mocap bodies in the robot, whose places the keyframe gives too.
[[nodiscard]] MjcfControls read_keyframe(MjcfFile& file, const ImportOptions& options,
                                         const std::vector<bool>& active,
                                         const std::vector<std::size_t>& mocaps, Robot& robot);

}  // namespace polhode::io
