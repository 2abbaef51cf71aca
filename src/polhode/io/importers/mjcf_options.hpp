// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <polhode/io/importers/mjcf_medium.hpp>

namespace polhode::io {

/// Reads all <option> sections: gravity, the medium, and what their flags switch off.
/// @param options  Limits and friction become false where the file switches them off.
void read_options(MjcfFile& file, MjcfMedium& medium, Robot& robot, ImportOptions& options);

}  // namespace polhode::io
