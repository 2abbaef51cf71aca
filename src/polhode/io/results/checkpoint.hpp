// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <polhode/simulation/simulation_details.hpp>

namespace polhode::io {

/// Saves a state for an exactly equal continuation of the run. The file is written atomically and
/// has a checksum. @throws FileError
void write_checkpoint(const std::string& path, const Model& model, const System& system,
                      const State& state);

/// Reads a checkpoint of this model.
/// @throws FileError if it cannot be read; InputError if it is no checkpoint, is damaged, has
///         another format version, or belongs to another model.
[[nodiscard]] State read_checkpoint(const std::string& path, const Model& model,
                                    const System& system);

}  // namespace polhode::io
