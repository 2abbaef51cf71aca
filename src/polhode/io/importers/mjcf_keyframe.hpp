// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include <polhode/io/importers/mjcf_file.hpp>

namespace polhode::io {

/// Gives the joints of a robot the start of a keyframe: the first one of the file, or the one that
/// the options name.
/// @param actuators  Number of actuators of the file.
/// @returns the controls of the actuators; empty if the keyframe has none.
std::vector<double> read_keyframe(MjcfFile& file, const ImportOptions& options,
                                  std::size_t actuators, Robot& robot);

}  // namespace polhode::io
