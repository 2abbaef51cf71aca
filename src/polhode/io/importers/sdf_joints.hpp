// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <polhode/io/importers/sdf_frames.hpp>

namespace polhode::io {

/// A joint of an SDFormat file, with its frame and version.
struct SdfJoint {
  const XmlFile::Element* at = nullptr;
  int frame = 0;
  int version = 0;  ///< Minor one of its file.
};

/// Reads all joints, whose frames are connected, in the order of the file.
void read_sdf_joints(SdfFile& file, SdfFrames& frames, const std::vector<SdfJoint>& joints,
                     Robot& robot);

}  // namespace polhode::io
