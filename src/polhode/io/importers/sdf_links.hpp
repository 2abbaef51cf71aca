// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <polhode/io/importers/sdf_frames.hpp>

namespace polhode::io {

/// A link of an SDFormat file, with its frame and folder.
struct SdfLink {
  const XmlFile::Element* at = nullptr;
  int frame = 0;
  bool is_static = false;
  std::string folder;  ///< Of its file.
};

/// Reads the mass and the shapes of a link, whose frames are connected.
/// @param link  Its name and tag are given.
void read_sdf_link(SdfFile& file, SdfFrames& frames, const SdfLink& from, RobotLink& link);

}  // namespace polhode::io
