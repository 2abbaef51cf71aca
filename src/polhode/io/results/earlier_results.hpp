// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace polhode::io {

/// Removes files of an earlier run from a results folder that a new run might not overwrite:
/// results.h5, tables of probes, events.csv, pictures, certificates. Other files, checkpoints and
/// modes stay.
/// @throws FileError if a file cannot be removed.
void clear_earlier_results(const std::string& folder);

/// Removes numbered files, such as 000017.vtu, of a folder from that number on.
/// @param extension  Without its dot. @throws FileError
void remove_numbered_files(const std::string& folder, const std::string& extension,
                           std::size_t first);

}  // namespace polhode::io
