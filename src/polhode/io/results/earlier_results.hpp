// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace polhode {

/// Removes from a results folder what an earlier run wrote there and a new one may not write over:
/// results.h5, tables of probes, events.csv, pictures, certificates. Other files stay, and so do
/// checkpoints and modes.
/// @throws FileError if a file cannot be removed.
void clear_earlier_results(const std::string& folder);

/// Removes numbered files, such as 000017.vtu, of a folder from that number on.
/// @param extension  Without its dot. @throws FileError
void remove_numbered_files(const std::string& folder, const std::string& extension,
                           std::size_t first);

}  // namespace polhode
