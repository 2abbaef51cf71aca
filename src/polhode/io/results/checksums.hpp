// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

namespace polhode::io::results {

/// Checksums of all channels, frame by frame: (frames, channels), whole numbers below 2⁴⁸.
inline constexpr const char* kChecksums = "/packed/checksums";
/// Attribute of a channel: its column there.
inline constexpr const char* kChecksumColumn = "checksum_column";
/// Attribute of the root: the number of columns, so that a lost data set is noticed.
inline constexpr const char* kChecksumColumns = "checksum_columns";
/// Attribute of a constant list: its checksum.
inline constexpr const char* kListChecksum = "checksum";

/// Checksum of the numbers of a channel in one frame.
/// @param integer  The channel stores them as whole numbers.
[[nodiscard]] double checksum(std::span<const double> numbers, bool integer);

/// Checksum of a list of texts.
[[nodiscard]] double checksum(const std::vector<std::string>& texts);

/// Walk through the structures of an HDF5 file in a child process, as damaged ones may crash the
/// library. @returns whether the child came to its end.
[[nodiscard]] bool survives_a_walk(const std::string& path);

}  // namespace polhode::io::results
